//! Quantities as text: `"100 kPa"` becomes 1e5, and its dimension is checked.
//!
//! The crate `runits` reads the units; this file only says which dimension is expected
//! and how to name the one that was found.

use runits::{Dimension, Quantity};

/// A physical quantity that a scene may ask for.
#[derive(Debug, PartialEq)]
pub struct Kind {
    /// What it is, with its article: `a density`.
    pub what: &'static str,
    /// Its SI unit; the value that is read is in this unit.
    pub unit: &'static str,
    /// How one is written.
    pub example: &'static str,
}

macro_rules! kinds {
    ($($name:ident: $what:literal, $unit:literal, $example:literal;)*) => {
        $(
            #[doc = concat!($what, ", in ", $unit)]
            pub const $name: Kind = Kind { what: $what, unit: $unit, example: $example };
        )*
        /// All quantities that scenes ask for.
        const KINDS: &[&Kind] = &[$(&$name),*];
    };
}

kinds! {
    LENGTH: "a length", "m", "20 mm";
    TIME: "a time", "s", "5 ms";
    VELOCITY: "a velocity", "m/s", "10 mm/s";
    ACCELERATION: "an acceleration", "m/s^2", "9.81 m/s^2";
    RATE: "a rate", "1/s", "0.25 1/s";
    FREQUENCY: "a frequency", "Hz", "2 Hz";
    MASS: "a mass", "kg", "150 kg";
    DENSITY: "a density", "kg/m^3", "2600 kg/m^3";
    STRESS: "a stress", "Pa", "100 kPa";
    MODULUS: "a modulus", "Pa", "100 MPa";
    STIFFNESS: "a stiffness", "N/m", "1e6 N/m";
    DAMPING: "a damping", "N s/m", "100 N s/m";
    ANGLE: "an angle", "rad", "20 degrees";
    VISCOSITY: "a viscosity", "Pa s", "1.8 mPa s";
    COMPRESSIBILITY: "a compressibility", "1/Pa", "5e-10 1/Pa";
    PERMEABILITY: "a permeability", "m^2", "1e-13 m^2";
    PER_LENGTH: "an inverse length", "1/m", "1e5 1/m";
}

/// Dimensions that no key of a scene has, but that a slip of the pen may give.
const OTHERS: &[(&str, &str)] = &[
    ("m^3", "a volume"),
    ("kg/m^2", "a mass per area"),
    ("kg/m", "a mass per length"),
    ("N", "a force"),
    ("N/m^3", "a force per volume"),
    ("J", "an energy or a torque"),
    ("W", "a power"),
    ("K", "a temperature"),
    ("m^2/s", "a diffusivity"),
    ("kg m/s", "a momentum"),
];

impl Kind {
    /// Read `text` as this quantity, in SI units.
    ///
    /// # Errors
    /// What is wrong with the text, without the remedy.
    pub fn read(&self, text: &str) -> Result<f64, String> {
        let (number, unit) = split(text)?;
        if unit.is_empty() {
            return Err(format!("{text:?} has no unit"));
        }
        let quantity = Quantity::parse(&unit)
            .map_err(|error| format!("{text:?} cannot be understood: {error}"))?;
        if quantity.dimension() != self.dimension() {
            let found = name(quantity.dimension());
            return Err(format!("{text:?} is {found}, expected {}", self.what));
        }
        let factor = quantity
            .to(self.unit)
            .map_err(|error| format!("{text:?} cannot be converted: {error}"))?;
        let value = number * factor.value();
        if !value.is_finite() {
            return Err(format!("{text:?} is not a finite number"));
        }
        Ok(value)
    }

    /// The text of `value` [SI]; reading it gives the same bits.
    pub fn write(&self, value: f64) -> String {
        let number = format!("{value:?}");
        let number = number.strip_suffix(".0").unwrap_or(&number);
        format!("{number} {}", self.unit)
    }

    fn dimension(&self) -> Dimension {
        let unit = Quantity::parse(self.unit).expect("a test reads every unit of this file");
        unit.dimension()
    }
}

/// A quantity of any kind that scenes ask for, in SI units, and its unit.
pub fn si(text: &str) -> Option<(f64, &'static str)> {
    let read = |kind: &&Kind| kind.read(text).ok().map(|value| (value, kind.unit));
    KINDS.iter().find_map(read)
}

