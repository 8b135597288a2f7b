//! `--vary PATH=V1,V2,...`: one varied quantity.

use anyhow::{Result, bail, ensure};
use serde::{Deserialize, Serialize};

/// A quantity that differs from point to point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Where it stands in the scene; several places are given the same value.
    pub paths: Vec<String>,
    /// Its values as scenes write them: each of a grid's, or one for each point of a list.
    pub values: Vec<String>,
}

/// A quantity between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// Where it stands in the scene.
    pub paths: Vec<String>,
    /// Lower and upper bound.
    pub bounds: [f64; 2],
    /// What stands behind the numbers.
    pub unit: String,
    /// Are its logarithms spread evenly?
    pub log: bool,
    /// Is it a whole number?
    pub whole: bool,
}

const FORM: &str = "write e.g. --vary phase.shear.top.normal_stress=\"20 kPa, 80 kPa\"";
const SPAN: &str = "write e.g. --vary phase.shear.top.normal_stress=\"20..120 kPa\", or \
                    \"1e-15..1e-11 m^2 log\" to spread logarithms evenly";

impl Axis {
    /// Read `PATH=V1,V2,...`; before the `=` may stand several paths.
    ///
    /// # Errors
    /// What is wrong with it, and how to write it.
    pub fn read(argument: &str) -> Result<Self> {
        let (paths, values) = halves(argument, FORM)?;
        let values = with_unit(split(values));
        ensure!(
            values.iter().all(|value| !value.is_empty()),
            "--vary {argument}: a value is empty; {FORM}"
        );
        for (k, value) in values.iter().enumerate() {
            ensure!(
                !values[..k].contains(value),
                "--vary {argument}: {value} is there twice; remove one of them"
            );
        }
        Ok(Self { paths, values })
    }
}

impl Span {
    /// Read `PATH=LOW..HIGH UNIT`, or `PATH=LOW..HIGH UNIT log`.
    ///
    /// # Errors
    /// What is wrong with it, and how to write it.
    pub fn read(argument: &str) -> Result<Self> {
        let (paths, text) = halves(argument, SPAN)?;
        let wrong = |what: &str| anyhow::anyhow!("--vary {argument}: {what}; {SPAN}");
        let (low, rest) = text.split_once("..").ok_or_else(|| wrong("is no range"))?;
        let rest = rest.trim();
        let (rest, log) = match rest.strip_suffix("log") {
            Some(rest) => (rest.trim(), true),
            None => (rest, false),
        };
        let (high, unit) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        let low_number = number(low).ok_or_else(|| wrong("has no number before .."))?;
        let high_number = number(high).ok_or_else(|| wrong("has no number behind .."))?;
        if low_number >= high_number {
            bail!(wrong("does not go upwards"));
        }
        if log && low_number <= 0.0 {
            bail!(wrong("has logarithms only above zero"));
        }
        let digits = |text: &str| text.trim().parse::<i64>().is_ok();
        Ok(Self {
            paths,
            bounds: [low_number, high_number],
            unit: unit.trim().into(),
            log,
            whole: digits(low) && digits(high) && unit.is_empty() && !log,
        })
    }

    /// The value, as scenes write it, so far between the bounds [0 to 1].
    pub fn at(&self, share: f64) -> String {
        let [low, high] = self.bounds;
        let value = match (self.log, self.whole) {
            (true, _) => low * (high / low).powf(share),
            // As many numbers at either end as between.
            (false, true) => (low + share * (high - low + 1.0)).floor().min(high),
            (false, false) => low + share * (high - low),
        };
        if self.whole {
            return format!("{value}");
        }
        // What is beyond six digits would only fill the tables.
        let short: f64 = format!("{value:.5e}").parse().expect("it was a number");
        format!("{short:?} {}", self.unit).trim_end().into()
    }
}

/// The paths and what is behind the first `=` that follows them.
fn halves<'a>(argument: &'a str, form: &str) -> Result<(Vec<String>, &'a str)> {
    let Some((paths, values)) = argument.split_once('=') else {
        bail!("--vary {argument}: has no value; {form}");
    };
    let paths: Vec<String> = paths.split(',').map(|path| path.trim().into()).collect();
    ensure!(
        paths.iter().all(|path| !path.is_empty()),
        "--vary {argument}: has no path; {form}"
    );
    Ok((paths, values.trim()))
}

