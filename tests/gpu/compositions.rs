//! What needs no GPU: structs that both sides write, compositions that a scene can ask for,
//! and a twin for each law.

use crate::lab::Suite;
use bytemuck::Zeroable;
use dem::ContactLaw;
use dem::contact::{Linear, LinearLammps, Sliding, Tension, Turning};
use dem::gpu::law::{Law, NormalPart, SlidingPart, TurningPart, flags};
use dem::gpu::{fixed::Place, wide::Wide};
use shaders::naga::Module;
use shaders::naga::valid::{Capabilities, ValidationFlags, Validator};
use shaders::{Flags, compose_text, layout};
use std::collections::BTreeSet;
use std::mem::offset_of;
use std::path::Path;

pub fn list(suite: &mut Suite) {
    suite.plain("structs_of_both_sides_have_one_layout", layouts);
    suite.plain("every_law_of_a_scene_validates", compositions);
    suite.plain("every_law_has_its_twin", twins);
    suite.plain("what_a_scene_lacks_is_not_compiled", left_out);
}

/// Compare size and offsets of `$rust` with struct `$name` of `$module`: all fields, in order.
macro_rules! same_layout {
    ($module:expr, $rust:ty, $name:literal, $($field:ident),+) => {
        let (size, members) = layout::of($module, $name).expect($name);
        assert_eq!(size as usize, size_of::<$rust>(), "size of {}", $name);
        let ours = [$((stringify!($field).to_string(), offset_of!($rust, $field) as u32)),+];
        assert_eq!(members, ours, "members of {}", $name);
    };
}

fn layouts() {
    let laws = laws_kernel(&flags(&frictional(true), true));
    same_layout!(&laws, Law, "Law", normal, sliding, rolling, twisting);
    // The last member of two of them fills a row and is nobody's.
    type Sizes = [(&'static str, usize); 3];
    let sizes: Sizes = [
        ("Normal", size_of::<NormalPart>()),
        ("Sliding", size_of::<SlidingPart>()),
        ("Turning", size_of::<TurningPart>()),
    ];
    for (name, size) in sizes {
        assert_eq!(
            layout::of(&laws, name).expect(name).0 as usize,
            size,
            "{name}"
        );
    }
    let members = |name: &str| {
        let members = layout::of(&laws, name).expect(name).1;
        members
            .into_iter()
            .map(|(name, _)| name)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        members("Normal"),
        ["stiffness", "damping", "floor", "unused"]
    );
    let sliding = [
        "stiffness",
        "damping",
        "friction_static",
        "friction_dynamic",
    ];
    assert_eq!(members("Sliding"), sliding);
    assert_eq!(
        members("Turning"),
        ["stiffness", "damping", "friction", "unused"]
    );
    assert_eq!(offset_of!(NormalPart, floor), 8);
    assert_eq!(offset_of!(SlidingPart, friction_dynamic), 12);
    assert_eq!(offset_of!(TurningPart, friction), 8);

    let overlap = compose(include_str!("overlap.wgsl"), &Flags::new());
    same_layout!(&overlap, Place, "Place", hi, radius_hi, lo, radius_lo);
    let wide = compose(
        "#import dem::wide::Wide
        @group(0) @binding(0) var<storage, read_write> a: array<Wide>;
        @compute @workgroup_size(1) fn main() { a[0].hi = 1; }",
        &Flags::new(),
    );
    same_layout!(&wide, Wide, "Wide", hi, lo);
    assert_eq!(Place::zeroed().radius_lo, 0.0);
}

fn compose(text: &str, flags: &Flags) -> Module {
    compose_text("test.wgsl", text, flags).unwrap_or_else(|error| panic!("{error}"))
}

fn laws_kernel(flags: &Flags) -> Module {
    compose(include_str!("laws.wgsl"), flags)
}

fn frictional(turns: bool) -> ContactLaw {
    let turning = turns.then_some(Turning {
        stiffness: 1e5,
        damping: 1.0,
        friction: 0.1,
    });
    ContactLaw::Linear(Linear {
        normal_stiffness: 1e6,
        normal_damping: 1.0,
        tension: Tension::Clip,
        sliding: Some(Sliding {
            stiffness: 1e6,
            damping: 1.0,
            friction_static: 0.5,
            friction_dynamic: 0.4,
        }),
        rolling: turning,
        twisting: turning,
    })
}

/// One scene for each set of flags.
fn every_law() -> Vec<ContactLaw> {
    let ContactLaw::Linear(linear) = frictional(true) else {
        unreachable!("made linear")
    };
    let sliding = None;
    let smooth = Linear {
        sliding,
        rolling: None,
        twisting: None,
        ..linear
    };
    let lammps = LinearLammps {
        normal_stiffness: 1e6,
        normal_damping: 1.0,
        tangential_stiffness: 1e6,
        tangential_damping: 1.0,
        friction: 0.5,
    };
    vec![
        ContactLaw::Linear(smooth),
        frictional(false),
        frictional(true),
        ContactLaw::LinearLammps(lammps),
    ]
}

fn compositions() {
    for law in every_law() {
        for ledger in [false, true] {
            let module = laws_kernel(&flags(&law, ledger));
            // No capability: what every device has.
            let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
            if let Err(error) = validator.validate(&module) {
                panic!("{law:?}, ledger {ledger}: {}", error.emit_to_string(""));
            }
        }
    }
}

/// Functions of a composed module, by their plain names.
fn functions(module: &Module) -> BTreeSet<String> {
    let names = module.functions.iter().filter_map(|(_, f)| f.name.clone());
    let plain = |name: String| match name.split_once("X_naga_oil_mod_X") {
        Some((plain, _)) => plain.to_string(),
        None => name,
    };
    names.map(plain).collect()
}

fn left_out() {
    let [smooth, frictional, turning, lammps] = every_law()[..] else {
        unreachable!("four laws")
    };
    let names = |law: ContactLaw, ledger| functions(&laws_kernel(&flags(&law, ledger)));
    assert!(names(turning, true).contains("resist"));
    assert!(names(turning, true).contains("tangential_loss"));
    for law in [smooth, frictional, lammps] {
        assert!(!names(law, true).contains("resist"), "{law:?}");
    }
    assert!(!names(smooth, true).contains("tangential_loss"));
    assert!(!names(frictional, false).contains("tangential_loss"));
    assert!(!names(frictional, false).contains("loss"));
}

/// Each law of one side has a file of the same name on the other.
fn twins() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let stems = |folder: &str, ending: &str, not_laws: [&str; 2]| {
        let folder = root.join(folder);
        let files = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{folder:?}: {e}"));
        let paths = files.map(|file| file.unwrap().path());
        let ours = paths.filter(|path| path.extension().is_some_and(|e| e == ending));
        let stems = ours.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned());
        let laws = stems.filter(|stem| !not_laws.contains(&stem.as_str()));
        laws.collect::<BTreeSet<_>>()
    };
    // The menu and the tests' door; the menu and what all share.
    let rust = stems("dem/src/contact", "rs", ["mod", "probe"]);
    let wgsl = stems("shaders/dem/contact", "wgsl", ["law", "types"]);
    assert_eq!(rust, wgsl);
    assert!(rust.len() >= 4);
    for law in rust {
        let names = |path: String, twin: String| {
            let text = std::fs::read_to_string(root.join(&path)).unwrap();
            assert!(text.contains(&twin), "{path} does not name its twin {twin}");
        };
        let rust = format!("dem/src/contact/{law}.rs");
        let wgsl = format!("shaders/dem/contact/{law}.wgsl");
        names(rust.clone(), wgsl.clone());
        names(wgsl, rust);
    }
}
