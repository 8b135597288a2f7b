//! Arrays that outgrow a binding: the same bits from several parts as from one, and numbers where not
//! even parts help.

use crate::lab::Suite;
use crate::same_bits::{assert_same, case};
use dem::gpu::memory::{Bounds, Memory};
use dem::{ContactLaw, Model, Snapshot, State, WallState, gpu};
use experiments::backend::Machine;
use experiments::engine::Engine;
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shaders::Device;
use tests::bed::Bed;
use tests::solver;

pub fn list(suite: &mut Suite) {
    suite.gpu("arrays_in_parts_hold_what_one_holds", arrays);
    suite.gpu("the_same_bits_from_lists_in_parts", lists);
    suite.gpu("the_same_bits_from_lists_that_grow_in_parts", grown);
    suite.gpu("too_many_grains_for_bindings_are_refused", refused);
    suite.long("a_bed_larger_than_a_binding_of_128_mib", large);
}

/// The adapter of `device`, opened to show a kernel no more than this many bytes of an array.
fn narrow(device: &Device, binding: u64) -> Device {
    let mut adapter = (*device.adapter).clone();
    adapter.limits.max_storage_buffer_binding_size = binding;
    Device::open_adapter(adapter).unwrap()
}

fn arrays(device: &Device) {
    let narrow = narrow(device, 1 << 14);
    let len = 10_000;
    let numbers: Vec<[u32; 4]> = (0..len).map(|k| [k, k + 1, k + 2, k + 3]).collect();
    assert!(narrow.array::<[u32; 4]>("one", len as usize).is_err());
    let array = narrow.array_in_parts("several", len as usize).unwrap();
    narrow.write(&array, 0, &numbers);
    assert!(narrow.read(&array).unwrap() == numbers);
    // Ranges that begin and end inside of parts: 1024 elements each.
    narrow.write(&array, 1000, &[[7; 4]; 3000]);
    let mut recording = narrow.record();
    let other = narrow.array_in_parts("other", 9000).unwrap();
    recording.copy(&array, 900, &other, 10, 8000);
    recording.submit().unwrap();
    let mut reading = narrow.reading();
    let parts = [reading.add(&other, 1015..5000), reading.add(&other, 3..3)];
    let arrived = reading.wait().unwrap();
    let [found, nothing] = parts.map(|part| arrived.take(part));
    let mut expected = numbers;
    expected[1000..4000].fill([7; 4]);
    assert!(found == expected[1905..5890]);
    assert!(nothing.is_empty());
}

/// Steps with a search now and then, and a reading in their midst.
fn run(device: &Device, (model, state): &(Model, State), steps: u64) -> (Snapshot, u64, usize) {
    let lanes = 2;
    let mut solver = gpu::Solver::with_lanes(device, lanes, model.clone(), state.clone()).unwrap();
    solver.advance(steps / 2).unwrap();
    let _ = solver.snapshot().unwrap();
    solver.advance(steps / 2).unwrap();
    let entries = 2 * solver.near_pairs();
    (solver.snapshot().unwrap(), solver.searches(), entries)
}

/// The same with bindings of so many bytes. The first room for neighbours is 2464 entries of 16.
/// Returns searches and entries.
fn compare(device: &Device, case: &(Model, State), steps: u64, binding: u64) -> (u64, usize) {
    let (one, searches, entries) = run(device, case, steps);
    let (several, ..) = run(&narrow(device, binding), case, steps);
    assert_same(&one, &several, &format!("bindings of {binding} bytes"));
    (searches, entries)
}

/// Springs, forces, rolling springs and couples in two parts, over many searches.
fn lists(device: &Device) {
    let (searches, _) = compare(device, &case(), 600, 1 << 15);
    assert!(searches > 5, "{searches} searches");
}

/// Four parts and more, words of the lists in two, and lists that outgrow their first room: without
/// the ledger a reading sees fewer arrays.
fn grown(device: &Device) {
    let (mut model, state) = Bed::new(200, 5.0, 0.5, 11).sheared(0.5);
    model.ledger = false;
    model.skin = Some(0.8);
    let (searches, entries) = compare(device, &(model, state), 150, 1 << 14);
    assert!(
        searches >= 2 && entries > 3500,
        "{searches} searches, {entries} entries"
    );
}

