//! `[water.bed]` between grains: what resists the water.

use crate::scene::reader::{Range, Table};
use crate::scene::units::{LENGTH, PERMEABILITY};
use coupling::{Permeability, Resistance};

const BED: &str = "[water.bed] with permeability = \"1e-12 m^2\"";
/// Permeabilities of clay to those of boulders, and far beyond both [m²].
const POSSIBLE: Range = Range::Within(1e-24, 1.0);

/// How many times larger or smaller the grains of a law may be than those that are there.
const OTHER: f64 = 10.0;

/// The law of resistance; `diameter` is the mean one of the grains [m].
pub fn read(water: &Table, diameter: f64) -> Option<Resistance> {
    water.missing("bed", BED);
    let bed = water.table("bed", BED)?;
    let why = "belongs to water alone; here it follows from the grains, and from drag";
    bed.refuse(&["porosity", "forchheimer", "layer"], why);
    #[derive(Clone, Copy, PartialEq)]
    enum Drag {
        Darcy,
        Ergun,
        DiFelice,
    }
    let words = [
        ("darcy", Drag::Darcy),
        ("ergun", Drag::Ergun),
        ("di-felice", Drag::DiFelice),
    ];
    let drag = bed.choice_or("drag", &words, Drag::Darcy);
    let by_size = bed.is_word("permeability", "kozeny-carman");
    let size = if by_size || drag != Drag::Darcy {
        let size = bed.quantity_or("grain_size", &LENGTH, Range::Positive, diameter);
        // Fine sediment between the grains may rule the permeability, but nothing larger; and the
        // drag is that on the grains themselves.
        let least = if drag == Drag::Darcy {
            0.0
        } else {
            diameter / OTHER
        };
        if !(least..=OTHER * diameter).contains(&size) {
            let what = format!("is {size:.3e} m, and the grains are {diameter:.3e} m in the mean");
            bed.wrong("grain_size", format!("{what}; leave it out, to take that"));
            return None;
        }
        Some(size)
    } else {
        let why = "is of use only with permeability = \"kozeny-carman\", or with another drag";
        bed.refuse(&["grain_size"], why);
        None
    };
    if drag != Drag::Darcy {
        let why = "follows from the drag";
        bed.refuse(&["permeability", "within"], why);
        let diameter = size?;
        return Some(match drag {
            Drag::Ergun => Resistance::Ergun { diameter },
            _ => Resistance::DiFelice { diameter },
        });
    }
    let within = within(&bed);
    bed.missing(
        "permeability",
        "permeability = \"1e-12 m^2\", or \"kozeny-carman\", or { prefactor = \"1e-15 m^2\" }",
    );
    let law = if by_size {
        Permeability::kozeny_carman(size?)
    } else if bed.is_table("permeability") {
        let example = "permeability = { prefactor = \"1e-15 m^2\" }";
        let table = bed.table("permeability", example)?;
        table.missing("prefactor", "prefactor = \"1e-15 m^2\"");
        Permeability::prefactor(table.quantity("prefactor", &PERMEABILITY, POSSIBLE)?)
    } else {
        Permeability::constant(bed.quantity("permeability", &PERMEABILITY, POSSIBLE)?)
    };
    Some(Resistance::Darcy(match within? {
        Some(bounds) => law.within(bounds),
        None => law,
    }))
}

/// The least and the greatest permeability, if there are any; none in the outer: they are wrong.
fn within(bed: &Table) -> Option<Option<[f64; 2]>> {
    if !bed.has("within") {
        return Some(None);
    }
    let bounds = bed.quantities("within", &PERMEABILITY, POSSIBLE)?;
    match bounds[..] {
        [low, high] if low <= high => Some(Some([low, high])),
        _ => {
            let what = "is not the least and the greatest permeability";
            bed.wrong(
                "within",
                format!("{what}; write e.g. [\"1e-17 m^2\", \"1e-9 m^2\"]"),
            );
            None
        }
    }
}