/// The number in front, and the unit in the spelling that `runits` reads.
fn split(text: &str) -> Result<(f64, String), String> {
    let text = text.trim();
    let end = number_end(text);
    let number = text[..end]
        .parse()
        .map_err(|_| format!("{text:?} does not begin with a number"))?;
    let unit = text[end..].trim();
    // `1 /s` and `1 1/s` are both common; `1 2 m` is a slip.
    if unit.starts_with(|c: char| c.is_ascii_digit()) && !unit.starts_with("1/") {
        return Err(format!("{text:?} has two numbers"));
    }
    let unit = unit
        .replace('²', "^2")
        .replace('³', "^3")
        .replace('°', "degree")
        .replace('μ', "µ");
    Ok((number, unit))
}

/// Length of the longest start of `text` that is a number.
fn number_end(text: &str) -> usize {
    let ends = text
        .char_indices()
        .map(|(k, c)| k + c.len_utf8())
        .filter(|&end| text[..end].ends_with(|c: char| c.is_ascii_digit() || c == '.'))
        .take_while(|&end| text[..end].chars().all(|c| "+-.eE0123456789".contains(c)));
    ends.filter(|&end| text[..end].parse::<f64>().is_ok())
        .last()
        .unwrap_or(0)
}

/// Name of a dimension, with its article.
fn name(dimension: Dimension) -> String {
    if dimension.is_dimensionless() {
        return "a number or an angle".into();
    }
    let own = KINDS.iter().map(|kind| (kind.unit, kind.what));
    own.chain(OTHERS.iter().copied())
        .find(|(unit, _)| Quantity::parse(unit).is_ok_and(|q| q.dimension() == dimension))
        .map_or_else(
            || format!("of dimension {dimension}"),
            |(_, what)| what.to_string(),
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_of_this_file_is_read_and_every_example_is_right() {
        for kind in KINDS {
            kind.read(kind.example).unwrap();
        }
        for (unit, what) in OTHERS {
            let dimension = Quantity::parse(unit).unwrap().dimension();
            assert_eq!(name(dimension), *what, "{unit}");
        }
    }

    #[test]
    fn quantities_become_si_numbers() {
        let table: &[(&Kind, &str, f64)] = &[
            (&TIME, "6.60e-7 s", 6.6e-7),
            (&TIME, "5 ms", 5e-3),
            (&STRESS, "100 kPa", 1e5),
            (&STRESS, "-20 Pa", -20.0),
            (&STIFFNESS, "1e9 N/m", 1e9),
            (&DAMPING, "780 N s/m", 780.0),
            (&DAMPING, "780 N·s/m", 780.0),
            (&DENSITY, "3600 kg/m^3", 3600.0),
            (&DENSITY, "2.6 g/cm³", 2600.0),
            (&ACCELERATION, "9.81 m/s²", 9.81),
            (&RATE, "0.25 1/s", 0.25),
            (&RATE, "0.25 /s", 0.25),
            (&RATE, "0.25 s^-1", 0.25),
            (&FREQUENCY, "2 Hz", 2.0),
            (&LENGTH, "20mm", 0.02),
            (&LENGTH, "3 μm", 3e-6),
            (&VELOCITY, "100 m/year", 100.0 / 31_557_600.0),
            (&ANGLE, "180 degrees", std::f64::consts::PI),
            (&ANGLE, "180°", std::f64::consts::PI),
        ];
        for (kind, text, value) in table {
            let read = kind.read(text).unwrap();
            assert!((read / value - 1.0).abs() < 1e-15, "{text} gave {read:e}");
        }
    }

    #[test]
    fn what_is_written_is_read_with_the_same_bits() {
        for kind in KINDS {
            for value in [0.0, 1.0, 0.1 + 0.2, -1e-7 / 3.0, 1e17 / 7.0, 123456.789] {
                let text = kind.write(value);
                assert_eq!(kind.read(&text), Ok(value), "{text}");
            }
        }
    }

    #[test]
    fn wrong_text_is_told_from_wrong_dimensions() {
        let table: &[(&Kind, &str, &str)] = &[
            (
                &DENSITY,
                "2600 kg/m^2",
                "is a mass per area, expected a density",
            ),
            (&STRESS, "100 N", "is a force, expected a stress"),
            (&LENGTH, "20", "has no unit"),
            (&LENGTH, "mm", "does not begin with a number"),
            (&LENGTH, "2,5 mm", "cannot be understood"),
            (&LENGTH, "1 2 m", "has two numbers"),
            (&LENGTH, "20 mn", "unknown unit \"mn\""),
            (&LENGTH, "1e999 m", "is not a finite number"),
            (
                &LENGTH,
                "20 degrees",
                "is a number or an angle, expected a length",
            ),
        ];
        for (kind, text, message) in table {
            let error = kind.read(text).unwrap_err();
            assert!(error.contains(message), "{text} gave {error}");
        }
    }
}
