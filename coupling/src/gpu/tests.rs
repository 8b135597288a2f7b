//! What needs no device: structs of both sides lie alike, and whatever a scene asks for composes.

use super::numbers::{Course, Numbers, Span};
use shaders::naga::Module;
use shaders::naga::valid::{Capabilities, ValidationFlags, Validator};
use shaders::{Flags, compose, layout};
use std::mem::offset_of;

/// Files with entry points, and what each may be compiled with beside the choices of the scene.
const FILES: [(&str, &[&[&str]]); 8] = [
    (
        "scatter",
        &[
            &[],
            &["DRAGS"],
            &["PACES"],
            &["DEPOSIT"],
            &["MOVES"],
            &["MOVES", "DRAGS"],
            &["MOVES", "LOOKS"],
        ],
    ),
    ("follow", &[&[]]),
    ("push", &[&[]]),
    ("gather", &[&[]]),
    ("drain", &[&[]]),
    ("loads", &[&[]]),
    ("touch", &[&[]]),
    ("bed", &[&[]]),
];

/// What grains between two walls compile in.
fn grains() -> Flags {
    Flags::new()
        .set("SLIDES")
        .set("COMPANION")
        .number("LANES", 1)
        .number("PARTIALS", 1)
        .number("SPREAD", 32)
        .number("WALLS", 2)
        .number("BODIES", 3)
        .number("GATHERED_WORDS", 16)
}

fn scenes() -> Vec<Flags> {
    let laws = ["POROSITY", "ERGUN", "DI_FELICE"].map(|law| grains().set(law));
    let choices = (0..8u32).map(|bits| {
        let bit = |k: u32| bits >> k & 1 == 1;
        grains()
            .set_if("WIDE", bit(0))
            .set_if("CAVITATION", bit(1))
            .set_if("THROUGH", bit(1))
            .set_if("UNPREDICTED", bit(2))
    });
    choices.chain(laws).collect()
}

fn module(file: &str, flags: &Flags) -> Module {
    let path = format!("coupling/{file}.wgsl");
    compose(&path, flags).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn whatever_a_scene_asks_for_is_valid() {
    for flags in scenes() {
        // Laws are known to two files alone.
        let law = ["POROSITY", "ERGUN", "DI_FELICE"]
            .iter()
            .any(|law| flags.has(law));
        let files = FILES
            .iter()
            .filter(|(file, _)| !law || ["touch", "bed"].contains(file));
        for (file, variants) in files {
            for variant in *variants {
                let flags = variant.iter().fold(flags.clone(), |f, name| f.set(name));
                let module = module(file, &flags);
                // No capability: what every device has.
                let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
                if let Err(error) = validator.validate(&module) {
                    panic!("{file} with {flags:?}: {}", error.emit_to_string(""));
                }
            }
        }
    }
}

#[test]
fn structs_of_the_coupling_lie_alike_on_both_sides() {
    macro_rules! same {
        ($module:expr, $rust:ty, $($member:ident),*) => {
            let name = stringify!($rust);
            let (size, found) = layout::of($module, name).unwrap_or_else(|| panic!("no {name}"));
            let expected = vec![
                $((stringify!($member).to_string(), offset_of!($rust, $member) as u32)),*
            ];
            // Three numbers of the law on one side are an array on the other.
            let found: Vec<_> = found
                .into_iter()
                .filter(|(name, _)| !["flow_b", "flow_c", "unused_b"].contains(&name.as_str()))
                .map(|(name, at)| match name.as_str() {
                    "flow_a" => ("flow".to_string(), at),
                    "unused_a" => ("unused".to_string(), at),
                    _ => (name, at),
                })
                .collect();
            assert_eq!(found, expected, "{name}");
            assert_eq!(size as usize, size_of::<$rust>(), "{name}");
        };
    }
    let bed = module("loads", &grains());
    same!(
        &bed,
        Numbers,
        cells,
        count,
        lengths,
        grains,
        unit,
        step,
        spacing,
        compressibility,
        viscosity,
        density,
        gravity,
        solid_density,
        loose,
        cavitation,
        flow,
        walls,
        shares
    );
    same!(
        &bed,
        Course,
        storage_unit,
        drag_unit,
        speed,
        source_unit,
        renew_at,
        memory,
        stretch,
        passed,
        exchange,
        drag_every,
        share,
        towed
    );
    same!(&bed, Span, bottom, height, bed, mean_load, half, unused);
}
