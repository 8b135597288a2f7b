//! Contact arrays of `contacts.nc`.

use super::{Field, FieldReading, Storage, field, scalars, vectors};
use crate::{Body, Contact};
use glam::DVec3;
use ndarray::{Array2, ArrayD};

/// Contact arrays, ragged: dimension `contact`, in the order of `now.state.contacts`.
/// `member` is i, j.
pub static CONTACTS: &[Field] = &[
    field(
        "pair",
        &["contact", "member"],
        "1",
        "grains in contact, i < j; j is -1 - w where grain i touches wall w",
        Storage::Integer,
        |r| {
            let contacts = &r.now.state.contacts;
            let member = |(c, side): (usize, usize)| match (side, contacts[c].j) {
                (0, _) => f64::from(contacts[c].i),
                (_, Body::Grain(j)) => f64::from(j),
                (_, Body::Wall(w)) => -1.0 - f64::from(w),
            };
            Array2::from_shape_fn((contacts.len(), 2), member).into_dyn()
        },
    ),
    field(
        "force",
        &["contact", "component"],
        "N",
        "force on i",
        Storage::Single,
        |r| each_contact_vector(r, |c| c.force),
    ),
    field(
        "overlap",
        &["contact"],
        "m",
        "overlap",
        Storage::Single,
        |r| {
            let contacts = r.now.state.contacts.iter();
            scalars(contacts.map(|c| c.overlap).collect())
        },
    ),
    field(
        "branch",
        &["contact", "component"],
        "m",
        "from the centre of j, or its foot on the wall, to the centre of i",
        Storage::Single,
        |r| each_contact_vector(r, |c| c.branch),
    ),
    field(
        "sliding",
        &["contact"],
        "1",
        "does the contact slide? 1 if it does",
        Storage::Integer,
        |r| {
            let contacts = r.now.state.contacts.iter();
            let flag = contacts.map(|c| f64::from(u8::from(c.history.sliding)));
            scalars(flag.collect())
        },
    ),
];

fn each_contact_vector(r: &FieldReading, of: fn(&Contact) -> DVec3) -> ArrayD<f64> {
    let values: Vec<_> = r.now.state.contacts.iter().map(of).collect();
    vectors(&values)
}