/// Split at commas outside of brackets and quotes.
fn split(text: &str) -> Vec<String> {
    let (mut depth, mut quote, mut parts) = (0, None, vec![String::new()]);
    for c in text.chars() {
        match (c, quote) {
            ('"' | '\'', None) => quote = Some(c),
            (_, Some(q)) if c == q => quote = None,
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth -= 1,
            (',', None) if depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        parts.last_mut().expect("there is one").push(c);
    }
    parts.iter().map(|part| part.trim().into()).collect()
}

/// `20, 40, 80 kPa`: the unit of the last is that of the numbers before it.
fn with_unit(mut values: Vec<String>) -> Vec<String> {
    let last = values.last().cloned().unwrap_or_default();
    let unit = last.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    // The power of ten of a number.
    let power = unit.trim_start_matches(['e', 'E']);
    let power = power.trim_start_matches(|c: char| c.is_ascii_digit() || "+-".contains(c));
    let number = |text: &str| text.trim().parse::<f64>().is_ok();
    let unit = [power, unit].into_iter().find(|unit| {
        let front = last.strip_suffix(unit);
        front.is_some_and(number)
    });
    let count = values.len().saturating_sub(1);
    let unit = unit.map_or("", str::trim);
    if !unit.is_empty() && values[..count].iter().all(|value| number(value)) {
        for value in &mut values[..count] {
            *value = format!("{value} {unit}");
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(argument: &str) -> Vec<String> {
        Axis::read(argument).unwrap().values
    }

    #[test]
    fn values_are_split_and_share_the_last_unit() {
        assert_eq!(values("a.b=20, 40,80 kPa"), ["20 kPa", "40 kPa", "80 kPa"]);
        assert_eq!(values("a=1,2kPa"), ["1 kPa", "2kPa"]);
        assert_eq!(values("a=1,2e-3m^2"), ["1 m^2", "2e-3m^2"]);
        assert_eq!(values("a=1,2e-3"), ["1", "2e-3"]);
        assert_eq!(values("a=1,none"), ["1", "none"]);
        assert_eq!(values("a.b=20 Pa, 1 kPa"), ["20 Pa", "1 kPa"]);
        assert_eq!(values("f=0.1,0.2"), ["0.1", "0.2"]);
        assert_eq!(
            values("r=none, { a = 1, b = [2, 3] }, \"x, y\""),
            ["none", "{ a = 1, b = [2, 3] }", "\"x, y\""]
        );
        let axis = Axis::read("a.b, c.d=1 m,2 m").unwrap();
        assert_eq!(axis.paths, ["a.b", "c.d"]);
    }

    #[test]
    fn what_is_no_axis_is_refused() {
        for (argument, what) in [
            ("a.b", "has no value"),
            ("=1", "has no path"),
            ("a=1,,2", "is empty"),
            ("a=1,2,1", "is there twice"),
        ] {
            let error = Axis::read(argument).unwrap_err().to_string();
            assert!(error.contains(what) && error.contains(argument), "{error}");
        }
    }

    #[test]
    fn spans_give_values_between_their_bounds() {
        let span = Span::read("k=1e-15..1e-11 m^2 log").unwrap();
        assert_eq!(span.at(0.5), "1e-13 m^2");
        assert_eq!(span.at(0.0), "1e-15 m^2");
        assert_eq!(Span::read("s=20..120 kPa").unwrap().at(0.25), "45.0 kPa");
        assert_eq!(Span::read("f=0.0..1.0").unwrap().at(0.125), "0.125");
        let seeds = Span::read("seed=1..4").unwrap();
        let all: Vec<_> = [0.0, 0.3, 0.6, 0.99, 1.0].map(|x| seeds.at(x)).into();
        assert_eq!(all, ["1", "2", "3", "4", "4"]);
        for (argument, what) in [
            ("k=3 m", "is no range"),
            ("k=x..3", "before .."),
            ("k=1..x m", "behind .."),
            ("k=3..1 m", "upwards"),
            ("k=0..1 m log", "above zero"),
        ] {
            let error = Span::read(argument).unwrap_err().to_string();
            assert!(error.contains(what) && error.contains(argument), "{error}");
        }
    }
}
