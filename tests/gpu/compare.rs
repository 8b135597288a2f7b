//! Two snapshots of one instant, quantity by quantity.

use dem::{Body, Contact, Ledger, Model, Snapshot, Sums};
use std::collections::BTreeMap;
use tests::packing::separation;

/// By name of a quantity, in the unit of the quantity.
pub type Amounts = BTreeMap<&'static str, f64>;

/// The largest difference of each quantity between two snapshots.
pub fn apart(a: &Snapshot, b: &Snapshot, model: &Model) -> Amounts {
    let mut found = Amounts::new();
    let mut see = |name, off: f64| {
        let most: &mut f64 = found.entry(name).or_default();
        // A maximum would hide what is no number.
        if !most.is_nan() && (off.is_nan() || off > *most) {
            *most = off;
        }
    };
    let (g, h) = (&a.state.grains, &b.state.grains);
    for k in 0..g.len() {
        let place = separation(g.position[k], h.position[k], &model.domain);
        see("place", place.length());
        see("way", g.displacement[k].distance(h.displacement[k]));
        see("velocity", g.velocity[k].distance(h.velocity[k]));
        let spin = g.angular_velocity[k].distance(h.angular_velocity[k]);
        see("spin", spin);
        let turned = g.orientation[k] * h.orientation[k].inverse();
        see("orientation", turned.to_scaled_axis().length());
        see("force", a.force[k].distance(b.force[k]));
        see("torque", a.torque[k].distance(b.torque[k]));
    }
    for pair in paired(a, b).into_values() {
        let (c, d) = match pair {
            [Some(c), Some(d)] => (c, d),
            // Who touch in one run only must barely do so.
            [one, other] => {
                see("overlap", one.or(other).map_or(0.0, |c| c.overlap));
                continue;
            }
        };
        see("contact force", c.force.distance(d.force));
        see("overlap", (c.overlap - d.overlap).abs());
        see("branch", c.branch.distance(d.branch));
        let (c, d) = (&c.history, &d.history);
        see("spring", c.spring.distance(d.spring));
        let rolling = c.rolling_spring.distance(d.rolling_spring);
        see("rolling spring", rolling);
        let twisting = (c.twisting_spring - d.twisting_spring).abs();
        see("twisting spring", twisting);
        see("flags", f64::from(u8::from(c.sliding != d.sliding)));
    }
    for (v, w) in a.state.walls.iter().zip(&b.state.walls) {
        see("wall place", (v.offset - w.offset).abs());
        see("wall velocity", (v.velocity - w.velocity).abs());
    }
    let forces = |s: &Snapshot| [&s.wall_force[..], &[s.held_force, s.driven_force]].concat();
    for (f, h) in forces(a).iter().zip(forces(b)) {
        see("force on a wall or layer", (f - h).abs());
    }
    let (s, t) = (&a.sums, &b.sums);
    assert_eq!(s.steps, t.steps);
    let forces = |s: &Sums| [&s.wall_force[..], &[s.held_force, s.driven_force]].concat();
    for (f, h) in forces(s).iter().zip(forces(t)) {
        see("mean force", (f - h).abs() / s.steps.max(1) as f64);
    }
    for (name, energy) in ENERGIES {
        see(name, (energy(&a.ledger) - energy(&b.ledger)).abs());
    }
    found
}

/// An entry of a ledger, by name.
type Entry = (&'static str, fn(&Ledger) -> f64);

/// The entries of a ledger.
pub const ENERGIES: [Entry; 13] = [
    ("kinetic energy", |l| l.kinetic),
    ("rotational energy", |l| l.rotational),
    ("normal springs", |l| l.elastic_normal),
    ("tangential springs", |l| l.elastic_tangential),
    ("rolling springs", |l| l.elastic_rolling),
    ("friction", |l| l.dissipated_friction),
    ("viscosity", |l| l.dissipated_viscosity),
    ("rolling", |l| l.dissipated_rolling),
    ("work of walls", |l| l.work_walls),
    ("work of the drive", |l| l.work_drive),
    ("work of gravity", |l| l.work_gravity),
    ("work from outside", |l| l.work_outside),
    ("residual", |l| l.residual),
];

/// A contact in either snapshot.
type Pair<'a> = [Option<&'a Contact>; 2];

/// Contacts of two snapshots, each beside its like.
fn paired<'a>(a: &'a Snapshot, b: &'a Snapshot) -> BTreeMap<(u32, Body), Pair<'a>> {
    let mut pairs: BTreeMap<_, Pair> = BTreeMap::new();
    for (k, snapshot) in [a, b].into_iter().enumerate() {
        for contact in &snapshot.state.contacts {
            pairs.entry((contact.i, contact.j)).or_default()[k] = Some(contact);
        }
    }
    pairs
}

/// `found` is within `allowed`; the worst of all is printed.
pub fn assert_within(what: &str, found: &Amounts, allowed: &Amounts) {
    let (mut worst, mut share) = ("", 0.0);
    let mut wrong = vec![];
    for (name, &off) in found {
        let most = allowed.get(name).copied().unwrap_or(0.0);
        if off.is_nan() || off > most {
            wrong.push(format!("{name} is off by {off:.2e} of {most:.2e}"));
        }
        if most > 0.0 && off / most > share {
            (worst, share) = (name, off / most);
        }
    }
    println!("{what}: worst is {worst} with {share:.3} of what is allowed");
    assert!(wrong.is_empty(), "{what}: {}", wrong.join("; "));
}
