//! The varied quantities as coordinates: their names, units and values.

use super::axis::Axis;
use super::design::Design;
use super::series::Column;
use crate::scene::units;
use anyhow::Result;
use netcdf::FileMut;

/// What the varied quantities are called: the last words of their paths, as many as tell them from
/// each other and from all else.
pub fn names(axes: &[Axis], variables: &[Column], numbers: &[Column]) -> Vec<String> {
    let mut taken: Vec<String> = ["row", "point", "status", "folder"].map(Into::into).into();
    taken.extend(variables.iter().chain(numbers).map(|c| c.name.clone()));
    let tail = |axis: &Axis, n: usize| {
        let words: Vec<&str> = axis.paths[0].split('.').collect();
        words[words.len().saturating_sub(n)..].join("_")
    };
    let mut names = Vec::new();
    for (k, axis) in axes.iter().enumerate() {
        let most = axis.paths[0].split('.').count();
        let alone = |n: &usize| {
            let name = tail(axis, *n);
            let others = axes.iter().enumerate().filter(|(other, _)| *other != k);
            let mut others = others.map(|(_, other)| tail(other, *n));
            !taken.contains(&name) && !others.any(|other| other == name)
        };
        // A path that is all taken gets a word in front.
        let name = (1..=most).find(alone).map(|n| tail(axis, n));
        names.push(name.unwrap_or_else(|| format!("varied_{}", tail(axis, most))));
    }
    names
}

/// The dimensions of the points and the varied quantities along them.
pub fn dimensions(design: &Design, file: &mut FileMut, names: &[String]) -> Result<Vec<String>> {
    let dims = match design.grid {
        true => names.to_vec(),
        false => vec!["point".to_string()],
    };
    for (name, length) in dims.iter().zip(design.shape()) {
        file.add_dimension(name, length)?;
    }
    if !design.grid {
        let mut point = file.add_variable::<i64>("point", &["point"])?;
        let numbers: Vec<i64> = (0..design.count() as i64).collect();
        point.put_values(&numbers, ..)?;
        point.put_attribute("long_name", "number of the point")?;
    }
    for (k, (axis, name)) in design.axes.iter().zip(names).enumerate() {
        let dim = &dims[if design.grid { k } else { 0 }];
        let word = axis.paths[0].rsplit('.').next().unwrap_or_default();
        let long_name = format!("{} ({})", word.replace('_', " "), axis.paths.join(", "));
        match numbers(&axis.values) {
            Some((values, units)) => {
                let mut variable = file.add_variable::<f64>(name, &[dim])?;
                variable.put_values(&values, ..)?;
                variable.put_attribute("units", units)?;
                variable.put_attribute("long_name", long_name)?;
            }
            None => {
                let mut variable = file.add_string_variable(name, &[dim])?;
                for (k, value) in axis.values.iter().enumerate() {
                    variable.put_string(value, k)?;
                }
                variable.put_attribute("long_name", long_name)?;
            }
        }
    }
    Ok(dims)
}

/// The values in SI units with their unit, if all are numbers of one kind.
fn numbers(values: &[String]) -> Option<(Vec<f64>, String)> {
    let read = |text: &String| {
        let text = text.trim_matches('"');
        let bare = text.parse::<f64>().ok().map(|x| (x, "1"));
        bare.or_else(|| units::si(text))
    };
    let read: Vec<_> = values.iter().map(read).collect::<Option<_>>()?;
    let unit = read.first()?.1;
    let alike = read.iter().all(|(_, own)| *own == unit);
    alike.then(|| (read.iter().map(|(x, _)| *x).collect(), in_powers(unit)))
}

/// `kg/m^3` as NetCDF has it, `kg m-3`.
fn in_powers(unit: &str) -> String {
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    let above = above.split(' ').filter(|word| *word != "1");
    let above = above.map(|word| word.replace('^', ""));
    let below = below.split(' ').filter(|word| !word.is_empty());
    let below = below.map(|word| match word.split_once('^') {
        Some((name, power)) => format!("{name}-{power}"),
        None => format!("{word}-1"),
    });
    let words: Vec<String> = above.chain(below).collect();
    match words.is_empty() {
        true => "1".into(),
        false => words.join(" "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_written_in_powers() {
        for (unit, powers) in [
            ("kg/m^3", "kg m-3"),
            ("1/s", "s-1"),
            ("N s/m", "N s m-1"),
            ("m^2", "m2"),
            ("1", "1"),
        ] {
            assert_eq!(in_powers(unit), powers);
        }
    }

    #[test]
    fn quantities_become_numbers_and_words_stay_words() {
        let of = |values: &[&str]| {
            let values: Vec<String> = values.iter().map(|v| (*v).into()).collect();
            numbers(&values)
        };
        assert_eq!(
            of(&["20 kPa", "1 Pa"]),
            Some((vec![2e4, 1.0], "Pa".to_string()))
        );
        assert_eq!(of(&["1", "2.5"]), Some((vec![1.0, 2.5], "1".to_string())));
        assert_eq!(of(&["0.5", "none"]), None);
        assert_eq!(of(&["1 Pa", "1 m"]), None);
    }

    #[test]
    fn names_are_as_short_as_they_can_be() {
        let axis = |path: &str| Axis {
            paths: vec![path.into()],
            values: Vec::new(),
        };
        let axes = [
            "phase.shear.top.normal_stress",
            "phase.shear.friction",
            "a.friction",
            "row",
        ];
        let found = names(&axes.map(axis), &[], &[]);
        assert_eq!(
            found,
            [
                "normal_stress",
                "shear_friction",
                "a_friction",
                "varied_row"
            ]
        );
    }
}
