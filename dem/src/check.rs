//! Is a run possible at all? Descriptions and states that cannot be right are refused.

use crate::contact::Turning;
use crate::lanes::Place;
use crate::view::DUMMIES;
use crate::{ContactLaw, Domain, Drive, Error, Grains, Model, State, WallMotion, WallState};

/// Refuse what the solver cannot work with.
pub(crate) fn check(model: &Model, state: &State) -> Result<(), Error> {
    check_grains(&state.grains)?;
    check_domain(&model.domain, &state.grains)?;
    check_law(&model.law)?;
    check_walls(model, &state.walls)?;
    if !positive(model.step) {
        return refuse(format!("time step {} s must be positive", model.step));
    }
    if model.skin.is_some_and(|skin| !positive(skin)) {
        return refuse(format!("skin {:?} m must be positive", model.skin));
    }
    let drive = match model.drive {
        Some(Drive::Velocity(drive) | Drive::ShearStress(drive)) => drive,
        None => 0.0,
    };
    if !(drive.is_finite() && model.gravity.is_finite() && state.time.is_finite()) {
        let gravity = model.gravity;
        return refuse(format!(
            "drive {drive}, gravity {gravity} m/s² and time {} s must be finite numbers",
            state.time
        ));
    }
    for contact in &state.contacts {
        let history = &contact.history;
        let springs = history.spring + history.rolling_spring;
        if !(springs.is_finite() && history.twisting_spring.is_finite()) {
            let (i, j) = (contact.i, contact.j);
            return refuse(format!(
                "contact of grain {i} with {j:?}: springs must be finite"
            ));
        }
    }
    Ok(())
}

fn refuse(what: String) -> Result<(), Error> {
    Err(Error::Invalid(what))
}

/// Above zero, and a number.
fn positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}

/// Zero or above, and a number.
fn natural(x: f64) -> bool {
    x >= 0.0 && x.is_finite()
}

fn check_grains(grains: &Grains) -> Result<(), Error> {
    let n = grains.len();
    let lengths = [
        grains.radius.len(),
        grains.mass.len(),
        grains.moment_of_inertia.len(),
        grains.position.len(),
        grains.displacement.len(),
        grains.velocity.len(),
        grains.angular_velocity.len(),
        grains.orientation.len(),
        grains.constraint.len(),
    ];
    if lengths.iter().any(|&length| length != n) {
        return refuse(format!(
            "arrays of grains have lengths {lengths:?} for {n} identities"
        ));
    }
    if n == 0 {
        return refuse("there is no grain".into());
    }
    if n + DUMMIES.len() >= Place::MOST {
        return refuse(format!(
            "{n} grains: this version takes up to {}",
            Place::MOST - DUMMIES.len() - 1
        ));
    }
    for k in 0..n {
        if grains.id[k] as usize != k {
            return refuse(format!(
                "grain {k} has identity {}: they must be 0..{n} in order",
                grains.id[k]
            ));
        }
        let (radius, mass) = (grains.radius[k], grains.mass[k]);
        let inertia = grains.moment_of_inertia[k];
        if !(positive(radius) && positive(mass) && positive(inertia)) {
            return refuse(format!(
                "grain {k}: radius {radius} m, mass {mass} kg and moment of inertia {inertia} \
                 kg m² must be positive"
            ));
        }
        let finite = [
            grains.position[k],
            grains.displacement[k],
            grains.velocity[k],
            grains.angular_velocity[k],
        ];
        if !finite.iter().all(|vector| vector.is_finite()) {
            return refuse(format!(
                "grain {k} at {}: position, displacement and velocities must be finite numbers",
                grains.position[k]
            ));
        }
        if (grains.orientation[k].length() - 1.0).abs() > 1e-6 || grains.orientation[k].is_nan() {
            return refuse(format!(
                "grain {k}: its orientation is not a unit quaternion"
            ));
        }
    }
    Ok(())
}

