//! Are scenes understood, and wrong ones refused with the place and the remedy?

mod bad;
mod meaning;
mod pores;
mod protocol;
mod ready_made;
mod resolved;
mod sweep;
mod water;

use experiments::ready::{self, Ready};
use experiments::scene::{AnyScene, Document, Problems, Scene};
use std::path::Path;

/// The scene of a text, with `sets` as on the command line.
fn read(text: &str, sets: &[&str]) -> Result<Scene, Problems> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).into()).collect();
    let document = Document::new("scene.toml", Path::new("."), text, &sets)?;
    Scene::read(&document)
}

/// The ready-made experiments with grains.
fn of_grains() -> impl Iterator<Item = Ready> {
    ready::ALL.into_iter().filter(|ready| {
        let document = Document::new(ready.name, &ready.folder(), ready.scene(), &[]).unwrap();
        matches!(AnyScene::read(&document).unwrap(), AnyScene::Grains(_))
    })
}

/// A scene that is right, for tests that change one thing.
const SMALL: &str = r#"
title = "Small"

[box]
size = ["6 mm", "6 mm"]

[grains]
count   = 60
radius  = "0.5 mm"
density = "2600 kg/m^3"

[contact]
normal     = { stiffness = "1e5 N/m", damping = "0.1 N s/m" }
tangential = { stiffness = "3e4 N/m", friction = 0.5 }

[[phase]]
name = "settle"
end  = { duration = "2 ms" }

[[phase]]
name = "consolidate"
top  = { normal_stress = "10 kPa" }
end  = { duration = "2 ms" }

[[phase]]
name  = "shear"
top   = { normal_stress = "10 kPa" }
shear = { strain_rate = "5 1/s" }
layer = "0.6 mm"
end   = { strain = 0.005 }
"#;