/// What is told to fit does, and what is told not to does not: places of grains, of which a binding
/// takes 64 bytes each, and lists in more parts than a reading may see.
fn refused(device: &Device) {
    let (model, state) = Bed::new(500, 7.0, 0.5, 1).sheared(0.01);
    let n = state.grains.len() as u64;
    let mut bare = model.clone();
    bare.ledger = false;
    if let ContactLaw::Linear(law) = &mut bare.law {
        law.sliding = None;
    }
    let mut untouched = state.clone();
    untouched.contacts.clear();
    // Bindings [bytes], model, and do they take so many grains?
    for (binding, model, state, fits) in [
        (64 * n - 1, &bare, &untouched, Some(n - 1)),
        (64 * n, &bare, &untouched, None),
        (64 * n, &model, &state, Some(422)),
        (1 << 16, &model, &state, None),
    ] {
        let device = narrow(device, binding);
        let told = Memory::of(model, state).unwrap();
        let most = told.most_grains(n as usize, Bounds::of(&device.adapter));
        let solver = gpu::Solver::new(&device, model.clone(), state.clone());
        let Some(expected) = fits else {
            assert!(most >= n, "{most} in {binding}");
            assert!(solver.is_ok(), "{binding}");
            continue;
        };
        assert_eq!(most, expected, "in {binding}");
        assert!(solver.is_err(), "in {binding}");
        let engine = Engine::new(&Machine::Gpu(device), model.clone(), state.clone());
        let error = engine.err().unwrap().to_string();
        let said = format!("enough for about {most} grains");
        assert!(error.contains(&said), "{error}");
    }
}

/// 729 000 grains whose lists hold 13 million entries, 200 MiB an array, as near to the CPU as 8000 of
/// them whose lists lie in one part.
/// `cargo test --release -p tests --test gpu -- --ignored --nocapture larger_than`
fn large(device: &Device) {
    let small = lattice(device, 20);
    let large = lattice(device, 90);
    println!("velocities within {small:.1e} and {large:.1e}");
    // Of more grains the worst is worse.
    assert!(large < 5.0 * small, "{large:e} beside {small:e}");
}

/// How far velocities are off the CPU's after twenty steps of a shaken cubic lattice of `along` cubed
/// grains, with lists that reach to the second neighbours.
fn lattice(device: &Device, along: usize) -> f64 {
    const SPACING: f64 = 0.995;
    const STEPS: u64 = 20;
    let side = SPACING * along as f64;
    let bed = Bed::new(0, side, 0.5, 1);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut state = State::default();
    for k in 0..along.pow(3) {
        let site = [k % along, k / along % along, k / (along * along)];
        let place = DVec3::from(site.map(|s| (s as f64 + 0.5) * SPACING));
        let id = state.grains.add_sphere(place, 0.5, 1.0) as usize;
        let speed = [0, 1, 2].map(|_| random.random_range(-0.1..0.1));
        state.grains.velocity[id] = DVec3::from(speed);
    }
    state.walls = vec![WallState::default(); 2];
    state.walls[1].offset = -side;
    let mut model = bed.model(&state);
    model.skin = Some(0.45);
    let mut on_gpu = gpu::Solver::new(device, model, state.clone()).unwrap();
    on_gpu.advance(STEPS).unwrap();
    assert!(on_gpu.near_pairs() > 8 * along.pow(3));
    let mut cpu = solver(on_gpu.model(), &state);
    cpu.advance(STEPS).unwrap();
    let (a, b) = (cpu.snapshot(), on_gpu.snapshot().unwrap());
    let contacts = [&a, &b].map(|s| s.state.contacts.len());
    let bytes = on_gpu.memory() / state.grains.len() as u64;
    println!("{along} along: {bytes} bytes a grain, {contacts:?} contacts");
    assert!(contacts[0].abs_diff(contacts[1]) < 10, "{contacts:?}");
    let velocities = a.state.grains.velocity.iter().zip(&b.state.grains.velocity);
    velocities.map(|(v, w)| v.distance(*w)).fold(0.0, f64::max)
}
