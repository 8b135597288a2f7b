//! What can be told of a bed at one instant: solid fraction, coordination, pressure.
//!
//! Pure functions of the description and the state; none of them changes anything.

pub mod profile;

use crate::{Body, Grains, Model, Snapshot, State};
use std::f64::consts::PI;

/// Volume of the part of a sphere with centre at height `z` and this `radius` [m] that
/// lies between the heights `low` and `high` [m], in m³.
///
/// Exact: the difference of two spherical caps, V(t) = π t² (R - t/3).
pub fn sphere_volume_between(z: f64, radius: f64, low: f64, high: f64) -> f64 {
    let cap_below = |height: f64| {
        let t = (height - (z - radius)).clamp(0.0, 2.0 * radius);
        PI * t * t * (radius - t / 3.0)
    };
    (cap_below(high) - cap_below(low)).max(0.0)
}

/// Index of the wall that bounds the grains from above, if there is one.
pub fn top_wall(model: &Model) -> Option<usize> {
    model.walls.iter().position(|wall| wall.normal.z < -0.5)
}

/// Index of the wall that bounds the grains from below, if there is one.
pub fn bottom_wall(model: &Model) -> Option<usize> {
    model.walls.iter().position(|wall| wall.normal.z > 0.5)
}

/// Height of wall `index` above the origin [m].
///
/// The plane { x : n · x = offset } crosses the z axis at offset / n_z.
pub fn wall_height(model: &Model, state: &State, index: usize) -> f64 {
    state.walls[index].offset / model.walls[index].normal.z
}

/// Heights of the bottom and the top of the bed [m]: the walls, or the outermost points of
/// the grains where there is no wall or the wall is farther away.
///
/// NaN without grains.
pub fn bed_span(model: &Model, state: &State) -> [f64; 2] {
    let each = || state.grains.position.iter().zip(&state.grains.radius);
    let mut low = each().map(|(x, r)| x.z - r).fold(f64::NAN, f64::min);
    let mut high = each().map(|(x, r)| x.z + r).fold(f64::NAN, f64::max);
    if let Some(wall) = bottom_wall(model) {
        low = low.max(wall_height(model, state, wall));
    }
    if let Some(wall) = top_wall(model) {
        high = high.min(wall_height(model, state, wall));
    }
    [low, high]
}

/// Height of the bed [m], between the two of [`bed_span`].
pub fn bed_height(model: &Model, state: &State) -> f64 {
    let [low, high] = bed_span(model, state);
    high - low
}

/// Solid fraction between the heights `low` and `high` [m] over `area` [m²], from the
/// exact volumes of spheres between two planes.
///
/// Overlaps of grains count twice; they are a part in 10⁵ of stiff grains.
pub fn solid_fraction_between(grains: &Grains, area: f64, low: f64, high: f64) -> f64 {
    let each = grains.position.iter().zip(&grains.radius);
    let solid: f64 = each
        .map(|(x, &r)| sphere_volume_between(x.z, r, low, high))
        .sum();
    solid / (area * (high - low))
}

/// Solid fraction of the inside of the bed: three mean diameters away from its bottom and
/// its top, where planes order the grains, and a quarter of its height in beds less than
/// twelve diameters high.
pub fn solid_fraction(model: &Model, state: &State) -> f64 {
    let [low, high] = bed_span(model, state);
    let margin = (6.0 * state.grains.mean_radius()).min(0.25 * (high - low));
    let area = model.domain.area();
    solid_fraction_between(&state.grains, area, low + margin, high - margin)
}

/// Number of grains that each grain touches; walls are not counted.
pub fn neighbours(state: &State) -> Vec<u32> {
    let mut count = vec![0; state.grains.len()];
    for contact in &state.contacts {
        if let Body::Grain(j) = contact.j {
            count[contact.i as usize] += 1;
            count[j as usize] += 1;
        }
    }
    count
}

/// Mean number of grains that a grain touches, 2 N_c / N; walls are not counted, grains
/// without contact are.
pub fn coordination_number(state: &State) -> f64 {
    let pairs = state.contacts.iter();
    let pairs = pairs.filter(|c| matches!(c.j, Body::Grain(_))).count();
    2.0 * pairs as f64 / state.grains.len() as f64
}

