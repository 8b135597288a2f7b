//! A small wet scene.

/// A bed of two hundred grains that is pressed dry, loaded under water and sheared under water.
pub const SCENE: &str = r#"
title = "Small and wet"

[box]
size    = ["4 mm", "4 mm"]
gravity = "none"

[grains]
count   = 200
radius  = { law = "uniform", min = "0.45 mm", max = "0.55 mm" }
density = "2600 kg/m^3"

[contact]
normal     = { stiffness = "3e4 N/m", restitution = 0.3 }
tangential = { stiffness = "1e4 N/m", friction = 0.5 }

[water]
bed.permeability = "2e-13 m^2"
sides.top        = "drained"

[[phase]]
name     = "press"
top      = { normal_stress = "10 kPa", damping = "0.05 N s/m" }
friction = 0.1
water    = "none"
end      = { at_rest = 1e-4, max_duration = "0.2 s" }

[[phase]]
name = "load"
top  = { normal_stress = "12 kPa", damping = "0 N s/m" }
end  = { duration = "2 ms" }

[[phase]]
name  = "shear"
top   = { normal_stress = "12 kPa" }
shear = { strain_rate = "5 1/s" }
end   = { duration = "1 ms" }

[output]
series.every = "50 us"
fluid.every  = "0.5 ms"
grains       = "none"
profiles     = "none"
"#;
