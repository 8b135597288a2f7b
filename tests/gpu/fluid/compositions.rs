//! What needs no GPU: structs that both sides write, every composition that a scene can ask
//! for, what is left out of those that have no use for it, and a twin for each law.

use crate::lab::Suite;
use lbm::gpu::{Given, Range, Setting};
use shaders::naga::valid::{Capabilities, ValidationFlags, Validator};
use shaders::naga::{Handle, Module};
use shaders::{Flags, compose, layout};
use std::collections::BTreeSet;
use std::mem::offset_of;
use std::path::Path;

pub fn list(suite: &mut Suite) {
    suite.plain("structs_of_the_fluid_have_one_layout", layouts);
    suite.plain("every_fluid_of_a_scene_validates", compositions);
    suite.plain("what_a_fluid_lacks_is_not_compiled", left_out);
    suite.plain("every_law_of_the_fluid_has_its_twin", twins);
}

/// A lattice of so many populations a binding.
fn shape(each: u32) -> Flags {
    Flags::new()
        .number("EACH", each)
        .number("PARTS", 19_u32.div_ceil(each))
        .number("GROUP_X", 64)
        .number("GROUP_Y", 1)
        .number("GROUP_Z", 1)
}

fn layouts() {
    let flags = shape(19).set("LINKS").set("SPECIALS");
    let step = compose("lbm/step.wgsl", &flags).unwrap();
    let (size, members) = layout::of(&step, "Setting").expect("Setting");
    assert_eq!(size as usize, size_of::<Setting>());
    macro_rules! offsets {
        ($($field:ident),+) => {
            [$((stringify!($field).to_string(), offset_of!(Setting, $field) as u32)),+]
        };
    }
    let ours = offsets!(
        cells,
        stride,
        extent,
        step,
        walled,
        pressures,
        half_force,
        omega_even,
        drag_stretch,
        flatness,
        omega_odd,
        nothing
    );
    // Behind these is what fills a row.
    assert_eq!(members[..ours.len()], ours);
    let (size, members) = layout::of(&step, "Given").expect("Given");
    assert_eq!(size as usize, size_of::<Given>());
    let ours = [
        ("sides".to_string(), offset_of!(Given, sides) as u32),
        ("fresh".to_string(), offset_of!(Given, fresh) as u32),
    ];
    assert_eq!(members, ours);
    let slab = compose("lbm/state.wgsl", &flags).unwrap();
    let (size, members) = layout::of(&slab, "Range").expect("Range");
    assert_eq!(size as usize, size_of::<Range>());
    assert_eq!(members[..2], [("first".into(), 0), ("count".into(), 4)]);
    assert_eq!([offset_of!(Range, first), offset_of!(Range, count)], [0, 4]);
}

/// The names in `all` whose bit is set.
fn with(flags: Flags, all: &[&str], bits: usize) -> Flags {
    let each = all.iter().enumerate();
    each.fold(flags, |flags, (k, name)| {
        flags.set_if(name, bits >> k & 1 == 1)
    })
}

fn validate(path: &str, flags: &Flags) {
    let module = compose(path, flags).unwrap_or_else(|error| panic!("{path} {flags:?}: {error}"));
    // No capability: what every device has.
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    if let Err(error) = validator.validate(&module) {
        panic!("{path} {flags:?}: {}", error.emit_to_string(""));
    }
}

/// All laws, all kinds of links, and all ways to bind the populations.
fn compositions() {
    let laws = ["POROUS", "INERTIA", "FORCE", "FORCHHEIMER", "SOURCE"];
    for law in 0..32 {
        for path in ["lbm/step.wgsl", "lbm/snapshot.wgsl"] {
            validate(path, &with(shape(19), &laws, law));
        }
    }
    let ends = [
        &[][..],
        &["LINKS"],
        &["LINKS", "SOLIDS"],
        &["LINKS", "SPECIALS"],
        &["LINKS", "SPECIALS", "MIRRORS"],
        &["LINKS", "SPECIALS", "MIRRORS", "SOLIDS"],
    ];
    for each in [19, 10, 8, 6, 4, 2, 1] {
        for names in ends {
            let flags = with(shape(each), names, usize::MAX);
            for path in [
                "lbm/step.wgsl",
                "lbm/state.wgsl",
                "lbm/snapshot.wgsl",
                "lbm/finite.wgsl",
            ] {
                validate(path, &flags);
            }
        }
    }
}

/// Plain names of functions and arrays.
fn names(module: &Module) -> BTreeSet<String> {
    let functions = module.functions.iter().filter_map(|(_, f)| f.name.clone());
    let globals = &module.global_variables;
    let arrays = globals
        .iter()
        .filter_map(|(_, global): (Handle<_>, _)| global.name.clone());
    let plain = |name: String| match name.split_once("X_naga_oil_mod_X") {
        Some((plain, _)) => plain.to_string(),
        None => name,
    };
    functions.chain(arrays).map(plain).collect()
}

fn left_out() {
    let of = |names_of: &[&str]| {
        let flags = with(shape(19), names_of, usize::MAX);
        names(&compose("lbm/step.wgsl", &flags).unwrap())
    };
    let has = |all: &BTreeSet<String>, name: &str| all.contains(name);
    let plain = of(&[]);
    for name in [
        "words",
        "rows",
        "given",
        "inverse_storage",
        "sources",
        "flux",
        "part_b",
    ] {
        assert!(!has(&plain, name), "{name}");
    }
    let bed = of(&["POROUS"]);
    assert!(has(&bed, "inverse_storage") && has(&bed, "half_drag") && has(&bed, "flux"));
    for name in [
        "sources",
        "half_forchheimer",
        "inverse_porosity",
        "second_order",
    ] {
        assert!(!has(&bed, name), "{name}");
    }
    let all = ["POROUS", "SOURCE", "FORCHHEIMER", "INERTIA"];
    for name in [
        "sources",
        "half_forchheimer",
        "inverse_porosity",
        "second_order",
    ] {
        assert!(has(&of(&all), name), "{name}");
    }
    let walls = of(&["LINKS"]);
    assert!(has(&walls, "words") && !has(&walls, "rows") && !has(&walls, "beside"));
    let sides = of(&["LINKS", "SPECIALS"]);
    assert!(has(&sides, "beside") && !has(&sides, "mirrored"));
}

/// Each law of one side has a file of the same name on the other, and each names the other.
fn twins() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let laws = std::fs::read_dir(root.join("shaders/lbm/collide")).unwrap();
    let mut count = 0;
    for wgsl in laws {
        let wgsl = wgsl.unwrap().path();
        let stem = wgsl.file_stem().unwrap().to_string_lossy().into_owned();
        let (rust, shader) = (
            format!("lbm/src/collide/{stem}.rs"),
            format!("shaders/lbm/collide/{stem}.wgsl"),
        );
        let text = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
        assert!(
            text(&rust).contains(&shader),
            "{rust} does not name {shader}"
        );
        assert!(
            text(&shader).contains(&rust),
            "{shader} does not name {rust}"
        );
        count += 1;
    }
    assert_eq!(count, 2);
}
