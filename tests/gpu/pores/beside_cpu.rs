//! The same beds on the CPU, in f64, and on the GPU.

use super::bed::{self, Bed, LOADED, gravity, model, pressed, sheared, water};
use crate::compare;
use crate::lab::Suite;
use coupling::{Cavitation, Coupled, Model, NormalStress, Permeability, Resistance, Snapshot};
use dem::{Drive, WallMotion};
use lbm::{Side, Signal};
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_bed_takes_a_load_as_on_the_cpu", load_step);
    suite.gpu("wet_pushes_are_held_as_on_the_cpu", held);
    suite.gpu("wet_bed_drains_through_both_walls_as_on_the_cpu", both_open);
    suite.gpu("wet_bed_under_gravity_is_that_of_the_cpu", at_rest);
    suite.gpu("wet_bed_is_sheared_as_on_the_cpu", shear);
    suite.gpu("wet_fine_lattice_is_that_of_the_cpu", fine);
    suite.gpu("wet_broken_water_is_that_of_the_cpu", broken);
    suite.gpu("wet_gravel_resists_as_on_the_cpu", gravel);
    suite.gpu("wet_open_pores_are_refused_with_the_remedy", open);
    suite.long("wet_lattice_is_laid_anew_as_on_the_cpu", relaid);
}

/// Largest differences of the water, and sizes: pressure [Pa], flux [m/s], porosity.
struct Apart {
    pressure: [f64; 2],
    flux: [f64; 2],
    porosity: f64,
    vapour: [f64; 2],
}

impl Apart {
    fn of(a: &Snapshot, b: &Snapshot) -> Self {
        let most = |each: &mut dyn Iterator<Item = f64>| each.fold(0.0, f64::max);
        let pairs = |a: &[f64], b: &[f64]| {
            let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            [
                most(&mut off.into_iter()),
                most(&mut a.iter().map(|a| a.abs())),
            ]
        };
        Self {
            pressure: pairs(&a.pressure, &b.pressure),
            flux: pairs(a.flux.as_flattened(), b.flux.as_flattened()),
            porosity: pairs(&a.porosity, &b.porosity)[0],
            vapour: pairs(&a.vapour, &b.vapour),
        }
    }
}

/// Walk both beds, `part` steps at a time on the GPU, and compare.
fn walk<const N: usize>(
    device: &Device,
    bed: Bed,
    steps: u64,
) -> (Coupled<N>, coupling::gpu::Coupled<N>) {
    let Bed {
        grains,
        state,
        water,
    } = bed;
    let mut gpu =
        coupling::gpu::Coupled::<N>::new(device, grains, state.clone(), water.clone(), None)
            .unwrap();
    // Boxes are made of whole units of the positions.
    let grains = gpu.grains().model().clone();
    let mut cpu = Coupled::<N>::new(grains, state, water, None, 1).unwrap();
    cpu.advance(steps).unwrap();
    gpu.advance(steps).unwrap();
    (cpu, gpu)
}

/// The water is the same within `allowed` of its size, forces on walls too.
fn assert_same<const N: usize>(
    what: &str,
    cpu: &Coupled<N>,
    gpu: &coupling::gpu::Coupled<N>,
    allowed: f64,
) {
    let (a, b) = (cpu.snapshot(), gpu.snapshot().unwrap());
    let apart = Apart::of(&a, &b);
    let share = |[off, most]: [f64; 2]| if most > 0.0 { off / most } else { off };
    let walls = [cpu.water().on_walls(), gpu.on_walls().unwrap()];
    let on_walls = [0, 1].map(|k| (walls[0][k] - walls[1][k]).abs());
    let scale = apart.pressure[1] * bed::AREA;
    println!(
        "{what}: pressure off by {:.1e} of {:.1e} Pa, flux by {:.1e} of {:.1e} m/s, porosity by \
         {:.1e}, vapour by {:.1e} of {:.1e} m3, walls by {:.1e} and {:.1e} of {scale:.1e} N",
        apart.pressure[0],
        apart.pressure[1],
        apart.flux[0],
        apart.flux[1],
        apart.porosity,
        apart.vapour[0],
        apart.vapour[1],
        on_walls[0],
        on_walls[1]
    );
    assert!(share(apart.pressure) <= allowed, "{what}: pressure");
    // Where the water breaks everywhere nothing flows; what might is 1e-5 m/s and more.
    let flux = apart.flux[0] / apart.flux[1].max(1e-6);
    assert!(flux <= 10.0 * allowed, "{what}: flux");
    assert!(apart.porosity <= 2e-6, "{what}: porosity");
    assert!(share(apart.vapour) <= 10.0 * allowed, "{what}: vapour");
    assert!(
        on_walls.iter().all(|off| off / scale <= allowed),
        "{what}: walls"
    );
    let left = [cpu.water().left(), gpu.left(&b).unwrap()];
    let off = [0, 1].map(|k| (left[0][k] - left[1][k]).abs());
    println!(
        "{what}: {:.3e} m3 left, off by {:.1e} and {:.1e}",
        left[0][1], off[0], off[1]
    );
    // Of what a cell holds at that pressure.
    let room = 4.5e-10 * apart.pressure[1] * bed::AREA * bed::SIDE;
    assert!(
        off.iter().all(|off| *off <= allowed * room),
        "{what}: volume"
    );
    let (report, other) = (cpu.report(), gpu.read().unwrap().1);
    assert_eq!(
        (
            report.exchange,
            report.interval,
            report.sub_steps,
            report.relaid
        ),
        (
            other.exchange,
            other.interval,
            other.sub_steps,
            other.relaid
        )
    );
    assert!((report.rattlers - other.rattlers).abs() < 1e-2);
    // Grains: their forces by the size of the largest one.
    let (a, b) = (cpu.grains().snapshot(), gpu.grains().snapshot().unwrap());
    let apart = compare::apart(&a, &b, cpu.grains().model());
    let speed = a
        .state
        .grains
        .velocity
        .iter()
        .map(|v| v.length())
        .fold(0.0, f64::max);
    let force = a.force.iter().map(|f| f.length()).fold(0.0, f64::max);
    println!(
        "{what}: grains' place off by {:.1e} m, velocity by {:.1e} of {speed:.1e} m/s, force by \
         {:.1e} of {force:.1e} N; wall by {:.1e} m, {:.1e} m/s",
        apart["place"],
        apart["velocity"],
        apart["force"],
        apart["wall place"],
        apart["wall velocity"]
    );
    assert!(apart["velocity"] <= 1e-4 * speed + 1e-7, "{what}: velocity");
    assert!(
        apart["wall velocity"] <= 1e-4 * speed + 1e-7,
        "{what}: wall"
    );
}