/// Pressure on each grain [Pa]: sum of the normal forces on it, walls included, over its
/// surface 4 π R². Contacts that pull count as negative.
pub fn pressure(state: &State) -> Vec<f64> {
    let mut push = vec![0.0; state.grains.len()];
    for contact in &state.contacts {
        let normal_force = contact.force.dot(contact.branch.normalize_or_zero());
        push[contact.i as usize] += normal_force;
        if let Body::Grain(j) = contact.j {
            push[j as usize] += normal_force;
        }
    }
    let radius = &state.grains.radius;
    push.iter()
        .zip(radius)
        .map(|(f, r)| f / (4.0 * PI * r * r))
        .collect()
}

/// Mean density of the grains [kg/m³].
pub fn grain_density(grains: &Grains) -> f64 {
    let volume: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    grains.mass.iter().sum::<f64>() / volume
}

/// Shear strain rate of the bed [1/s]: mean x velocity of the driven layer less that of
/// the held layer, over the height of the bed. Zero without a driven layer.
pub fn strain_rate(model: &Model, now: &Snapshot) -> f64 {
    use crate::Horizontal::{Driven, Held};
    let grains = &now.state.grains;
    let mean_velocity = |which| {
        let each = grains.constraint.iter().zip(&grains.velocity);
        let layer = each.filter(|(c, _)| c.horizontal == which);
        let (n, sum) = layer.fold((0, 0.0), |(n, sum), (_, v)| (n + 1, sum + v.x));
        if n == 0 { 0.0 } else { sum / f64::from(n) }
    };
    if !grains.constraint.iter().any(|c| c.horizontal == Driven) {
        return 0.0;
    }
    (mean_velocity(Driven) - mean_velocity(Held)) / bed_height(model, &now.state)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::contact::{Linear, Tension};
    use crate::{Contact, ContactLaw, Domain, History, Surface, Wall, WallMotion, WallState};
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use glam::DVec3;

    /// A periodic box of this horizontal size between a bottom wall at 0 and a top wall.
    pub(crate) fn model(size: [f64; 2]) -> Model {
        let wall = |name: &str, normal| Wall {
            name: name.into(),
            normal,
            surface: Surface::Frictionless,
            motion: WallMotion::Held,
        };
        Model {
            domain: Domain {
                size,
                periodic: [true, true],
            },
            gravity: DVec3::ZERO,
            law: ContactLaw::Linear(Linear {
                normal_stiffness: 1e6,
                normal_damping: 0.0,
                tension: Tension::Clip,
                sliding: None,
                rolling: None,
                twisting: None,
            }),
            walls: vec![wall("bottom", DVec3::Z), wall("top", DVec3::NEG_Z)],
            drive: None,
            step: 1e-5,
            skin: None,
            ledger: true,
        }
    }

    /// Walls at rest at the heights 0 and `top`.
    pub(crate) fn walls(top: f64) -> Vec<WallState> {
        let at = |offset| WallState {
            offset,
            velocity: 0.0,
        };
        vec![at(0.0), at(-top)]
    }

    pub(crate) fn contact(i: u32, j: Body, force: DVec3, branch: DVec3) -> Contact {
        Contact {
            i,
            j,
            history: History::default(),
            force,
            overlap: 0.0,
            branch,
        }
    }

    /// Two unit grains on top of each other, pressed between walls by 8 N.
    pub(crate) fn column() -> State {
        let mut state = State {
            walls: walls(4.0),
            ..State::default()
        };
        state.grains.add_sphere(DVec3::new(1.5, 1.5, 1.0), 1.0, 1.0);
        state.grains.add_sphere(DVec3::new(1.5, 1.5, 3.0), 1.0, 1.0);
        let push = DVec3::new(0.0, 0.0, 8.0);
        state.contacts = vec![
            contact(0, Body::Grain(1), -push, -2.0 * DVec3::Z),
            contact(0, Body::Wall(0), push, DVec3::Z),
            contact(1, Body::Wall(1), -push, -DVec3::Z),
        ];
        state
    }

    /// A simple cubic lattice of touching unit grains, solid fraction π/6 in any slab of
    /// whole layers.
    pub(crate) fn lattice(n: [usize; 3]) -> State {
        let mut state = State {
            walls: walls(2.0 * n[2] as f64),
            ..State::default()
        };
        for k in 0..n[0] * n[1] * n[2] {
            let place = [k % n[0], k / n[0] % n[1], k / (n[0] * n[1])];
            let at = DVec3::from_array(place.map(|p| 2.0 * p as f64 + 1.0));
            state.grains.add_sphere(at, 1.0, 1.0);
        }
        state
    }

    #[test]
    fn slabs_of_a_sphere_have_the_volume_of_caps_and_sum_to_the_sphere() {
        let (z, radius) = (0.3, 1.7);
        let whole = 4.0 / 3.0 * PI * radius * radius * radius;
        let between = |low, high| sphere_volume_between(z, radius, low, high);
        assert_relative_eq!(between(-9.0, 9.0), whole, max_relative = 1e-14);
        assert_relative_eq!(between(z, 9.0), 0.5 * whole, max_relative = 1e-14);
        // A cap of height h: π h² (3 R - h) / 3.
        let h: f64 = 0.4;
        let cap = PI * h * h * (3.0 * radius - h) / 3.0;
        assert_relative_eq!(between(z + radius - h, 9.0), cap, max_relative = 1e-13);
        assert_eq!(between(2.5, 3.0), 0.0);

        let edges = [-2.0, -1.1, -0.2, 0.31, 0.32, 1.9, 2.5];
        let sum: f64 = edges.windows(2).map(|e| between(e[0], e[1])).sum();
        assert_relative_eq!(sum, whole, max_relative = 1e-14);
    }

    #[test]
    fn a_cubic_lattice_has_a_solid_fraction_of_pi_over_six() {
        let deep = lattice([2, 3, 14]);
        let model = model([4.0, 6.0]);
        // Inside: heights 6 to 22, eight whole layers.
        assert_relative_eq!(
            solid_fraction(&model, &deep),
            PI / 6.0,
            max_relative = 1e-14
        );
        // A slab of one period has the same fraction wherever it begins.
        let shifted = solid_fraction_between(&deep.grains, 24.0, 6.7, 8.7);
        assert_relative_eq!(shifted, PI / 6.0, max_relative = 1e-14);
        // Of eight layers the middle half counts: what is missing beside it does not matter.
        let mut shallow = lattice([2, 3, 8]);
        assert_eq!(bed_span(&model, &shallow), [0.0, 16.0]);
        let grains = &mut shallow.grains;
        (0..5).chain(43..48).for_each(|k| grains.radius[k] = 0.5);
        assert_relative_eq!(
            solid_fraction(&model, &shallow),
            PI / 6.0,
            max_relative = 1e-14
        );
    }

    #[test]
    fn the_bed_ends_at_its_grains_where_a_wall_is_farther_away() {
        let mut state = lattice([1, 1, 3]);
        state.walls = walls(50.0);
        assert_eq!(bed_span(&model([2.0, 2.0]), &state), [0.0, 6.0]);
        // Overlap with the wall: the wall is the top.
        state.walls = walls(5.9);
        assert_eq!(bed_span(&model([2.0, 2.0]), &state), [0.0, 5.9]);
    }

    #[test]
    fn a_pressed_column_has_its_pressure_and_one_neighbour_each() {
        let state = column();
        assert_eq!(neighbours(&state), [1, 1]);
        assert_eq!(coordination_number(&state), 1.0);
        // Two forces of 8 N on a surface of 4 π.
        for p in pressure(&state) {
            assert_relative_eq!(p, 16.0 / (4.0 * PI), max_relative = 1e-14);
        }
    }

    #[test]
    fn the_strain_rate_is_the_velocity_difference_of_the_layers_over_the_height() {
        use crate::{Horizontal, Ledger, Sums};
        let mut state = column();
        state.grains.constraint[0].horizontal = Horizontal::Held;
        let mut now = Snapshot {
            force: vec![DVec3::ZERO; 2],
            torque: vec![DVec3::ZERO; 2],
            wall_force: vec![8.0, 8.0],
            held_force: 0.0,
            driven_force: 0.0,
            sums: Sums::default(),
            ledger: Ledger::default(),
            state,
        };
        let model = model([3.0, 3.0]);
        now.state.grains.velocity[1].x = 2.0;
        assert_eq!(strain_rate(&model, &now), 0.0);
        now.state.grains.constraint[1].horizontal = Horizontal::Driven;
        assert_abs_diff_eq!(strain_rate(&model, &now), 0.5, epsilon = 1e-15);
    }
}
