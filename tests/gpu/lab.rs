//! The device that the tests share, and kernels made for one test.

use bytemuck::Pod;
use libtest_mimic::{Arguments, Completion, Trial};
use shaders::{Bindable, Choice, Device, Flags, Kernel, compose_text, groups};

/// The tests of this target.
pub struct Suite {
    device: Result<Device, String>,
    trials: Vec<Trial>,
}

impl Suite {
    /// Open a device, if there is one.
    pub fn new() -> Self {
        let device = Device::open(Choice::Any).map_err(|error| error.to_string());
        match &device {
            Ok(device) => eprintln!("on {}", device.adapter.describe()),
            Err(error) => eprintln!("tests that need a GPU are SKIPPED: {error}"),
        }
        Self {
            device,
            trials: Vec::new(),
        }
    }

    /// A test that needs no device.
    pub fn plain(&mut self, name: &str, test: fn()) {
        let run = move || {
            test();
            Ok(())
        };
        self.trials.push(Trial::test(name, run));
    }

    /// A test that needs a device: reported as ignored without one.
    pub fn gpu(&mut self, name: &str, test: fn(&Device)) {
        let trial = self.on_device(name, test);
        self.trials.push(trial);
    }

    /// The same for what takes minutes in software: it runs where `--ignored` asks for it.
    pub fn long(&mut self, name: &str, test: fn(&Device)) {
        let trial = self.on_device(name, test).with_ignored_flag(true);
        self.trials.push(trial);
    }

    fn on_device(&self, name: &str, test: fn(&Device)) -> Trial {
        let device = self.device.clone();
        let run = move || match device {
            Ok(device) => {
                test(&device);
                Ok(Completion::Completed)
            }
            Err(error) => Ok(Completion::ignored_with(format!("skipped: {error}"))),
        };
        Trial::ignorable_test(name, run)
    }

    /// Run what the command line asks for.
    pub fn run(self) -> ! {
        libtest_mimic::run(&Arguments::from_args(), self.trials).exit()
    }
}

/// Threads of a workgroup in the kernels of the tests.
const GROUP: u32 = 64;

/// Entry point `main` of `text` under `flags`.
pub fn kernel(device: &Device, name: &str, text: &str, flags: &Flags) -> Kernel {
    let module = compose_text(name, text, flags).unwrap_or_else(|error| panic!("{error}"));
    let kernel = device.kernel(&module, "main");
    kernel.unwrap_or_else(|error| panic!("{error}"))
}

/// One thread for each of `inputs`, which writes the same number of outputs; `others` are
/// further arrays by name.
pub fn map<I: Pod, O: Pod>(
    device: &Device,
    kernel: &Kernel,
    inputs: &[I],
    others: &[(&str, &dyn Bindable)],
) -> Vec<O> {
    let input = device.array_of("inputs", inputs).unwrap();
    let output = device.array::<O>("outputs", inputs.len()).unwrap();
    let mut arrays: Vec<(&str, &dyn Bindable)> = vec![("inputs", &input), ("outputs", &output)];
    arrays.extend_from_slice(others);
    let bound = kernel.bind(device, &arrays).unwrap();
    let groups = groups(inputs.len(), GROUP);
    assert_eq!(
        groups[1], 1,
        "the kernels of the tests know one row of groups"
    );
    let mut recording = device.record();
    recording.dispatch(&bound, groups);
    recording.submit().unwrap();
    device.read(&output).unwrap()
}
