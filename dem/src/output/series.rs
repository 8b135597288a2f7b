//! Scalars of `series.nc`.

use super::{Reading, Scalar, Storage, Variable};
use crate::{Body, Sums, measure};
use glam::DVec2;

const fn scalar(
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    read: fn(&Reading) -> f64,
) -> Scalar {
    let variable = Variable {
        name,
        dims: &[],
        units,
        long_name,
        storage: Storage::Double,
    };
    Scalar { variable, read }
}

/// Scalars of `series.nc`.
pub static SERIES: &[Scalar] = &[
    scalar(
        "shear_stress_top",
        "Pa",
        "shear stress on the driven layer",
        |r| -r.now.driven_force / r.model.domain.area(),
    ),
    scalar(
        "shear_stress_top_mean",
        "Pa",
        "shear stress on the driven layer, mean since the last row",
        shear_stress_top_mean,
    ),
    scalar(
        "shear_stress_bottom",
        "Pa",
        "shear stress on the held layer",
        |r| r.now.held_force / r.model.domain.area(),
    ),
    scalar(
        "shear_stress_bottom_mean",
        "Pa",
        "shear stress on the held layer, mean since the last row",
        |r| r.mean(r.now.held_force, |s| s.held_force) / r.model.domain.area(),
    ),
    scalar(
        "normal_stress_top",
        "Pa",
        "normal stress on the top wall",
        |r| r.wall_stress(measure::top_wall(r.model)),
    ),
    scalar(
        "normal_stress_top_mean",
        "Pa",
        "normal stress on the top wall, mean since the last row",
        normal_stress_top_mean,
    ),
    scalar(
        "normal_stress_bottom",
        "Pa",
        "normal stress on the bottom wall",
        |r| r.wall_stress(measure::bottom_wall(r.model)),
    ),
    scalar(
        "normal_stress_bottom_mean",
        "Pa",
        "normal stress on the bottom wall, mean since the last row",
        |r| r.wall_stress_mean(measure::bottom_wall(r.model)),
    ),
    scalar(
        "wall_shear_stress_top_x",
        "Pa",
        "x force of the grains on the top wall over its area, at this instant",
        |r| r.wall_shear_stress(measure::top_wall(r.model)).x,
    ),
    scalar(
        "wall_shear_stress_top_y",
        "Pa",
        "y force of the grains on the top wall over its area, at this instant",
        |r| r.wall_shear_stress(measure::top_wall(r.model)).y,
    ),
    scalar(
        "wall_shear_stress_bottom_x",
        "Pa",
        "x force of the grains on the bottom wall over its area, at this instant",
        |r| r.wall_shear_stress(measure::bottom_wall(r.model)).x,
    ),
    scalar(
        "wall_shear_stress_bottom_y",
        "Pa",
        "y force of the grains on the bottom wall over its area, at this instant",
        |r| r.wall_shear_stress(measure::bottom_wall(r.model)).y,
    ),
    scalar(
        "friction",
        "1",
        "shear stress over normal stress at the top, means since the last row; none without load",
        friction,
    ),
    scalar("wall_height", "m", "height of the top wall", |r| {
        let wall = measure::top_wall(r.model);
        wall.map_or(f64::NAN, |w| measure::wall_height(r.model, &r.now.state, w))
    }),
    scalar(
        "solid_fraction",
        "1",
        "solid fraction of the bed, three mean diameters (at most a quarter of its height) away \
         from bottom and top",
        |r| measure::solid_fraction(r.model, &r.now.state),
    ),
    scalar(
        "coordination_number",
        "1",
        "mean number of grains that a grain touches",
        |r| measure::coordination_number(&r.now.state),
    ),
    scalar(
        "inertial_number",
        "1",
        "inertial number, strain rate x mean diameter x sqrt(grain density / normal stress)",
        inertial_number,
    ),
    scalar(
        "kinetic_energy",
        "J",
        "kinetic energy of translation",
        |r| r.now.ledger.kinetic,
    ),
    scalar(
        "rotational_energy",
        "J",
        "kinetic energy of rotation",
        |r| r.now.ledger.rotational,
    ),
    scalar(
        "elastic_energy_normal",
        "J",
        "energy of the normal springs",
        |r| r.now.ledger.elastic_normal,
    ),
    scalar(
        "elastic_energy_tangential",
        "J",
        "energy of the tangential springs",
        |r| r.now.ledger.elastic_tangential,
    ),
    scalar(
        "elastic_energy_rolling",
        "J",
        "energy of the rolling and twisting springs",
        |r| r.now.ledger.elastic_rolling,
    ),
    scalar(
        "dissipated_friction",
        "J",
        "energy lost in sliding since the phase began",
        |r| r.ledger(r.now.ledger.dissipated_friction),
    ),
    scalar(
        "dissipated_viscosity",
        "J",
        "energy lost in dashpots since the phase began",
        |r| r.ledger(r.now.ledger.dissipated_viscosity),
    ),
    scalar(
        "dissipated_rolling",
        "J",
        "energy lost in rolling and twisting since the phase began",
        |r| r.ledger(r.now.ledger.dissipated_rolling),
    ),
    scalar(
        "work_walls",
        "J",
        "work of the walls on the grains since the phase began",
        |r| r.ledger(r.now.ledger.work_walls),
    ),
    scalar(
        "work_drive",
        "J",
        "work of the drive on the grains since the phase began",
        |r| r.ledger(r.now.ledger.work_drive),
    ),
    scalar(
        "work_gravity",
        "J",
        "work of gravity on the grains since the phase began",
        |r| r.ledger(r.now.ledger.work_gravity),
    ),
    scalar(
        "energy_residual",
        "J",
        "work that arrived and is not found: work - change of energy - dissipation",
        |r| r.ledger(r.now.ledger.residual),
    ),
];

