//! Water between grains that is possible word by word and not together: told before the dry phases
//! have been computed.

use super::{Edges, Pores};
use crate::protocol;
use crate::scene::reader::Reader;
use crate::scene::tree::Step;
use crate::scene::{Phase, Scene};
use lbm::{Side, Signal};

/// Compression β p beyond which water is no linear spring any more.
const COMPRESSION: f64 = 0.1;
/// Steps that a period must have.
const STEPS: f64 = 20.0;
/// Times the diffusivity at which pores count as open, by which a guess of it must exceed that to be
/// sure.
const SURELY: f64 = 10.0;
const NAMES: [&str; 2] = ["bottom", "top"];

/// Note what cannot be.
pub fn check(scene: &Scene, pores: &Pores, reader: &Reader) {
    let area = scene.domain.area();
    let height = protocol::height_when_wet(&scene.phases, &scene.start, area);
    let grains = &scene.start.grains;
    let solid: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    let bed = Bed {
        height,
        porosity: (1.0 - solid / (area * height)).clamp(0.05, 0.95),
        step: scene.step,
        gravity: 0.0,
    };
    for (number, phase) in scene.phases.iter().enumerate() {
        let Some(edges) = &phase.water else { continue };
        let bed = Bed {
            gravity: phase.gravity.z.abs(),
            ..bed
        };
        for (side, message) in faults(pores, edges, &bed) {
            note(reader, number, side, message);
        }
    }
    if scene.phases.iter().any(|phase| phase.water.is_some())
        && pores.interval.is_none()
        && pores.crossed(bed.porosity, height, scene.step) > SURELY * coupling::OPEN
    {
        if pores.cavitation.is_some() {
            let message = "is not known to water in open pores, and this bed is so permeable that its \
                           pores are: leave it out, or bound the permeability from above";
            reader.wrong(&["water", "cavitation"], message.into());
        }
        let (density, least) = (
            dem::measure::grain_density(grains),
            coupling::open_needs_density(&pores.fluid),
        );
        if density < least {
            let message = format!(
                "is {density:.0} kg/m3, too light for water in open pores, whose inertia acts a step \
                 late, and this bed is so permeable that its pores are; write {least:.0} kg/m^3 or \
                 more, or bound the permeability from above"
            );
            reader.wrong(&["grains", "density"], message);
        }
    }
}

/// What the water finds.
#[derive(Clone, Copy)]
struct Bed {
    height: f64,
    porosity: f64,
    step: f64,
    gravity: f64,
}

/// What is wrong with the bottom (0) or the top (1).
fn faults(pores: &Pores, edges: &Edges, bed: &Bed) -> Vec<(usize, String)> {
    let mut faults = Vec::new();
    let compresses = pores.fluid.compressibility;
    for (side, what) in edges.sides.iter().enumerate() {
        let mut fault = |message| faults.push((side, message));
        match what {
            Side::Pressure(signal) => {
                let [least, most] = extremes(signal);
                let greatest = least.abs().max(most.abs());
                if compresses * greatest > COMPRESSION {
                    fault(format!(
                        "is {greatest:.1e} Pa at most, which would compress the water by {:.0} %, far \
                         beyond where its law holds; write less than {:.0e} Pa",
                        100.0 * compresses * greatest,
                        COMPRESSION / compresses
                    ));
                }
                let depth = if side == 0 { bed.height } else { 0.0 };
                let weight = pores.fluid.density * bed.gravity * depth;
                if let Some(cavitation) = pores.cavitation
                    && least < cavitation.pressure - weight
                {
                    fault(format!(
                        "is {least:.3e} Pa at least, and the water breaks at {:.3e} Pa: nothing can \
                         hold it there; write more, or a lower cavitation",
                        cavitation.pressure - weight
                    ));
                }
            }
            Side::Flux(signal) => {
                let [least, most] = extremes(signal);
                let fastest = least.abs().max(most.abs());
                let takes =
                    bed.height * pores.fluid.viscosity * fastest / pores.permeability(bed.porosity);
                if compresses * takes > COMPRESSION {
                    fault(format!(
                        "is {fastest:.1e} m/s at most, for which a pressure of {takes:.1e} Pa would have \
                         to drive it through the bed; write less than {:.0e} m/s",
                        fastest * COMPRESSION / (compresses * takes)
                    ));
                }
            }
            _ => {}
        }
        if let Side::Pressure(signal) | Side::Flux(signal) = what
            && let Signal::Sinusoidal { frequency, .. } = signal
            && frequency * bed.step * STEPS > 1.0
        {
            fault(format!(
                "has a period of {:.1e} s, less than {STEPS:.0} steps of {:.3e} s; write a longer one, \
                 or a shorter time.step",
                1.0 / frequency,
                bed.step
            ));
        }
    }
    if let Some(message) = closed(edges) {
        let side = usize::from(!matches!(edges.sides[0], Side::Flux(_)));
        faults.push((side, message));
    }
    faults
}

/// Water that comes in steadily must get out.
fn closed(edges: &Edges) -> Option<String> {
    let into = |side: &Side| match side {
        Side::Flux(Signal::Steady(flux)) => Some(*flux),
        Side::Flux(_) | Side::Pressure(_) => None,
        _ => Some(0.0),
    };
    let [bottom, top] = [into(&edges.sides[0])?, into(&edges.sides[1])?];
    let (sum, scale) = (bottom + top, bottom.abs().max(top.abs()));
    (sum.abs() > 1e-9 * scale).then(|| {
        format!(
            "brings {sum:.3e} m/s more into the bed than leaves it: pressure would rise without end; \
             make the other side \"drained\", or give it a flux of the opposite sign"
        )
    })
}

/// The least and the greatest value.
fn extremes(signal: &Signal) -> [f64; 2] {
    match signal {
        Signal::Steady(value) => [*value; 2],
        Signal::Sinusoidal {
            mean, amplitude, ..
        } => [mean - amplitude.abs(), mean + amplitude.abs()],
        Signal::Table(points) => {
            let values = points.iter().map(|point| point[1]);
            [
                values.clone().fold(f64::INFINITY, f64::min),
                values.fold(f64::NEG_INFINITY, f64::max),
            ]
        }
    }
}

/// Where it was said: in the phase, or for all.
fn note(reader: &Reader, phase: usize, side: usize, message: String) {
    let key = |word: &str| Step::Key(word.into());
    let own = [
        key("phase"),
        Step::Item(phase),
        key("water"),
        key(NAMES[side]),
    ];
    let common = [key("water"), key("sides"), key(NAMES[side])];
    let path = if reader.says(&own) { &own[..] } else { &common };
    reader.note_once(path, message);
}

/// Pressures at the walls that lift what is pushed down on them.
pub fn warnings(phase: &Phase) -> Vec<String> {
    let (Some(edges), dem::WallMotion::Stress(load)) = (&phase.water, phase.top) else {
        return Vec::new();
    };
    let effective = edges.normal_stress == coupling::NormalStress::Effective;
    let pairs = edges.sides.iter().zip(NAMES);
    let lifts = pairs.filter_map(|(side, name)| {
        let Side::Pressure(signal) = side else {
            return None;
        };
        let most = extremes(signal)[1];
        let lifts = most > load.mean && !(effective && name == "top");
        lifts.then(|| {
            format!(
                "phase {}: the water at the {name} is at {most:.3e} Pa, more than the {:.3e} Pa that \
                 push the wall down: it may lift it, and the bed float",
                phase.name, load.mean
            )
        })
    });
    lifts.collect()
}