fn check_domain(domain: &Domain, grains: &Grains) -> Result<(), Error> {
    let largest = grains.radius.iter().copied().fold(0.0, f64::max);
    for (axis, name) in ["x", "y"].iter().enumerate() {
        let length = domain.size[axis];
        if !positive(length) {
            return refuse(format!("the box is {length} m long along {name}"));
        }
        // Below two and a half diameters a grain could meet two images of another one.
        if domain.periodic[axis] && length < 5.0 * largest {
            return refuse(format!(
                "the box is {length} m long along {name}: a periodic side takes at least 2.5 \
                 largest diameters, {} m",
                5.0 * largest
            ));
        }
    }
    Ok(())
}

fn check_walls(model: &Model, states: &[WallState]) -> Result<(), Error> {
    if states.len() != model.walls.len() {
        return refuse(format!(
            "{} wall states for {} walls",
            states.len(),
            model.walls.len()
        ));
    }
    for (wall, state) in model.walls.iter().zip(states) {
        let name = &wall.name;
        // Not the other way round: no comparison with a number that is none is true.
        let unit = (wall.normal.length() - 1.0).abs() <= 1e-12;
        if !(unit && state.offset.is_finite() && state.velocity.is_finite()) {
            return refuse(format!(
                "wall {name}: its normal {} must be a unit vector, and offset {} m and velocity \
                 {} m/s finite numbers",
                wall.normal, state.offset, state.velocity
            ));
        }
        match wall.motion {
            WallMotion::Held => {}
            WallMotion::Velocity(velocity) if velocity.is_finite() => {}
            WallMotion::Velocity(velocity) => {
                return refuse(format!("wall {name}: velocity {velocity} m/s"));
            }
            WallMotion::Stress(load) => {
                if !(positive(load.mass) && natural(load.damping) && positive(load.area)) {
                    return refuse(format!(
                        "wall {name}: mass {} kg and area {} m² must be positive, damping {} N s/m \
                         not negative",
                        load.mass, load.area, load.damping
                    ));
                }
                let stress = [load.mean, load.amplitude, load.frequency];
                if !stress.iter().all(|number| number.is_finite()) {
                    return refuse(format!(
                        "wall {name}: stress {} Pa, amplitude {} Pa and frequency {} Hz must be \
                         finite numbers",
                        load.mean, load.amplitude, load.frequency
                    ));
                }
            }
        }
    }
    Ok(())
}

fn check_law(law: &ContactLaw) -> Result<(), Error> {
    let refuse = |what: &str| refuse(format!("contact law: {what}"));
    if !positive(law.normal_stiffness()) || !natural(law.normal_damping()) {
        return refuse("the normal stiffness must be positive, the damping not negative");
    }
    if law.slides() && !positive(law.tangential_stiffness()) {
        return refuse("the tangential stiffness must be positive where there is friction");
    }
    let linear = match law {
        ContactLaw::Linear(linear) => linear,
        ContactLaw::LinearLammps(law) => {
            if !(natural(law.tangential_damping) && natural(law.friction)) {
                return refuse("tangential damping and friction must not be negative");
            }
            return Ok(());
        }
    };
    if let Some(sliding) = linear.sliding {
        let ordered = sliding.friction_static >= sliding.friction_dynamic;
        let numbers = natural(sliding.friction_dynamic) && natural(sliding.friction_static);
        if !(ordered && numbers && natural(sliding.damping)) {
            return refuse("0 <= dynamic friction <= static friction, and no negative damping");
        }
    }
    let turning = [linear.rolling, linear.twisting].into_iter().flatten();
    for Turning {
        stiffness,
        damping,
        friction,
    } in turning
    {
        if linear.sliding.is_none() {
            return refuse("rolling and twisting resistance need tangential friction too");
        }
        if !(positive(stiffness) && natural(damping) && natural(friction)) {
            return refuse(
                "rolling and twisting need a positive stiffness, no negative damping or friction",
            );
        }
    }
    Ok(())
}
