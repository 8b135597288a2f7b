//! `[box]`: the box, its sides, and gravity.

use super::reader::{Range, Table};
use super::units::{ACCELERATION, ANGLE, LENGTH};
use dem::Domain;
use glam::DVec3;

/// The box and gravity as a scene states them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Box along x and y.
    pub domain: Domain,
    /// Height of the top wall at the start [m]; none: just above the grains.
    pub height: Option<f64>,
    /// Acceleration of gravity [m/s²].
    pub gravity: DVec3,
}

/// Standard gravity [m/s²].
const EARTH: f64 = 9.81;

/// The box that the grains of a file were in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MadeIn {
    /// There is no file, or it does not say.
    Nothing,
    /// Lengths along x and y of a bed [m].
    Bed([f64; 2]),
    /// The whole box of a state.
    State(Domain),
}

impl MadeIn {
    /// The box of a bed of `size` [m], if its file says so.
    pub fn of_bed(size: Option<[f64; 3]>) -> Self {
        size.map_or(Self::Nothing, |[x, y, _]| Self::Bed([x, y]))
    }

    /// The box to take where the scene says nothing.
    fn domain(self) -> Option<Domain> {
        let periodic = [true; 2];
        match self {
            Self::Nothing => None,
            Self::Bed(size) => Some(Domain { size, periodic }),
            Self::State(domain) => Some(domain),
        }
    }
}

/// Read `[box]`; what it leaves out is that of the box that the grains were made in.
pub fn read(root: &Table, made_in: MadeIn) -> Option<Bounds> {
    let example = "[box] with size = [\"0.2 m\", \"0.2 m\"] (x along shear, y)";
    let made = made_in.domain();
    if made.is_none() && !root.has("box") {
        root.missing("box", example);
        return None;
    }
    let table = root.table_or_empty("box", example)?;
    let size = table.quantities("size", &LENGTH, Range::Positive);
    let stated = match size.as_deref() {
        Some([x, y]) => Some(([*x, *y], None)),
        Some([x, y, z]) => Some(([*x, *y], Some(*z))),
        Some(other) => {
            let n = other.len();
            table.wrong(
                "size",
                format!("has {n} lengths; write two (x, y) or three (x, y, z)"),
            );
            None
        }
        None if made_in == MadeIn::Nothing && !table.has("size") => {
            table.missing("size", "size = [\"0.2 m\", \"0.2 m\"]");
            None
        }
        None => None,
    };
    let periodic = sides(&table, made_in);
    let gravity = gravity(&table);
    if gravity.is_none() && !table.has("gravity") {
        table.choose("gravity", ACCELERATION.write(EARTH));
    }
    if let Some(made) = made.filter(|_| !table.has("size")) {
        let size = made.size.map(|length| LENGTH.write(length));
        table.choose("size", toml_edit::Array::from_iter(size));
    }
    let of_file = made.map(|domain| (domain.size, None));
    let (mut size, height) = stated.or(of_file)?;
    if let Some(made) = made {
        let (of_state, name) = match made_in {
            MadeIn::State(_) => (true, "state"),
            _ => (false, "bed"),
        };
        for k in 0..2 {
            // A bed may stand between walls farther apart.
            let binds = of_state || periodic[k];
            if binds && (size[k] / made.size[k] - 1.0).abs() > 1e-6 {
                // As it was stated: whole units of the GPU's positions change digits that nobody wrote.
                let (along, own) = (["x", "y"][k], made.size[k] as f32);
                let message = format!(
                    "is {} m along {along}, but the {name} was made in {own} m; leave size out",
                    size[k]
                );
                table.wrong("size", message);
            }
        }
        if of_state {
            // To the bit.
            size = made.size;
        }
        if of_state && height.is_some() {
            let what = "has a height, but the state knows where its top wall is";
            table.wrong("size", format!("{what}; leave size out"));
        }
    }
    Some(Bounds {
        domain: Domain { size, periodic },
        height,
        // As the resolved text says it, without a negative zero.
        gravity: gravity.unwrap_or(DVec3::new(0.0, 0.0, -EARTH)),
    })
}

fn sides(table: &Table, made_in: MadeIn) -> [bool; 2] {
    let words = [("periodic", true), ("walls", false)];
    let default = made_in.domain().map_or([true; 2], |made| made.periodic);
    let example = "sides = { x = \"periodic\", y = \"walls\" }";
    let Some(sides) = table.table_or_empty("sides", example) else {
        return default;
    };
    let side = |key, default: bool| {
        let stated = sides.choice_or(key, &words, default);
        if matches!(made_in, MadeIn::State(_)) && stated != default {
            let name = if default { "periodic" } else { "walls" };
            let what = format!("is not what the state was made with, {name:?}; leave it out");
            sides.wrong(key, what);
        }
        stated
    };
    [side("x", default[0]), side("y", default[1])]
}

/// Gravity of a table [m/s²]: a magnitude, downwards or tilted towards x, or a vector.
pub fn gravity(table: &Table) -> Option<DVec3> {
    let tilt = table.quantity("tilt", &ANGLE, Range::Any);
    if table.is_list("gravity") {
        if tilt.is_some() {
            table.wrong(
                "tilt",
                "contradicts a gravity given as a vector; remove one of them".into(),
            );
        }
        let g = table.quantities("gravity", &ACCELERATION, Range::Any)?;
        let [x, y, z] = g[..] else {
            let n = g.len();
            let what = "write one downwards, \"9.81 m/s^2\", or three (x, y, z)";
            table.wrong("gravity", format!("has {n} components; {what}"));
            return None;
        };
        return Some(DVec3::new(x, y, z));
    }
    if table.is_word("gravity", "none") {
        return Some(DVec3::ZERO);
    }
    let g = table.quantity("gravity", &ACCELERATION, Range::NotNegative);
    if g.is_none() && tilt.is_none() {
        return None;
    }
    if !table.has("gravity") {
        table.choose("gravity", ACCELERATION.write(EARTH));
    }
    let (sin, cos) = tilt.unwrap_or(0.0).sin_cos();
    Some(g.unwrap_or(EARTH) * DVec3::new(sin, 0.0, -cos))
}
