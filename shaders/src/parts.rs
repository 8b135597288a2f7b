//! Arrays in several parts, as kernels see them.
//!
//! WGSL cannot choose between bindings by a number, but for an optional feature. So an array that
//! may lie in parts is declared with a note,
//!
//! ```wgsl
//! @group(0) @binding(8) var<storage, read_write> springs: array<vec4<f32>>; // in parts
//! ```
//!
//! and read and written through two functions that composition adds on the same line,
//! `springs_at(e)` and `set_springs(e, value)`. In one part they are `springs[e]` and no more. In
//! several there is a binding for each, `springs`, `springs_b`, `springs_c`, and they switch over the
//! upper bits of `e`.

use crate::Error;

/// The note.
const NOTE: &str = "// in parts";
/// More than names have letters for.
const MOST: u32 = 26;

/// How an array lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Bindings.
    pub count: u32,
    /// Where there are several, each but the last has two to the power of this many elements.
    pub bits: u32,
}

impl Parts {
    const ONE: Self = Self { count: 1, bits: 0 };

    /// Parts of `len` elements of `size` bytes, where a binding holds `largest` bytes.
    pub fn of(len: usize, size: usize, largest: u64) -> Self {
        // A power of two may be less than a binding holds; one part alone need not be one.
        let most = largest as usize / size;
        if len <= most {
            return Self::ONE;
        }
        let bits = most.max(1).ilog2();
        Self {
            count: len.div_ceil(1 << bits) as u32,
            bits,
        }
    }
}

/// Name of part `part` of the array `whole`.
fn name_of(whole: &str, part: u32) -> String {
    match part {
        0 => whole.into(),
        _ => format!("{whole}_{}", (b'a' + part as u8) as char),
    }
}

/// The part of the array `whole` that is called `name`.
pub(crate) fn part_of(name: &str, whole: &str) -> Option<usize> {
    let rest = name.strip_prefix(whole)?;
    if rest.is_empty() {
        return Some(0);
    }
    match rest.strip_prefix('_')?.as_bytes() {
        [letter @ b'b'..=b'z'] => Some(usize::from(letter - b'a')),
        _ => None,
    }
}

/// `text` with what its notes stand for; `parts` tells how an array of a name lies, if it is not in
/// one part. Lines keep their numbers.
pub(crate) fn expand(text: &str, parts: impl Fn(&str) -> Option<Parts>) -> Result<String, Error> {
    let mut expanded = String::with_capacity(text.len());
    for line in text.lines() {
        match line.strip_suffix(NOTE) {
            Some(declared) => {
                let wrong =
                    || Error::Shader(format!("in parts can be no more than arrays: {line}"));
                let array = Declared::read(declared).ok_or_else(wrong)?;
                let parts = parts(array.name).unwrap_or(Parts::ONE);
                if parts.count > MOST {
                    let (name, count) = (array.name, parts.count);
                    let what = format!("{name} in {count} parts; there may be {MOST}");
                    return Err(Error::Memory(what));
                }
                expanded += &array.text(parts);
            }
            None => expanded += line,
        }
        expanded.push('\n');
    }
    Ok(expanded)
}

/// A declaration, `@group(0) @binding(BINDING) var<storage, ACCESS> NAME: array<ELEMENT>;`.
struct Declared<'a> {
    binding: u32,
    access: &'a str,
    name: &'a str,
    element: &'a str,
}

impl<'a> Declared<'a> {
    fn read(line: &'a str) -> Option<Self> {
        let rest = line.trim().strip_prefix("@group(0) @binding(")?;
        let (binding, rest) = rest.split_once(") var<storage, ")?;
        let (access, rest) = rest.split_once("> ")?;
        let (name, rest) = rest.split_once(": array<")?;
        Some(Self {
            binding: binding.parse().ok()?,
            access,
            name,
            element: rest.strip_suffix(">;")?,
        })
    }

    /// The bindings and the functions.
    fn text(&self, parts: Parts) -> String {
        let Self {
            binding,
            access,
            name,
            element,
        } = self;
        let mut text = String::new();
        for part in 0..parts.count {
            // Numbers tell bindings apart; those that count are given when a kernel is made.
            let (binding, name) = (binding + 100 * part, name_of(name, part));
            text += &format!(
                "@group(0) @binding({binding}) var<storage, {access}> {name}: array<{element}>; "
            );
        }
        text += &format!("fn {name}_at(at: u32) -> {element} {{ ");
        text += &self.choose(parts, |place| format!("return {place};"));
        text += "} ";
        if *access == "read_write" {
            text += &format!("fn set_{name}(at: u32, value: {element}) {{ ");
            text += &self.choose(parts, |place| format!("{place} = value;"));
            text += "}";
        }
        text
    }

    /// What is `done` with element `at`, wherever it lies.
    fn choose(&self, parts: Parts, done: impl Fn(String) -> String) -> String {
        if parts.count == 1 {
            return done(format!("{}[at]", self.name)) + " ";
        }
        let Parts { count, bits } = parts;
        let mut text = format!(
            "let inside = at & {}u; switch at >> {bits}u {{ ",
            (1 << bits) - 1
        );
        for part in 0..count {
            let place = format!("{}[inside]", name_of(self.name, part));
            let case = match part + 1 == count {
                true => "default".into(),
                false => format!("case {part}u"),
            };
            text += &format!("{case}: {{ {} }} ", done(place));
        }
        text + "} "
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "struct A { x: f32 }\n\
        @group(0) @binding(8) var<storage, read_write> springs: array<vec4<f32>>; // in parts\n\
        @group(0) @binding(9) var<storage, read> words: array<u32>; // in parts\n";

    #[test]
    fn one_part_is_the_array_and_no_more() {
        let text = expand(TEXT, |_| None).unwrap();
        assert_eq!(text.lines().count(), TEXT.lines().count());
        assert!(text.contains("fn springs_at(at: u32) -> vec4<f32> { return springs[at]; }"));
        assert!(text.contains("{ springs[at] = value; }"));
        assert!(!text.contains("switch") && !text.contains("set_words"));
    }

    #[test]
    fn three_parts_are_three_bindings_and_a_switch() {
        let of = |name: &str| (name == "springs").then_some(Parts { count: 3, bits: 5 });
        let text = expand(TEXT, of).unwrap();
        assert!(text.contains("@binding(208) var<storage, read_write> springs_c"));
        assert!(text.contains("case 1u: { return springs_b[inside]; }"));
        assert!(text.contains("at & 31u; switch at >> 5u"));
        assert!(text.contains("words[at]"), "words lie in one part");
    }

    #[test]
    fn parts_are_as_many_as_bindings_ask_for() {
        let gib = 1u64 << 30;
        assert_eq!(Parts::of(1 << 27, 16, 2 * gib), Parts::ONE);
        let four = Parts { count: 4, bits: 26 };
        assert_eq!(Parts::of((3 << 26) + 1, 16, 2 * gib - 1), four);
        assert_eq!(Parts::of(1 << 28, 16, 2 * gib - 1), four);
    }

    #[test]
    fn names_tell_their_parts() {
        for part in 0..MOST {
            let name = name_of("springs", part);
            assert_eq!(part_of(&name, "springs"), Some(part as usize));
        }
        assert_eq!(part_of("springs_read", "springs"), None);
        assert_eq!(part_of("springs_a", "springs"), None);
    }

    #[test]
    fn a_note_where_it_does_not_belong_is_an_error() {
        assert!(expand("var<private> x: u32; // in parts", |_| None).is_err());
    }
}
