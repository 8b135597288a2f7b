//! What costs nothing because a scene does not need it.

use crate::backend::Machine;
use crate::protocol;
use crate::scene::Scene;
use dem::contact::Linear;
use dem::{ContactLaw, Drive, Model, Surface};

/// What `machine` leaves out of a run of `scene`: code that is not compiled in or not chosen,
/// arrays that are not there, files that are not written.
pub fn left_out(scene: &Scene, machine: &Machine) -> Vec<String> {
    let models: Vec<Model> = protocol::models(scene).collect();
    let never = |test: &dyn Fn(&Model) -> bool| !models.iter().any(test);
    let linear = |test: fn(&Linear) -> bool| {
        never(&|m| matches!(&m.law, ContactLaw::Linear(law) if test(law)))
    };
    let full = |m: &Model| m.walls.iter().any(|wall| wall.surface == Surface::Full);
    // On a GPU, what would stand in arrays of its own.
    let on = |cpu: &str, gpu: &str| match machine {
        Machine::Cpu { .. } => cpu.to_owned(),
        Machine::Gpu(_) => format!("{cpu} ({gpu})"),
    };
    let mut out = Vec::new();
    if never(&|m| m.law.slides()) {
        out.push(on(
            "tangential forces and their springs",
            "no history of contacts, no rotations",
        ));
    }
    let (rolls, twists) = (
        !linear(|law| law.rolling.is_some()),
        !linear(|law| law.twisting.is_some()),
    );
    if !rolls {
        out.push("rolling resistance".into());
    }
    if !twists {
        out.push("twisting resistance".into());
    }
    if never(&full) {
        out.push(on("friction at walls", "no springs there"));
    }
    if never(&|m| m.ledger) {
        out.push(on(
            "sums of the energy ledger",
            "no forces of the step before",
        ));
    }
    if scene.water.is_none() {
        out.push("water between the grains".into());
    }
    if let Machine::Gpu(_) = machine {
        if !rolls && !twists {
            out.push("springs of rolling".into());
        }
        if never(&|m| matches!(m.drive, Some(Drive::ShearStress(_)))) {
            out.push("motion under a shear stress (a step is one dispatch)".into());
        }
    }
    if scene.domain.periodic == [true; 2] {
        out.push("vertical walls".into());
    }
    let files = scene.output.files.iter();
    out.extend(
        files
            .filter(|(_, file)| file.is_none())
            .map(|(kind, _)| kind.file_name()),
    );
    out
}
