//! What goes along with the grains pushes them in every step as gravity does, and costs nothing
//! when absent.

use dem::{Bed, Companion, Moved, Row, Threads};
use glam::DVec3;
use std::ops::Range;
use std::sync::Mutex;
use tests::solver_on;

/// A pull on all grains [N/kg], and a force that pushes the top wall away [N].
struct Pull {
    pull: DVec3,
    lift: f64,
    /// Steps from one exchange to the next.
    every: u64,
    /// Sums of the grains' ways upwards at each exchange [m].
    ways: Mutex<Vec<f64>>,
    mass: Vec<f64>,
    arranged: usize,
    /// Steps in which it was alone, and was settled.
    alone: Vec<u64>,
    settled: Vec<u64>,
}

impl Pull {
    fn new(pull: DVec3, lift: f64) -> Self {
        Self {
            pull,
            lift,
            every: 1,
            ways: Mutex::default(),
            mass: Vec::new(),
            arranged: 0,
            alone: Vec::new(),
            settled: Vec::new(),
        }
    }
}

impl Companion for Pull {
    fn arrange(&mut self, bed: &Bed) -> Result<(), String> {
        self.mass = bed.mass.to_vec();
        self.arranged += 1;
        Ok(())
    }
    fn exchanges(&self, step: u64) -> bool {
        step.is_multiple_of(self.every)
    }
    fn follow(&self, moved: &Moved, threads: &Threads) {
        assert!(moved.step > 0 && moved.passed[0] > 0 && moved.passed[0] <= self.every);
        for _ in threads.share(1) {
            let ways = moved.way[..self.mass.len()].iter().map(|way| way.xyz().z);
            self.ways.lock().unwrap().push(ways.sum());
        }
        threads.meet();
    }
    fn wants_to_be_alone(&self, step: u64) -> bool {
        step.is_multiple_of(50)
    }
    fn alone(&mut self, moved: &Moved) {
        self.alone.push(moved.step);
    }
    fn due(&self, step: u64) -> bool {
        step.is_multiple_of(100)
    }
    fn settle(&mut self, bed: &Bed) -> Result<(), String> {
        self.settled.push(bed.step);
        if bed.step >= 10_000 {
            return Err("ten thousand steps are enough".into());
        }
        Ok(())
    }
    fn push(&self, _: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]) {
        threads.meet();
        for (force, mass) in force.iter_mut().zip(&self.mass[own]) {
            *force = Row::new(force.xyz() + *mass * self.pull, force.w());
        }
    }
    fn wall_force(&self, wall: usize) -> f64 {
        if wall == 1 { self.lift } else { 0.0 }
    }
}

#[test]
fn one_that_does_nothing_gives_the_same_bits_as_none() {
    let (model, start) = tests::bed::Bed::new(300, 6.0, 0.5, 2).sheared(0.05);
    for threads in [1, 2] {
        let mut alone = solver_on(&model, &start, threads);
        alone.advance(500).unwrap();
        let mut together = solver_on(&model, &start, threads);
        let mut idle = Pull::new(DVec3::ZERO, 0.0);
        together.advance_together(300, &mut idle).unwrap();
        together.advance_together(200, &mut idle).unwrap();
        assert!(together.snapshot().state == alone.snapshot().state);
        assert!(idle.settled.iter().copied().eq((1..=5).map(|k| 100 * k)));
        assert!(idle.alone.iter().copied().eq((1..=10).map(|k| 50 * k)));
        assert!(idle.arranged > 1, "no search was made");
        // It stays.
        assert!(together.advance(1).is_err());
    }
}

#[test]
fn a_pull_in_every_step_moves_a_bed_as_gravity_does() {
    let (mut model, start) = tests::bed::Bed::new(300, 6.0, 0.5, 2).sheared(0.05);
    let pull = DVec3::new(0.02, 0.01, -0.1);
    let mut fallen = solver_on(
        &dem::Model {
            gravity: pull,
            ..model.clone()
        },
        &start,
        1,
    );
    fallen.advance(300).unwrap();
    let fallen = fallen.snapshot().state.grains;
    model.ledger = true;
    for every in [1, 7] {
        let mut pulled = solver_on(&model, &start, 2);
        let mut pulls = Pull::new(pull, 0.0);
        pulls.every = every;
        pulled.advance_together(300, &mut pulls).unwrap();
        let now = pulled.snapshot();
        let grains = &now.state.grains;
        let mut work = 0.0;
        for k in 0..fallen.len() {
            let way = grains.displacement[k] - fallen.displacement[k];
            assert!(way.length() < 1e-9, "grain {k} is off by {way}");
            work +=
                grains.mass[k] * pull.dot(grains.displacement[k] - start.grains.displacement[k]);
        }
        // Also of forces that are still held.
        let booked = now.ledger.work_companion;
        assert!((booked / work - 1.0).abs() < 1e-6, "{booked} of {work} J");
        // What grains have moved is told to the last bit of their places.
        let searched = pulls.arranged > 1;
        let ways = pulls.ways.lock().unwrap().iter().sum::<f64>();
        let (_, since, _) = pulled.since_exchange();
        let ways = ways + since.iter().map(|way| way.xyz().z).sum::<f64>();
        let moved = |g: &dem::Grains| g.displacement.iter().map(|d| d.z).sum::<f64>();
        let moved = moved(grains) - moved(&start.grains);
        assert!(
            searched && (ways - moved).abs() < 1e-12,
            "{ways} of {moved} m"
        );
    }
}

#[test]
fn a_push_on_the_wall_works_against_its_load() {
    let (model, start) = tests::bed::Bed::new(300, 6.0, 0.5, 2).compressed();
    let dem::WallMotion::Stress(load) = model.walls[1].motion else {
        unreachable!("the top wall is under stress");
    };
    // A load that is higher by what pushes back is the same.
    let lift = 0.3 * load.mean * load.area;
    let mut pushed = solver_on(&model, &start, 1);
    pushed
        .advance_together(300, &mut Pull::new(DVec3::ZERO, lift))
        .unwrap();
    let mut lighter = model.clone();
    lighter.walls[1].motion = dem::WallMotion::Stress(dem::StressLoad {
        mean: 0.7 * load.mean,
        ..load
    });
    let mut unloaded = solver_on(&lighter, &start, 1);
    unloaded.advance(300).unwrap();
    let (a, b) = (
        pushed.snapshot().state.walls[1],
        unloaded.snapshot().state.walls[1],
    );
    assert!((a.offset - b.offset).abs() < 1e-12 && b.velocity != 0.0);
    assert!((a.velocity - b.velocity).abs() < 1e-10, "{a:?} {b:?}");
}

#[test]
fn what_makes_it_impossible_to_go_on_is_told() {
    let (model, start) = tests::bed::Bed::new(300, 6.0, 0.5, 2).compressed();
    let mut solver = solver_on(&model, &start, 1);
    let error = solver
        .advance_together(20_000, &mut Pull::new(DVec3::ZERO, 0.0))
        .unwrap_err();
    assert_eq!(error.to_string(), "ten thousand steps are enough");
}