/// Three hundred steps after a load of a tenth more, drained at the top: weights are renewed four
/// times, and the lattice makes a step every 16.
fn load_step(device: &Device) {
    let bed = Bed {
        grains: dem::Model {
            ledger: true,
            ..model(LOADED)
        },
        state: pressed(),
        water: water(1e-12),
    };
    let (cpu, gpu) = walk::<3>(device, bed, 300);
    assert_same("load step", &cpu, &gpu, 1e-5);
    let (a, b) = (
        cpu.grains().snapshot().ledger,
        gpu.grains().snapshot().unwrap().ledger,
    );
    println!(
        "work of the water {:e} and {:e} J, of walls {:e} and {:e} J, residual {:.1e} and {:.1e} J",
        a.work_companion, b.work_companion, a.work_walls, b.work_walls, a.residual, b.residual
    );
    assert!((a.work_companion - b.work_companion).abs() < 1e-5 * a.work_companion.abs());
    assert!((a.residual - b.residual).abs() < 1e-4 * a.work_companion.abs());
}

/// An exchange in every step and in every fourth, in a load and in shear: read between two exchanges.
fn held(device: &Device) {
    for (every, parts) in [(1, 1.0), (4, 2.0)] {
        for shears in [false, true] {
            let (mut grains, state) = match shears {
                true => sheared(),
                false => (model(LOADED), pressed()),
            };
            grains.step /= parts;
            // One search: the CPU exchanges with each.
            grains.skin = Some(4e-3);
            let water = Model {
                exchange: Some(every),
                ..water(1e-11)
            };
            let bed = Bed {
                grains,
                state,
                water,
            };
            let (cpu, gpu) = walk::<3>(device, bed, 163);
            let allowed = if shears { 1e-4 } else { 1e-5 };
            assert_same(
                &format!("every {every}, shear {shears}"),
                &cpu,
                &gpu,
                allowed,
            );
        }
    }
}

/// Water that is squeezed out, and flows from the bottom to the top beside that: how much, each way.
fn both_open(device: &Device) {
    let mut water = water(1e-11);
    water.sides[0] = Side::Pressure(Signal::Steady(2e3));
    let bed = Bed {
        grains: model(LOADED),
        state: pressed(),
        water,
    };
    let (cpu, gpu) = walk::<3>(device, bed, 200);
    assert_same("both open", &cpu, &gpu, 1e-5);
    let [bottom, top] = cpu.water().left();
    assert!(top - bottom > 0.1 * top, "{bottom:e} {top:e}");
}

fn at_rest(device: &Device) {
    let bed = Bed {
        grains: gravity(model(bed::STRESS)),
        state: pressed(),
        water: water(1e-10),
    };
    let (cpu, gpu) = walk::<3>(device, bed, 200);
    assert_same("gravity", &cpu, &gpu, 1e-4);
}

