//! Order and lists against trying all pairs.

use super::bed::{Bed, INDEX, World};
use super::*;
use dem::gpu::control::CROWDED;

pub fn list(suite: &mut Suite) {
    suite.gpu(
        "lists_hold_the_pairs_that_trying_all_of_them_finds",
        lists_hold_the_pairs_that_trying_all_of_them_finds,
    );
    suite.gpu(
        "order_and_lists_depend_on_places_and_identities_only",
        order_and_lists_depend_on_places_and_identities_only,
    );
    suite.gpu(
        "lists_without_room_change_nothing_until_they_have_it",
        lists_without_room_change_nothing_until_they_have_it,
    );
}

/// Random beds: one size and 1:10, periodic and open, sparse and very dense.
fn beds() -> Vec<(&'static str, Bed)> {
    let r = 2e6; // units, 3.7 mm
    let side = |n: f64| (n * r) as i32;
    vec![
        ("one", Bed::random(1, [side(9.0); 3], true, r, 1.0)),
        ("two", Bed::random(2, [side(6.0); 3], true, r, 1.0)),
        ("two, open", Bed::random(2, [side(3.0); 3], false, r, 1.0)),
        ("a hundred", Bed::random(100, [side(12.0); 3], true, r, 1.0)),
        (
            "a hundred in a small box",
            Bed::random(100, [side(5.2); 3], true, r, 1.0),
        ),
        (
            "a hundred, open, 1:10",
            Bed::random(100, [side(40.0); 3], false, r, 10.0),
        ),
        (
            "5000",
            Bed::random(5000, [side(34.0), side(28.0), side(30.0)], true, r, 1.0),
        ),
        (
            "5000, 1:10",
            Bed::random(5000, [side(120.0), side(101.0), side(90.0)], true, r, 10.0),
        ),
        (
            "5000, sparse",
            Bed::random(5000, [side(500.0); 3], false, r, 1.0),
        ),
        (
            "5000, sparse, 1:10",
            Bed::random(5000, [side(500.0); 3], true, r, 10.0),
        ),
        (
            "2000 on top of each other",
            Bed::random(2000, [side(6.0); 3], true, r, 1.0),
        ),
        ("none", Bed::random(0, [side(9.0); 3], true, r, 1.0)),
        ("two pairs in far corners", far_corners()),
        ("500 in one point", Bed::random(500, [1; 3], false, r, 1.0)),
    ]
}

/// Two pairs as far apart as places can be.
fn far_corners() -> Bed {
    let mut bed = Bed::random(4, [1; 3], false, 2e6, 1.0);
    for (k, place) in bed.places.iter_mut().enumerate() {
        let corner = if k < 2 { 0x3fff_ffff } else { -0x3fff_ffff };
        place.hi = [corner; 3];
        place.hi[k % 2] -= corner.signum() * 2_000_000;
    }
    bed
}

fn lists_hold_the_pairs_that_trying_all_of_them_finds(device: &Device) {
    let mut pairs = 0;
    for (name, bed) in beds() {
        let world = World::new(device, &bed, 0, 700_000);
        world.check();
        let control = world.control();
        assert_eq!(
            (control.searches, control.flags, control.lost),
            (u32::from(bed.len() > 0), 0, 0),
            "{name}"
        );
        let now = world.bed(&bed);
        let lists = world.neighbours();
        assert_eq!(
            control.entries as usize,
            lists.iter().map(Vec::len).sum::<usize>()
        );
        let mut ids: Vec<u32> = now.motions.iter().map(|m| m.id).collect();
        ids.sort_unstable();
        assert!(
            ids.iter().copied().eq(0..bed.len() as u32),
            "{name}: a grain is lost"
        );
        for (a, list) in lists.iter().enumerate() {
            let mut list = list.clone();
            list.sort_unstable();
            let entries = list.len();
            list.dedup();
            assert_eq!(
                list.len(),
                entries,
                "{name}: grain {a} has a neighbour twice"
            );
            for (b, other) in lists.iter().enumerate() {
                let found = list.binary_search(&(b as u32)).is_ok();
                if a == b {
                    assert!(!found, "{name}: grain {a} is its own neighbour");
                    continue;
                }
                let gap = now.gap(a, b);
                let reach = f64::from(now.places[a].radius_hi + now.places[b].radius_hi);
                if gap <= now.skin {
                    assert!(found, "{name}: {a} misses {b} at {gap} units");
                    pairs += 1;
                } else if found {
                    let over = gap - now.skin;
                    assert!(
                        over < 8.0 + 4e-6 * reach,
                        "{name}: {a} holds {b} at {gap} units"
                    );
                    let back = other.iter().any(|word| word & INDEX == a as u32);
                    assert!(back, "{name}: {a} holds {b}, but not the reverse");
                }
            }
        }
    }
    assert!(pairs > 900_000, "{pairs} pairs");
}

fn order_and_lists_depend_on_places_and_identities_only(device: &Device) {
    for (name, bed) in beds().into_iter().filter(|(_, bed)| bed.len() == 5000) {
        let once = World::new(device, &bed, 0, 400_000);
        let again = World::new(device, &bed, 0, 400_000);
        let reversed = World::new(device, &bed.reversed(), 3, 400_000);
        for world in [&once, &again, &reversed] {
            world.check();
        }
        let (expected, lists) = (once.bed(&bed), once.neighbours());
        for world in [&again, &reversed] {
            let bed = world.bed(&bed);
            assert_eq!(bed.places, expected.places, "{name}");
            assert_eq!(bed.motions, expected.motions, "{name}");
            assert_eq!(world.neighbours(), lists, "{name}");
        }
    }
}

fn lists_without_room_change_nothing_until_they_have_it(device: &Device) {
    let (_, bed) = beds().swap_remove(6);
    let mut world = World::new(device, &bed, 0, 1000);
    world.check();
    let control = world.control();
    assert_eq!((control.flags, control.searches), (CROWDED, 0));
    assert!(control.entries > 1000);
    assert_eq!(control.good, control.base, "no step may be made");
    assert_eq!(world.bed(&bed).places, bed.places);
    world.check();
    assert_eq!(
        world.control().searches,
        0,
        "a flag holds until the host clears it"
    );
    world.grow(control.entries as usize, 0);
    world.check();
    let grown = world.control();
    assert_eq!(
        (grown.flags, grown.searches, grown.entries),
        (0, 1, control.entries)
    );
    let expected = World::new(device, &bed, 0, 400_000);
    expected.check();
    assert_eq!(world.bed(&bed).places, expected.bed(&bed).places);
    assert_eq!(world.neighbours(), expected.neighbours());
}
