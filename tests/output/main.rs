//! Does what is written say what the solver did?
//!
//! All tests look at one bed: 180 grains without gravity, pressed by 10 kPa between two
//! walls and sheared between a held and a driven layer.

mod writer;

use approx::assert_relative_eq;
use dem::contact::{Linear, Sliding, Tension};
use dem::measure::{bed_span, profile};
use dem::{
    Body, Domain, Drive, Grains, Horizontal, Model, Solver, State, StressLoad, Sums, Surface, Wall,
    WallMotion, WallState,
};
use enum_map::EnumMap;
use experiments::output::{FileKind, Frame, Header, Plan, Writer, catalogue, state};
use experiments::protocol::Past;
use glam::DVec3;
use std::sync::Arc;
use tests::{floor, smooth};

const PLACES: [usize; 3] = [5, 6, 6];
const RADIUS: f64 = 0.01;
const SPACING: f64 = 2.1 * RADIUS;

fn model() -> Model {
    let size = [SPACING * PLACES[0] as f64, SPACING * PLACES[1] as f64];
    let load = StressLoad {
        mean: 10e3,
        amplitude: 0.0,
        frequency: 0.0,
        area: size[0] * size[1],
        mass: 0.1,
        damping: 50.0,
    };
    let law = Linear {
        sliding: Some(Sliding {
            stiffness: 3e4,
            damping: 0.0,
            friction_static: 0.5,
            friction_dynamic: 0.4,
        }),
        ..smooth(1e5, 10.0, Tension::Clip)
    };
    let bottom = floor(Surface::Frictionless);
    let top = Wall {
        name: "top".into(),
        normal: DVec3::NEG_Z,
        motion: WallMotion::Stress(load),
        ..bottom.clone()
    };
    Model {
        domain: Domain {
            size,
            periodic: [true, true],
        },
        walls: vec![bottom, top],
        drive: Some(Drive::Velocity(0.05)),
        step: 2e-5,
        ..tests::model(law, &Grains::default())
    }
}

/// A lattice with every grain a little off its place, so that it crumbles under the load.
fn start() -> State {
    let mut state = State::default();
    let [nx, ny, nz] = PLACES;
    for k in 0..nx * ny * nz {
        let place = [k % nx, k / nx % ny, k / (nx * ny)].map(|p| p as f64 + 0.5);
        // Fractions of multiples of irrational numbers scatter well enough.
        let off = [2.0, 3.0, 5.0].map(|p: f64| 0.1 * (k as f64 * p.sqrt()).fract());
        let at = (DVec3::from_array(place) + DVec3::from_array(off)) * SPACING;
        let grain = state.grains.add_sphere(at, RADIUS, 2600.0) as usize;
        let layer = k / (nx * ny);
        let constraint = &mut state.grains.constraint[grain];
        constraint.rotation_held = layer == 0 || layer == nz - 1;
        constraint.horizontal = match layer {
            0 => Horizontal::Held,
            layer if layer == nz - 1 => Horizontal::Driven,
            _ => Horizontal::Free,
        };
    }
    let top = SPACING * (nz as f64 + 0.2);
    state.walls = [0.0, -top]
        .map(|offset| WallState {
            offset,
            velocity: 0.0,
        })
        .into();
    state
}

/// The bed after `steps` steps.
fn sheared(steps: u64) -> Solver {
    let mut solver = Solver::new(model(), start(), 1).unwrap();
    solver.advance(steps).unwrap();
    solver
}

/// Every variable of every file of dry grains.
fn everything() -> Plan {
    let names = |kind| catalogue::names(kind).into_iter().map(Into::into).collect();
    Plan {
        variables: EnumMap::from_fn(|kind| (kind != FileKind::Fluid).then(|| names(kind))),
        profile_edges: vec![0.0, 0.03, 0.06, 0.09],
        cells: None,
    }
}

fn read(solver: &Solver, before: &Sums, name: &str) -> f64 {
    let named = |s: &&dem::output::Scalar| s.variable.name == name;
    let scalar = dem::output::SERIES.iter().find(named).unwrap();
    solver.snapshot().read(scalar, solver.model(), before)
}

#[test]
fn the_contacts_make_up_the_force_on_every_grain() {
    let solver = sheared(20_000);
    let now = solver.snapshot();
    let mut sum = vec![DVec3::ZERO; now.state.grains.len()];
    for contact in &now.state.contacts {
        sum[contact.i as usize] += contact.force;
        if let Body::Grain(j) = contact.j {
            sum[j as usize] -= contact.force;
        }
    }
    assert!(
        now.state.contacts.len() > 300,
        "a dense bed has many contacts"
    );
    for (k, (sum, force)) in sum.into_iter().zip(now.force).enumerate() {
        let held = now.state.grains.constraint[k].horizontal != Horizontal::Free;
        let apart = sum - force;
        let apart = if held { apart * DVec3::Z } else { apart };
        // Newtons: a grain carries about 10 kPa x (2 cm)² = 4 N.
        assert!(
            apart.length() < 1e-12,
            "grain {k}: {sum} of contacts, {force} in all"
        );
    }
}

