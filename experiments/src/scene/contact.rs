//! `[contact]`: how grains push each other.

use super::reader::{Range, Table};
use super::units::{DAMPING, STIFFNESS};
use dem::ContactLaw;
use dem::contact::{Linear, LinearLammps, Sliding, Tension, Turning};
use dem::stability::damping_for;

/// Static and dynamic friction coefficients [-].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Limit of a contact that sticks, μ_s.
    pub at_rest: f64,
    /// Limit of a contact that slides, μ_d.
    pub sliding: f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Name {
    Linear,
    LinearLammps,
}

const NORMAL: &str = "normal = { stiffness = \"1e6 N/m\", restitution = 0.5 }";
const TANGENTIAL: &str = "tangential = { stiffness = \"3e5 N/m\", friction = 0.5 }";
const TURNING: &str = "{ stiffness = \"1e5 N/m\", damping = \"10 N s/m\", friction = 0.1 }";

/// Read `[contact]`; a restitution is that of two grains of `mean_mass` [kg].
pub fn read(root: &Table, mean_mass: f64) -> Option<ContactLaw> {
    root.missing(
        "contact",
        &format!("[contact] with {NORMAL} and {TANGENTIAL}"),
    );
    let table = root.table("contact", "[contact]")?;
    let names = [
        ("linear", Name::Linear),
        ("linear-lammps", Name::LinearLammps),
    ];
    let name = table.choice_or("law", &names, Name::Linear);
    match name {
        Name::Linear => linear(&table, mean_mass).map(ContactLaw::Linear),
        Name::LinearLammps => linear_lammps(&table, mean_mass).map(ContactLaw::LinearLammps),
    }
}

fn linear(table: &Table, mean_mass: f64) -> Option<Linear> {
    let words = [("clip", Tension::Clip), ("keep", Tension::Keep)];
    let tension = table.choice_or("tension", &words, Tension::default());
    let normal = normal(table, mean_mass, tension == Tension::Clip);
    let stiffness = normal.map(|(stiffness, _)| stiffness);
    let sliding = tangential(table, stiffness);
    let rolling = turning(table, "rolling");
    let twisting = turning(table, "twisting");
    for (key, law) in [("rolling", rolling), ("twisting", twisting)] {
        if law.is_some() && table.is_word("tangential", "none") {
            table.wrong(
                key,
                format!("needs a tangential spring too; write {TANGENTIAL}"),
            );
        }
    }
    let (normal_stiffness, normal_damping) = normal?;
    Some(Linear {
        normal_stiffness,
        normal_damping,
        tension,
        sliding,
        rolling,
        twisting,
    })
}

fn linear_lammps(table: &Table, mean_mass: f64) -> Option<LinearLammps> {
    let why = "is not part of the law linear-lammps";
    table.refuse(&["tension", "rolling", "twisting"], why);
    let normal = normal(table, mean_mass, false);
    if table.is_word("tangential", "none") {
        let what = "is \"none\", but linear-lammps has a tangential spring";
        table.wrong(
            "tangential",
            format!("{what}; write {TANGENTIAL}, or law = \"linear\""),
        );
        return None;
    }
    let sliding = tangential(table, normal.map(|(stiffness, _)| stiffness));
    let (normal_stiffness, normal_damping) = normal?;
    let sliding = sliding?;
    if sliding.friction_static != sliding.friction_dynamic {
        let what = "has two frictions, but linear-lammps knows one; write friction = 0.5";
        table.wrong("tangential", what.into());
    }
    Some(LinearLammps {
        normal_stiffness,
        normal_damping,
        tangential_stiffness: sliding.stiffness,
        tangential_damping: sliding.damping,
        friction: sliding.friction_static,
    })
}

/// Stiffness [N/m] and damping [N s/m] along the normal.
fn normal(table: &Table, mean_mass: f64, clipped: bool) -> Option<(f64, f64)> {
    table.missing("normal", NORMAL);
    let normal = table.table("normal", NORMAL)?;
    normal.missing("stiffness", "stiffness = \"1e6 N/m\"");
    let stiffness = normal.quantity("stiffness", &STIFFNESS, Range::Positive);
    let damping = normal.quantity("damping", &DAMPING, Range::NotNegative);
    let restitution = normal.number("restitution", Range::Above(0.0, 1.0), "0.5");
    match normal.present(&["damping", "restitution"])[..] {
        [] => normal.wrong_here("needs damping = \"100 N s/m\" or restitution = 0.5".into()),
        [_, _] => normal.wrong_here("has damping and restitution; remove one of them".into()),
        _ => {}
    }
    let stiffness = stiffness?;
    let of_restitution = |e| {
        let damping = damping_for(e, stiffness, 0.5 * mean_mass, clipped);
        normal.leave_out("restitution");
        normal.choose("damping", DAMPING.write(damping));
        damping
    };
    Some((stiffness, damping.or(restitution.map(of_restitution))?))
}