impl Reading<'_> {
    /// Mean since the last reading of a quantity that the solver sums up; its value `now`
    /// if no step was made since.
    fn mean(&self, now: f64, sum: impl Fn(&Sums) -> f64) -> f64 {
        let steps = self.now.sums.steps - self.before.steps;
        if steps == 0 {
            return now;
        }
        (sum(&self.now.sums) - sum(self.before)) / steps as f64
    }

    /// Normal stress on a wall [Pa].
    fn wall_stress(&self, wall: Option<usize>) -> f64 {
        let force = wall.map_or(f64::NAN, |w| self.now.wall_force[w]);
        force / self.model.domain.area()
    }

    /// Mean of the normal stress on a wall since the last reading [Pa].
    fn wall_stress_mean(&self, wall: Option<usize>) -> f64 {
        let Some(w) = wall else { return f64::NAN };
        // The sums before the first step have no walls yet.
        let sum = |s: &Sums| s.wall_force.get(w).copied().unwrap_or(0.0);
        self.mean(self.now.wall_force[w], sum) / self.model.domain.area()
    }

    /// Force of the grains on a wall along x and y, over its area [Pa].
    fn wall_shear_stress(&self, wall: Option<usize>) -> DVec2 {
        let Some(wall) = wall else { return DVec2::NAN };
        let contacts = self.now.state.contacts.iter();
        let on_grains: DVec2 = contacts
            .filter(|contact| contact.j == Body::Wall(wall as u32))
            .map(|contact| contact.force.truncate())
            .sum();
        -on_grains / self.model.domain.area()
    }

    /// An entry of the ledger that is a sum over steps; NaN if the sums are not kept.
    fn ledger(&self, entry: f64) -> f64 {
        if self.model.ledger { entry } else { f64::NAN }
    }
}

fn shear_stress_top_mean(r: &Reading) -> f64 {
    -r.mean(r.now.driven_force, |s| s.driven_force) / r.model.domain.area()
}

fn normal_stress_top_mean(r: &Reading) -> f64 {
    r.wall_stress_mean(measure::top_wall(r.model))
}

/// NaN where nothing presses.
fn friction(r: &Reading) -> f64 {
    let normal = normal_stress_top_mean(r);
    if normal <= 0.0 {
        return f64::NAN;
    }
    shear_stress_top_mean(r) / normal
}