#[test]
fn the_stress_profile_is_that_of_the_walls_and_layers() {
    let mut solver = sheared(20_000);
    let before = solver.snapshot().sums;
    let mut mean = vec![glam::DMat3::ZERO; 3];
    let readings = 400;
    for _ in 0..readings {
        solver.advance(100).unwrap();
        let now = solver.snapshot();
        let [low, high] = bed_span(solver.model(), &now.state);
        // Inside the bed, between held and driven grains.
        let (bottom, top) = (low + 4.0 * RADIUS, high - 4.0 * RADIUS);
        let edges = [0.0, 1.0, 2.0, 3.0].map(|l| bottom + (top - bottom) * l / 3.0);
        let stress = profile::stress(solver.model(), &now.state, &edges);
        for (sum, stress) in mean.iter_mut().zip(stress) {
            *sum += stress * (1.0 / f64::from(readings));
        }
    }
    let normal = read(&solver, &before, "normal_stress_top_mean");
    let shear = read(&solver, &before, "shear_stress_top_mean");
    let below = read(&solver, &before, "shear_stress_bottom_mean");
    // What is left after a mean over 0.8 s is the change of momentum.
    assert_relative_eq!(normal, 10e3, max_relative = 3e-3);
    assert_relative_eq!(shear, below, max_relative = 3e-3);
    for stress in mean {
        assert_relative_eq!(stress.z_axis.z, normal, max_relative = 3e-3);
        // Compression is positive: the force on the upper side points along -x.
        assert_relative_eq!(stress.z_axis.x, -shear, max_relative = 3e-3);
    }
}

/// All that acts on the grains along x from outside comes from the walls.
#[test]
fn rough_walls_feel_what_the_grains_feel() {
    let mut model = model();
    model.walls[0].surface = Surface::Full;
    model.walls[1].surface = Surface::Full;
    let mut solver = Solver::new(model, start(), 1).unwrap();
    solver.advance(20_000).unwrap();
    let now = solver.snapshot();
    let free: DVec3 = now.force.iter().sum();
    let on_grains = free.x + now.held_force + now.driven_force;
    let [top, bottom] = ["top", "bottom"].map(|wall| {
        let name = format!("wall_shear_stress_{wall}_x");
        read(&solver, &Sums::default(), &name) * solver.model().domain.area()
    });
    assert!(top > 1.0, "the driven grains rub on the top wall: {top} N");
    assert_relative_eq!(top + bottom, -on_grains, epsilon = 1e-12);
}

#[test]
fn interval_means_are_the_mean_of_the_steps() {
    let mut solver = sheared(20_000);
    let before = solver.snapshot().sums;
    let names = [
        "shear_stress_top",
        "shear_stress_bottom",
        "normal_stress_top",
    ];
    let mut sums = [0.0; 3];
    let steps = 50;
    for _ in 0..steps {
        solver.advance(1).unwrap();
        for (sum, name) in sums.iter_mut().zip(names) {
            *sum += read(&solver, &before, name);
        }
    }
    for (sum, name) in sums.iter().zip(names) {
        let mean = read(&solver, &before, &format!("{name}_mean"));
        assert_relative_eq!(mean, sum / f64::from(steps), max_relative = 1e-12);
    }
}

fn header() -> Header {
    Header {
        title: "a test".into(),
        scene: String::new(),
        seed: Some(0),
        backend: "cpu",
        device: "a processor".into(),
    }
}

#[test]
fn writing_does_not_change_a_bit() {
    let mut silent = sheared(5_000);
    silent.advance(1_000).unwrap();

    let dir = tempfile::tempdir().unwrap();
    let mut solver = sheared(5_000);
    let model = Arc::new(solver.model().clone());
    let header = header();
    let grains = &solver.snapshot().state.grains;
    let writer = Writer::create(dir.path(), &header, &everything(), &[], grains).unwrap();
    for _ in 0..10 {
        solver.advance(100).unwrap();
        let snapshot = Arc::new(solver.snapshot());
        let frame = Frame {
            model: model.clone(),
            snapshot,
            before: Sums::default(),
            water: None,
            phase: 0,
            strain: 0.0,
            dilation: 0.0,
            due: EnumMap::from_fn(|_| true),
        };
        writer.send(frame).unwrap();
    }
    writer.finish().unwrap();
    assert!(solver.snapshot() == silent.snapshot());
}

/// From the middle of a phase: velocities stand at the time of the positions in a state, and
/// half a step behind in the solver, where dashpots see them; half a step of a dashpot's change is
/// what going on may differ by.
#[test]
fn going_on_in_mid_phase_is_as_accurate_as_a_step() {
    let mut whole = sheared(5_000);
    let mut rest = Solver::new(model(), whole.snapshot().state, 1).unwrap();
    for _ in 0..10 {
        whole.advance(1).unwrap();
        rest.advance(1).unwrap();
        let (whole, rest) = (whole.snapshot().state.grains, rest.snapshot().state.grains);
        let pairs = whole.velocity.iter().zip(&rest.velocity);
        let apart = pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let fastest = whole
            .velocity
            .iter()
            .map(|v| v.length())
            .fold(0.0, f64::max);
        assert!(apart < 1e-3 * fastest, "{apart} of {fastest} m/s");
    }
}

/// A phase ends with a state, and the next one is a new solver with it.
#[test]
fn going_on_from_the_disk_gives_the_same_bits() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("state.h5");
    let state = sheared(5_000).snapshot().state;
    let saved = state::Saved {
        state: state.clone(),
        domain: model().domain,
        past: Past::default(),
    };
    state::save(&path, &saved, &header()).unwrap();

    let advanced = |state| {
        let mut solver = Solver::new(model(), state, 1).unwrap();
        solver.advance(1_000).unwrap();
        solver.snapshot()
    };
    assert!(advanced(state::load(&path).unwrap().state) == advanced(state));
}
