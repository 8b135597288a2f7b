//! When a search is due, and how far lists are good: grains in free flight.

use super::bed::{Bed, INDEX, World};
use super::*;
use dem::gpu::control::{GONE, UNSTABLE};
use shaders::compose_text;

pub fn list(suite: &mut Suite) {
    suite.gpu(
        "lists_have_every_pair_that_meets_at_every_step",
        lists_have_every_pair_that_meets_at_every_step,
    );
    suite.gpu(
        "searches_do_not_depend_on_how_many_steps_are_asked_for",
        searches_do_not_depend_on_how_many_steps_are_asked_for,
    );
    suite.gpu(
        "cells_find_room_in_beds_of_many_millions",
        cells_find_room_in_beds_of_many_millions,
    );
    suite.gpu(
        "grains_at_rest_are_searched_once",
        grains_at_rest_are_searched_once,
    );
    suite.gpu(
        "a_grain_that_speeds_up_ends_the_group",
        a_grain_that_speeds_up_ends_the_group,
    );
    suite.gpu("what_runs_away_stops_all", what_runs_away_stops_all);
    suite.gpu(
        "the_skin_adapts_to_the_interval_that_is_aimed_at",
        the_skin_adapts_to_the_interval_that_is_aimed_at,
    );
    suite.gpu(
        "a_skin_beyond_its_bounds_is_not_taken",
        a_skin_beyond_its_bounds_is_not_taken,
    );
}

const GROUP: u32 = 32;

struct Flight {
    world: World,
    bed: Bed,
    fly: Bound,
}

impl Flight {
    fn new(device: &Device, bed: &Bed) -> Self {
        let world = World::new(device, bed, 0, 100_000);
        let module = compose_text("flight.wgsl", include_str!("flight.wgsl"), &Flags::new());
        let kernel = device.kernel(&module.unwrap(), "fly").unwrap();
        let ticks = device.ticks(GROUP as usize).unwrap();
        let plan = world.plan(100_000);
        let arrays: [(&str, &dyn Bindable); 5] = [
            ("control", &world.control),
            ("plan", &plan),
            ("places", &world.places),
            ("motions", &world.motions),
            ("tick", &ticks),
        ];
        let fly = kernel.bind(device, &arrays).unwrap();
        Self {
            world,
            bed: bed.clone(),
            fly,
        }
    }

    /// One group of dispatches.
    fn group(&self) -> Control {
        let mut recording = self.world.device.record();
        self.world.search.record(&mut recording);
        for tick in 0..GROUP {
            recording.dispatch_at(&self.fly, tick, groups(self.bed.len(), 64));
        }
        self.world.search.settle(&mut recording);
        recording.submit().unwrap();
        self.world.control()
    }

    /// Make `steps` steps and the check after them.
    fn advance(&self, steps: u32) -> Control {
        self.world
            .change(|control| control.end = control.base + steps);
        let end = self.world.control().end;
        for _ in 0..=2 * steps {
            if self.group().base == end {
                break;
            }
        }
        self.world.check();
        let control = self.world.control();
        assert_eq!((control.base, control.flags), (end, 0));
        control
    }

    fn now(&self) -> Bed {
        self.world.bed(&self.bed)
    }
}

/// Grains at random speeds up to `speed` [m/s], changing at random.
fn gas(n: usize, speed: f64) -> Bed {
    let r = 2e6;
    let size = [(14.0 * r) as i32, (13.0 * r) as i32, (12.0 * r) as i32];
    let mut bed = Bed::random(n, size, true, r, 2.0);
    let mut dice = Dice(3);
    for motion in &mut bed.motions {
        motion.velocity = [0; 3].map(|_| (speed * (2.0 * dice.next() - 1.0)) as f32);
        motion.spin = [0; 3].map(|_| (0.003 * speed * (2.0 * dice.next() - 1.0)) as f32);
    }
    bed
}

fn lists_have_every_pair_that_meets_at_every_step(device: &Device) {
    let flight = Flight::new(device, &gas(150, 2.0));
    let mut searched = 0;
    let mut then = flight.bed.clone();
    let mut meetings = 0;
    for step in 1..=200 {
        let control = flight.advance(1);
        let now = flight.now();
        if control.searches > searched {
            searched = control.searches;
            then = now.clone();
        }
        let lists = flight.world.neighbours();
        for (a, list) in lists.iter().enumerate() {
            assert!(
                now.way(&then, a) < 0.5 * now.skin,
                "step {step}: grain {a} went too far"
            );
            for b in 0..now.len() {
                if a != b && now.gap(a, b) <= 0.0 {
                    let found = list.iter().any(|word| word & INDEX == b as u32);
                    assert!(found, "step {step}: {a} misses {b}");
                    meetings += 1;
                }
            }
        }
    }
    assert!(searched > 5, "{searched} searches");
    assert!(meetings > 1000, "{meetings} meetings");
}

fn searches_do_not_depend_on_how_many_steps_are_asked_for(device: &Device) {
    let mut bed = gas(200, 2.0);
    bed.skins = [0.3, 5.0];
    let (one, many) = (Flight::new(device, &bed), Flight::new(device, &bed));
    let whole = one.advance(500);
    let mut control = many.world.control();
    for steps in [1, 7, 32, 50, 110, 3, 1, 96, 200] {
        control = many.advance(steps);
    }
    assert_eq!(control, whole);
    assert!(whole.searches > 5, "{} searches", whole.searches);
    let (a, b) = (one.now(), many.now());
    assert_eq!(a.places, b.places);
    assert_eq!(a.motions, b.motions);
    assert_eq!(one.world.neighbours(), many.world.neighbours());
}