fn shear(device: &Device) {
    let (grains, state) = sheared();
    let bed = Bed {
        grains,
        state,
        water: water(1e-11),
    };
    let (cpu, gpu) = walk::<3>(device, bed, 200);
    assert_same("shear", &cpu, &gpu, 1e-4);
    let (mut grains, state) = sheared();
    grains.drive = Some(Drive::ShearStress(2e4));
    let bed = Bed {
        grains,
        state,
        water: water(1e-11),
    };
    let (cpu, gpu) = walk::<3>(device, bed, 70);
    assert_same("shear stress", &cpu, &gpu, 1e-4);
}

/// Cells of one diameter, which the wide kernel goes with; the wall feels grains alone.
fn fine(device: &Device) {
    let mut water = water(1e-12);
    water.cells = [6, 6, 7];
    water.normal_stress = NormalStress::Effective;
    water.sides[1] = Side::Pressure(Signal::Steady(2e3));
    let bed = Bed {
        grains: model(LOADED),
        state: pressed(),
        water,
    };
    let (cpu, gpu) = walk::<5>(device, bed, 200);
    assert_same("fine", &cpu, &gpu, 1e-5);
}

/// A wall that is pulled: the water breaks.
fn broken(device: &Device) {
    let mut water = water(1e-12);
    water.sides[1] = Side::FreeSlip;
    water.cavitation = Some(Cavitation { pressure: -3e3 });
    let bed = Bed {
        grains: model(0.8 * bed::STRESS),
        state: pressed(),
        water,
    };
    let (cpu, gpu) = walk::<3>(device, bed, 200);
    assert!(cpu.snapshot().vapour.iter().any(|&v| v > 0.0));
    assert_same("broken", &cpu, &gpu, 1e-4);
}

fn gravel(device: &Device) {
    let porosity = Resistance::Darcy(Permeability::kozeny_carman(1e-4).within([1e-14, 1e-9]));
    let di_felice = Resistance::DiFelice { diameter: 1e-4 };
    for resistance in [porosity, Resistance::Ergun { diameter: 1e-4 }, di_felice] {
        let bed = Bed {
            grains: model(LOADED),
            state: pressed(),
            water: Model {
                resistance,
                ..water(1e-11)
            },
        };
        let (cpu, gpu) = walk::<3>(device, bed, 70);
        assert_same(&format!("{resistance:?}"), &cpu, &gpu, 1e-4);
    }
}

/// Water that its own mass holds is computed on the CPU alone.
fn open(device: &Device) {
    let bed = || (model(LOADED), pressed());
    let ((grains, state), (same, again)) = (bed(), bed());
    let gpu = coupling::gpu::Coupled::<3>::new(device, grains, state, water(1e-6), None);
    let error = gpu.err().unwrap().to_string();
    assert!(
        error.contains("--backend cpu") && error.contains("permeability"),
        "{error}"
    );
    assert!(Coupled::<3>::new(same, again, water(1e-6), None, 1).is_ok());
}

/// A wall that comes down over grains: cells get so flat that the lattice is laid anew, with the water
/// that each of them holds. It is as soft as gas, or it would burst. On the CPU weights are renewed
/// with each search too, and this wall makes one follow the other: even though both renew in every
/// step that drags no loose grains, pressures part by a per cent or two. Laying the lattice anew adds
/// nothing to that: without the water of the cells, or with another flow, they would part by more.
/// (Long: groups of one step.)
fn relaid(device: &Device) {
    let fall = 0.05 / (150.0 * bed::STEP);
    let part = |steps: u64, relaid: u64| -> f64 {
        let (mut grains, mut state) = (model(bed::STRESS), pressed());
        state.walls[1].offset -= 0.05;
        grains.walls[1].motion = WallMotion::Velocity(fall);
        let mut water = water(2e-7);
        water.sides[1] = Side::FreeSlip;
        water.cells = [3, 3, 6];
        water.fluid.compressibility = 1e-4;
        water.interval = Some(16);
        water.renewal = Some(1);
        let bed = Bed {
            grains,
            state,
            water,
        };
        let (cpu, gpu) = walk::<3>(device, bed, steps);
        let (report, (now, other, _)) = (cpu.report(), gpu.read().unwrap());
        assert_eq!((report.relaid, other.relaid), (relaid, relaid), "{report}");
        assert_eq!(
            (report.interval, report.sub_steps),
            (other.interval, other.sub_steps)
        );
        let squeezed = bed::AREA * fall * steps as f64 * bed::STEP;
        let apart = Apart::of(&cpu.snapshot(), &now);
        println!(
            "relaid {relaid} times: {:e} of {squeezed:e} m3; pressure off by {:.1e} of {:.1e} Pa, \
             flux by {:.1e} of {:.1e} m/s",
            now.content, apart.pressure[0], apart.pressure[1], apart.flux[0], apart.flux[1]
        );
        assert!((now.content / squeezed - 1.0).abs() < 1e-6);
        apart.pressure[0] / apart.pressure[1]
    };
    let (before, after) = (part(100, 0), part(140, 1));
    assert!(
        before < 0.05 && after < 2.0 * before.max(0.01),
        "{before} {after}"
    );
}
