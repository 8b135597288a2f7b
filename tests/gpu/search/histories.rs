//! What contacts remember follows them through searches.

use super::bed::{Bed, INDEX, Motion, SLIDING, TOUCHING, World};
use super::*;
use dem::gpu::control::CROWDED;
use std::collections::BTreeMap;

pub fn list(suite: &mut Suite) {
    suite.gpu(
        "histories_and_rows_survive_searches_and_new_orders",
        histories_and_rows_survive_searches_and_new_orders,
    );
    suite.gpu(
        "too_little_room_for_touching_entries_loses_none",
        too_little_room_for_touching_entries_loses_none,
    );
}

/// Touching entries by the identities of both grains: flags and springs and forces.
type Contacts = BTreeMap<(u32, u32), (u32, [f32; 4], [f32; 4])>;

fn contacts(world: &World, bed: &Bed) -> Contacts {
    let motions = world.bed(bed).motions;
    let springs = world.device.read(&world.springs).unwrap();
    let forces = world.device.read(&world.forces).unwrap();
    let lists = world.device.read(&world.lists).unwrap();
    let mut found = Contacts::new();
    for (s, words) in world.neighbours().iter().enumerate() {
        for (k, word) in words.iter().enumerate() {
            let e = lists[s][0] as usize + k;
            let key = (motions[s].id, motions[(word & INDEX) as usize].id);
            if word & TOUCHING == 0 {
                assert_eq!(
                    (springs[e], forces[e]),
                    ([0.0; 4], [0.0; 4]),
                    "{key:?} is new"
                );
                assert_eq!(word & SLIDING, 0);
            } else {
                found.insert(key, (word & !INDEX, springs[e], forces[e]));
            }
        }
    }
    found
}

/// Let pairs that overlap touch, and remember who they are; the others remember nothing.
fn touch(world: &World, bed: &Bed, round: u32) -> usize {
    let now = world.bed(bed);
    let lists = world.device.read(&world.lists).unwrap();
    let mut words = world.device.read(&world.neighbours).unwrap();
    let mut springs = world.device.read(&world.springs).unwrap();
    let mut forces = world.device.read(&world.forces).unwrap();
    let mut touching = 0;
    for (s, &[first, count]) in lists.iter().enumerate() {
        for e in first as usize..(first + count) as usize {
            let other = (words[e] & INDEX) as usize;
            let (a, b) = (now.motions[s].id, now.motions[other].id);
            words[e] &= INDEX;
            (springs[e], forces[e]) = ([0.0; 4], [0.0; 4]);
            if now.gap(s, other) < 0.0 {
                words[e] |= TOUCHING | (SLIDING * ((a + b + round) % 2));
                springs[e] = [a as f32, b as f32, round as f32, 1.0];
                forces[e] = [b as f32, a as f32, 2.0, round as f32];
                touching += 1;
            }
        }
    }
    world.device.write(&world.neighbours, 0, &words);
    world.device.write(&world.springs, 0, &springs);
    world.device.write(&world.forces, 0, &forces);
    touching
}

fn histories_and_rows_survive_searches_and_new_orders(device: &Device) {
    let r = 2e6;
    let size = [(30.0 * r) as i32, (26.0 * r) as i32, (28.0 * r) as i32];
    for ratio in [1.0, 10.0f64] {
        let bed = Bed::random(3000, size, true, r / ratio.powf(0.4), ratio);
        let mut world = World::new(device, &bed, 7, 400_000);
        world.check();
        let mut dice = Dice(5);
        for round in 0..6 {
            let touching = touch(&world, &bed, round);
            assert!(touching > 1000, "{touching}");
            let before = contacts(&world, &bed);
            assert_eq!(before.len(), touching);
            // Everything moves by less than a quarter of the skin; some leave through a side.
            let mut now = world.bed(&bed);
            for place in &mut now.places {
                for axis in 0..3 {
                    place.hi[axis] += (0.5 * now.skin * (dice.next() - 0.5)) as i32;
                    if axis < 2 {
                        place.hi[axis] = place.hi[axis].rem_euclid(now.lengths[axis]);
                    }
                }
            }
            let half = now.len();
            device.write(&world.places, half, &now.places);
            if round == 3 {
                world.change(|control| control.skin = 0.0);
                world.grow(500_000, 2 * touching);
            }
            world.search();
            let control = world.control();
            assert_eq!((control.flags, control.lost), (0, 0));
            assert_eq!(control.touching as usize, touching);
            assert_eq!(contacts(&world, &bed), before);
            let motions: Vec<Motion> = world.bed(&bed).motions;
            let rows = device.read(&world.rows).unwrap();
            for (motion, row) in motions.iter().zip(rows) {
                assert_eq!(row, [motion.id; 12]);
                assert_eq!(motion.spin[2], motion.id as f32);
            }
        }
    }
}

fn too_little_room_for_touching_entries_loses_none(device: &Device) {
    let r = 2e6;
    let bed = Bed::random(1000, [(20.0 * r) as i32; 3], true, r, 1.0);
    let mut world = World::new(device, &bed, 0, 100_000);
    world.check();
    let touching = touch(&world, &bed, 1);
    let before = contacts(&world, &bed);
    world.grow(100_000, touching - 1);
    world.search();
    let control = world.control();
    assert_eq!(control.flags, CROWDED);
    assert_eq!(control.touching as usize, touching);
    assert_eq!(contacts(&world, &bed), before);
    world.grow(100_000, touching);
    world.check();
    assert_eq!(world.control().flags, 0);
    assert_eq!(contacts(&world, &bed), before);
}