/// Cells of which there are one more than room, by a product that f32 rounds down: 2^24 + 1 is
/// 97 * 257 * 673.
fn cells_find_room_in_beds_of_many_millions(device: &Device) {
    let mut plan = Plan::default();
    // Ten million grains, but for their number nothing is needed of them.
    (plan.count, plan.cell_room) = (10_000_000, 1 << 24);
    (plan.unit, plan.step, plan.diameter) = (1e-9, 1e-6, 995);
    // With a skin of one unit and four for rounding, cells are 1000 units wide.
    let control = Control::new(GROUP, 1e3, 1e-9);
    let extent = [0, 0, 0, 96_999, 256_999, 672_999];
    let control = device.array_of("control", &[control]).unwrap();
    let plan = device.array_of("plan", &[plan]).unwrap();
    let extent = device.array_of::<i32>("extent", &extent).unwrap();
    let grid = device.array::<Grid>("grid", 1).unwrap();
    let sizes = device.array::<u32>("sizes", 15).unwrap();
    let module = compose("dem/search/check.wgsl", &Flags::new()).unwrap();
    let decide = device.kernel(&module, "decide").unwrap();
    let arrays: [(&str, &dyn Bindable); 5] = [
        ("control", &control),
        ("plan", &plan),
        ("extent", &extent),
        ("grid", &grid),
        ("sizes", &sizes),
    ];
    let mut recording = device.record();
    recording.dispatch(&decide.bind(device, &arrays).unwrap(), [1, 1, 1]);
    recording.submit().unwrap();
    let found = device.read(&grid).unwrap()[0];
    let [x, y, z] = found.cells;
    assert_eq!(found.total, x * y * z);
    assert!((1 << 22..=1 << 24).contains(&found.total), "{found:?}");
    // Sizes of dispatches stay below what devices take along one axis, and reach all grains.
    let sizes = device.read(&sizes).unwrap();
    assert!(sizes.iter().all(|&size| size <= 65_535), "{sizes:?}");
    assert!(u64::from(sizes[0] * sizes[1]) * 64 >= 10_000_000);
}

fn grains_at_rest_are_searched_once(device: &Device) {
    let flight = Flight::new(device, &gas(100, 0.0));
    let control = flight.advance(1000);
    assert_eq!(control.searches, 1);
    assert!(control.good > 1000);
}

fn a_grain_that_speeds_up_ends_the_group(device: &Device) {
    let mut bed = gas(100, 0.1);
    bed.motions[42].spin = [0.5, 0.0, 0.0];
    let flight = Flight::new(device, &bed);
    let mut made = Vec::new();
    let mut base = 0;
    while base < 200 {
        let control = flight.group();
        assert_eq!(control.flags, 0);
        made.push(control.base - base);
        base = control.base;
    }
    // Half the skin in 32 steps is 2.9 m/s, and 6 steps lead to 3 m/s.
    assert_eq!(made[0], 6, "{made:?}");
    assert!(flight.world.control().searches > 3);
}

fn what_runs_away_stops_all(device: &Device) {
    for (speed, way) in [
        (2e3, "fast"),
        (f32::NAN, "nowhere"),
        (f32::INFINITY, "everywhere"),
    ] {
        let mut bed = gas(100, 0.1);
        bed.motions[7].spin = [0.0, speed, 0.0];
        let flight = Flight::new(device, &bed);
        let control = flight.group();
        assert_eq!((control.flags, control.base), (UNSTABLE, 1), "{way}");
        let control = flight.group();
        assert_eq!((control.flags, control.base), (UNSTABLE, 1), "{way}");
    }
    let mut bed = gas(100, 0.1);
    bed.places[3].hi[2] = (1 << 30) + 5;
    let control = Flight::new(device, &bed).group();
    assert_eq!(
        (control.flags, control.base, control.searches),
        (GONE, 0, 0)
    );
}

fn the_skin_adapts_to_the_interval_that_is_aimed_at(device: &Device) {
    for (speed, first) in [(0.5, 0.2), (0.5, 8.0)] {
        let mut bed = gas(100, speed);
        bed.motions.iter_mut().for_each(|m| m.spin = [0.0; 3]);
        bed.skins = [1e-3, 1e3];
        bed.skin *= first;
        let flight = Flight::new(device, &bed);
        let before = flight.advance(2000);
        let after = flight.advance(2000);
        let interval = 2000.0 / f64::from(after.searches - before.searches);
        // Checks are every 32 steps.
        assert!((64.0..=136.0).contains(&interval), "every {interval} steps");
    }
}

fn a_skin_beyond_its_bounds_is_not_taken(device: &Device) {
    let mut bed = gas(100, 2.0);
    bed.skins = [0.5, 1.5];
    let flight = Flight::new(device, &bed);
    let before = flight.advance(10).skin;
    // Searches follow faster than every 100 steps.
    assert_eq!(flight.advance(400).skin, 1.5 * before);
}