/// Zero without shear, whatever the load; NaN where grains are sheared and nothing presses.
/// With the mean normal stress: a stiff wall may carry nothing at an instant.
fn inertial_number(r: &Reading) -> f64 {
    let grains = &r.now.state.grains;
    let rate = measure::strain_rate(r.model, r.now).abs();
    if rate == 0.0 {
        return 0.0;
    }
    let normal = normal_stress_top_mean(r);
    if normal <= 0.0 {
        return f64::NAN;
    }
    let density = measure::grain_density(grains);
    rate * 2.0 * grains.mean_radius() * (density / normal).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::tests::snapshot;
    use super::*;
    use crate::measure::tests::model;
    use crate::{Model, Snapshot, Wall};
    use approx::assert_relative_eq;
    use glam::DVec3;

    fn read(name: &str, model: &Model, before: &Sums) -> f64 {
        let named = |s: &&Scalar| s.variable.name == name;
        snapshot().read(SERIES.iter().find(named).unwrap(), model, before)
    }

    #[test]
    fn stresses_are_forces_over_the_area_and_positive_under_shear_and_load() {
        let (model, none) = (model([3.0, 4.0]), Sums::default());
        assert_relative_eq!(read("shear_stress_top", &model, &none), 0.5);
        assert_relative_eq!(read("shear_stress_bottom", &model, &none), 0.5);
        assert_relative_eq!(read("normal_stress_top", &model, &none), 8.0 / 12.0);
        assert_relative_eq!(read("wall_height", &model, &none), 4.0);
        assert_relative_eq!(read("friction", &model, &none), 54.0 / 84.0);
        let lidless = Model {
            walls: model.walls[..1].to_vec(),
            ..model
        };
        assert!(read("normal_stress_top", &lidless, &none).is_nan());
        assert!(read("wall_height", &lidless, &none).is_nan());
        assert_relative_eq!(read("normal_stress_bottom", &lidless, &none), 8.0 / 12.0);
    }

    #[test]
    fn walls_feel_what_rubs_on_them() {
        let model = model([3.0, 4.0]);
        let mut now = snapshot();
        // The top wall holds its grain back, the bottom wall drags its own along.
        now.state.contacts[2].force = DVec3::new(-6.0, 3.0, -8.0);
        now.state.contacts[1].force = DVec3::new(2.4, 0.0, 8.0);
        let read = |name: &str| {
            let named = |s: &&Scalar| s.variable.name == name;
            now.read(SERIES.iter().find(named).unwrap(), &model, &now.sums)
        };
        assert_relative_eq!(read("wall_shear_stress_top_x"), 0.5);
        assert_relative_eq!(read("wall_shear_stress_top_y"), -0.25);
        assert_relative_eq!(read("wall_shear_stress_bottom_x"), -0.2);
        assert_eq!(read("wall_shear_stress_bottom_y"), 0.0);
    }

    #[test]
    fn means_run_over_the_steps_since_the_last_reading() {
        let model = model([3.0, 4.0]);
        let before = Sums {
            steps: 6,
            wall_force: vec![40.0, 44.0],
            held_force: 40.0,
            driven_force: -30.0,
        };
        let top = "shear_stress_top_mean";
        assert_relative_eq!(read(top, &model, &before), 24.0 / 4.0 / 12.0);
        assert_relative_eq!(read(top, &model, &Sums::default()), 54.0 / 10.0 / 12.0);
        let normal = "normal_stress_top_mean";
        assert_relative_eq!(read(normal, &model, &before), 40.0 / 4.0 / 12.0);
        // No step since: the instant.
        assert_relative_eq!(read(top, &model, &snapshot().sums), 0.5);
        assert_relative_eq!(read(normal, &model, &snapshot().sums), 8.0 / 12.0);
    }

    #[test]
    fn sums_that_were_not_kept_are_not_numbers() {
        let (mut model, none) = (model([3.0, 4.0]), Sums::default());
        assert_eq!(read("energy_residual", &model, &none), 1e-9);
        model.ledger = false;
        assert!(read("energy_residual", &model, &none).is_nan());
        assert_eq!(read("kinetic_energy", &model, &none), 0.0);
    }

    #[test]
    fn the_inertial_number_uses_the_diameter() {
        let mut now = snapshot();
        now.state.grains.constraint[1].horizontal = crate::Horizontal::Driven;
        now.state.grains.velocity[1].x = -0.4;
        let model = model([3.0, 4.0]);
        let named = |s: &&Scalar| s.variable.name == "inertial_number";
        let number = now.read(SERIES.iter().find(named).unwrap(), &model, &now.sums);
        // Rate 0.1 /s, diameter 2 m, density 1 kg/m³, stress 2/3 Pa.
        assert_relative_eq!(number, 0.1 * 2.0 * 1.5_f64.sqrt(), max_relative = 1e-14);

        // Nothing is sheared, nothing pressed.
        let unloaded = Snapshot {
            wall_force: vec![0.0, 0.0],
            ..snapshot()
        };
        let sums = unloaded.sums.clone();
        let number = unloaded.read(SERIES.iter().find(named).unwrap(), &model, &sums);
        assert_eq!(number, 0.0);
        let named = |s: &&Scalar| s.variable.name == "friction";
        let friction = unloaded.read(SERIES.iter().find(named).unwrap(), &model, &sums);
        assert!(friction.is_nan());
    }

    #[test]
    fn walls_are_told_by_their_normals_and_not_by_their_order() {
        let mut model = model([3.0, 4.0]);
        let top: Wall = model.walls.pop().unwrap();
        model.walls.insert(0, top);
        let mut now = snapshot();
        now.state.walls.reverse();
        now.wall_force = vec![9.0, 8.0];
        let named = |name| SERIES.iter().find(|s| s.variable.name == name).unwrap();
        let before = Sums::default();
        let height = now.read(named("wall_height"), &model, &before);
        assert_eq!(height, 4.0);
        let stress = now.read(named("normal_stress_top"), &model, &before);
        assert_relative_eq!(stress, 9.0 / 12.0);
    }
}
