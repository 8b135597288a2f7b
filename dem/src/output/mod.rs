//! The output variables of the grains: names, units, and how each is read.

mod contacts;
mod grains;
mod profiles;
mod series;

pub use contacts::CONTACTS;
pub use grains::GRAINS;
pub use profiles::PROFILES;
pub use series::SERIES;

use crate::{Model, Snapshot, Sums};
use glam::DVec3;
use ndarray::{Array1, Array2, ArrayD};

/// An output variable as a NetCDF file describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// Name in the file.
    pub name: &'static str,
    /// Dimensions, the first varying slowest, without `time`.
    pub dims: &'static [&'static str],
    /// Units in UDUNITS spelling; `1` if dimensionless.
    pub units: &'static str,
    /// One line for axis labels.
    pub long_name: &'static str,
    /// How it is kept.
    pub storage: Storage,
}

/// How a file keeps the values of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// Double precision.
    Double,
    /// Single precision: seven digits are enough for any use.
    Single,
    /// Whole numbers of 64 bits, signed.
    Integer,
}

/// What a series value is read from.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// The description of the run.
    pub model: &'a Model,
    /// Now.
    pub now: &'a Snapshot,
    /// The sums at the last reading by the same solver, or none ([`Sums::default`]):
    /// interval means run from there.
    pub before: &'a Sums,
}

/// A scalar of time, for `series.nc`.
#[derive(Debug)]
pub struct Scalar {
    /// How the file describes it.
    pub variable: Variable,
    /// Its value; NaN where it has no meaning (a stress on a wall that is not there).
    pub read: fn(&Reading) -> f64,
}

/// An array of time, for `profiles.nc`, `grains.nc` and `contacts.nc`.
#[derive(Debug)]
pub struct Field {
    /// How the file describes it.
    pub variable: Variable,
    /// Its values, shaped as `variable.dims`.
    pub read: fn(&FieldReading) -> ArrayD<f64>,
}

/// What a field is read from.
#[derive(Clone, Copy, Debug)]
pub struct FieldReading<'a> {
    /// The description of the run.
    pub model: &'a Model,
    /// Now.
    pub now: &'a Snapshot,
    /// Edges of the profile's layers along z [m], ascending.
    pub edges: &'a [f64],
}

impl Snapshot {
    /// Value of `scalar` at this instant; interval means run from `before`.
    pub fn read(&self, scalar: &Scalar, model: &Model, before: &Sums) -> f64 {
        let now = self;
        (scalar.read)(&Reading { model, now, before })
    }
}

const fn field(
    name: &'static str,
    dims: &'static [&'static str],
    units: &'static str,
    long_name: &'static str,
    storage: Storage,
    read: fn(&FieldReading) -> ArrayD<f64>,
) -> Field {
    let variable = Variable {
        name,
        dims,
        units,
        long_name,
        storage,
    };
    Field { variable, read }
}

/// One number a row.
fn scalars(values: Vec<f64>) -> ArrayD<f64> {
    Array1::from_vec(values).into_dyn()
}

/// Three numbers a row.
fn vectors(values: &[DVec3]) -> ArrayD<f64> {
    Array2::from_shape_fn((values.len(), 3), |(k, c)| values[k][c]).into_dyn()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ledger;
    use crate::measure::tests::{column, model};
    use approx::assert_relative_eq;
    use std::collections::HashSet;

    /// The pressed column over 12 m², after 10 steps.
    pub(super) fn snapshot() -> Snapshot {
        Snapshot {
            state: column(),
            force: vec![DVec3::ZERO; 2],
            torque: vec![DVec3::ZERO; 2],
            wall_force: vec![8.0, 8.0],
            held_force: 6.0,
            driven_force: -6.0,
            sums: Sums {
                steps: 10,
                wall_force: vec![80.0, 84.0],
                held_force: 60.0,
                driven_force: -54.0,
            },
            ledger: Ledger {
                residual: 1e-9,
                ..Ledger::default()
            },
        }
    }

    #[test]
    fn fields_have_the_shape_that_their_dimensions_say() {
        let (now, edges) = (snapshot(), [0.0, 1.0, 2.0, 3.0, 4.0]);
        let reading = FieldReading {
            model: &model([3.0, 4.0]),
            now: &now,
            edges: &edges,
        };
        for field in [PROFILES, GRAINS, CONTACTS].into_iter().flatten() {
            let length = |dim: &&str| match *dim {
                "z" => 4,
                "grain" | "member" => 2,
                "contact" | "component" | "face" => 3,
                "quaternion" => 4,
                other => panic!("no dimension {other}"),
            };
            let shape: Vec<_> = field.variable.dims.iter().map(length).collect();
            assert_eq!((field.read)(&reading).shape(), shape);
        }
    }

    #[test]
    fn stress_is_row_component_column_face() {
        let mut now = snapshot();
        now.state.contacts[0].force = DVec3::new(5.0, 0.0, -8.0);
        let model = model([3.0, 4.0]);
        let edges = [1.5, 2.5];
        let (model, now, edges) = (&model, &now, &edges[..]);
        let reading = FieldReading { model, now, edges };
        let named = |f: &&Field| f.variable.name == "stress";
        let stress = (PROFILES.iter().find(named).unwrap().read)(&reading);
        assert_relative_eq!(stress[[0, 2, 2]], 8.0 / 12.0, max_relative = 1e-14);
        assert_relative_eq!(stress[[0, 0, 2]], -5.0 / 12.0, max_relative = 1e-14);
        assert_eq!(stress[[0, 2, 0]], 0.0);
    }

    #[test]
    fn names_are_unique_within_a_file() {
        let series = SERIES.iter().map(|s| s.variable.name).collect();
        let fields = [PROFILES, GRAINS, CONTACTS];
        let fields = fields.map(|f| f.iter().map(|f| f.variable.name).collect());
        for names in fields.into_iter().chain([series]) {
            let names: Vec<&str> = names;
            assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len());
        }
    }
}
