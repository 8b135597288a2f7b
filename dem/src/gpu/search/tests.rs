//! The structs of both sides agree. Needs no device.

use super::*;
use std::mem::offset_of;

fn members(file: &str, name: &str) -> (u32, Vec<(String, u32)>) {
    let module = compose(file, &Flags::new()).unwrap();
    shaders::layout::of(&module, name).unwrap()
}

macro_rules! same {
    ($file:literal, $name:literal, $rust:ty, $size:expr, [$($member:ident),*]) => {
        let (size, found) = members($file, $name);
        let expected = vec![$((stringify!($member).to_string(), offset_of!($rust, $member) as u32)),*];
        assert_eq!(found, expected, "{}", $name);
        assert_eq!(size as usize, $size, "{}", $name);
    };
}

#[test]
fn structs_of_the_search_lie_alike_on_both_sides() {
    same!(
        "dem/search/check.wgsl",
        "Control",
        Control,
        size_of::<Control>(),
        [
            end,
            group,
            limit,
            wanted_skin,
            base,
            good,
            flags,
            allowed,
            skin,
            searches,
            searched_at,
            entries,
            touching,
            lost,
            farthest,
            fastest
        ]
    );
    same!(
        "dem/search/check.wgsl",
        "Plan",
        Plan,
        size_of::<Plan>(),
        [
            count,
            cell_room,
            entry_room,
            touching_room,
            lengths,
            diameter,
            largest,
            unit,
            step,
            skins,
            every
        ]
    );
    same!(
        "dem/search/check.wgsl",
        "Grid",
        Grid,
        size_of::<Grid>(),
        [origin, near, width, total, cells]
    );
    same!(
        "dem/search/carry.wgsl",
        "Shape",
        Shape,
        size_of::<Shape>(),
        [width, halves]
    );
}