fn tangential(table: &Table, normal_stiffness: Option<f64>) -> Option<Sliding> {
    if table.is_word("tangential", "none") {
        return None;
    }
    table.missing(
        "tangential",
        &format!("{TANGENTIAL}, or tangential = \"none\""),
    );
    let tangential = table.table("tangential", &format!("{TANGENTIAL}, or \"none\""))?;
    // 2/7: both springs of a free pair of solid spheres then swing alike.
    let stiffness = match normal_stiffness {
        Some(k) => {
            Some(tangential.quantity_or("stiffness", &STIFFNESS, Range::Positive, 2.0 / 7.0 * k))
        }
        None => tangential.quantity("stiffness", &STIFFNESS, Range::Positive),
    };
    let damping = tangential.quantity_or("damping", &DAMPING, Range::NotNegative, 0.0);
    tangential.missing("friction", "friction = 0.5");
    let friction = friction(&tangential)?;
    Some(Sliding {
        stiffness: stiffness?,
        damping,
        friction_static: friction.at_rest,
        friction_dynamic: friction.sliding,
    })
}

/// `friction = 0.5` or `friction = { static = 0.58, dynamic = 0.47 }`.
pub fn friction(table: &Table) -> Option<Friction> {
    let example = "{ static = 0.6, dynamic = 0.5 }";
    if !table.is_table("friction") {
        let mu = table.number("friction", Range::NotNegative, "0.5")?;
        if mu == 0.0 {
            let what = "is 0; a contact without friction is tangential = \"none\" in [contact]";
            table.wrong(
                "friction",
                format!("{what}, or friction = \"none\" in a phase"),
            );
            return None;
        }
        return Some(Friction {
            at_rest: mu,
            sliding: mu,
        });
    }
    let both = table.table("friction", example)?;
    both.missing("static", "static = 0.6");
    both.missing("dynamic", "dynamic = 0.5");
    let at_rest = both.number("static", Range::Positive, "0.6");
    let sliding = both.number("dynamic", Range::Positive, "0.5");
    let (at_rest, sliding) = (at_rest?, sliding?);
    if sliding > at_rest {
        let what = format!("is {sliding}, above the static friction {at_rest}");
        both.wrong("dynamic", format!("{what}; write e.g. {example}"));
        return None;
    }
    Some(Friction { at_rest, sliding })
}

fn turning(table: &Table, key: &'static str) -> Option<Turning> {
    if !table.has(key) {
        table.choose(key, "none");
        return None;
    }
    if table.is_word(key, "none") {
        return None;
    }
    let example = format!("{key} = {TURNING}, or {key} = \"none\"");
    let turning = table.table(key, &example)?;
    turning.missing("stiffness", "stiffness = \"1e5 N/m\"");
    turning.missing("friction", "friction = 0.1");
    let stiffness = turning.quantity("stiffness", &STIFFNESS, Range::Positive);
    let damping = turning.quantity_or("damping", &DAMPING, Range::NotNegative, 0.0);
    let friction = turning.number("friction", Range::Positive, "0.1");
    Some(Turning {
        stiffness: stiffness?,
        damping,
        friction: friction?,
    })
}

/// `law` with another friction; `None` takes all of it away, rolling and twisting too.
///
/// # Errors
/// What contradicts the law.
pub fn with_friction(law: ContactLaw, friction: Option<Friction>) -> Result<ContactLaw, String> {
    match (law, friction) {
        (ContactLaw::Linear(law), None) => Ok(ContactLaw::Linear(Linear {
            sliding: None,
            rolling: None,
            twisting: None,
            ..law
        })),
        (ContactLaw::Linear(law), Some(friction)) => {
            let Some(sliding) = law.sliding else {
                let what = "needs a tangential spring; write in [contact]";
                return Err(format!("{what} {TANGENTIAL}"));
            };
            Ok(ContactLaw::Linear(Linear {
                sliding: Some(Sliding {
                    friction_static: friction.at_rest,
                    friction_dynamic: friction.sliding,
                    ..sliding
                }),
                ..law
            }))
        }
        (ContactLaw::LinearLammps(law), Some(f)) if f.at_rest == f.sliding => {
            let friction = f.at_rest;
            Ok(ContactLaw::LinearLammps(LinearLammps { friction, ..law }))
        }
        (ContactLaw::LinearLammps(_), _) => {
            Err("linear-lammps has one friction above zero; write e.g. friction = 0.3".into())
        }
    }
}
