//! `profiles.nc`: means over horizontal layers.

use super::catalogue::Profile;
use super::netcdf::{define, describe, label, put};
use super::rows::Rows;
use super::{Frame, OutputFile};
use anyhow::{Result, ensure};
use dem::measure::profile;
use dem::output::{Storage, Variable};
use ndarray::{Array, Array1};

/// Rows kept together.
const CHUNK: usize = 16;

const Z: Variable = Variable {
    name: "z",
    dims: &["z"],
    units: "m",
    long_name: "height of the middle of the layer",
    storage: Storage::Double,
};
const Z_BOUNDS: Variable = Variable {
    name: "z_bounds",
    dims: &["z", "bound"],
    units: "m",
    long_name: "heights between which the layer lies",
    storage: Storage::Double,
};

pub(super) struct ProfilesFile {
    rows: Rows,
    variables: Vec<Profile>,
    edges: Vec<f64>,
}

impl ProfilesFile {
    /// `rows` makes the file, given how many rows are kept together; `edges` [m] of the
    /// layers, ascending.
    pub fn create(
        rows: impl FnOnce(usize) -> Result<Rows>,
        variables: Vec<Profile>,
        edges: Vec<f64>,
    ) -> Result<Self> {
        let ascending = edges.len() >= 2 && edges.windows(2).all(|e| e[0] < e[1]);
        ensure!(
            ascending,
            "the layers need two or more ascending edges, not {edges:?}"
        );
        let layers = edges.len() - 1;
        let mut rows = rows(CHUNK)?;

        let file = &mut rows.file;
        label(file, "component", "component of a vector", &["x", "y", "z"])?;
        let face = "axis across which a stress acts";
        label(file, "face", face, &["x", "y", "z"])?;
        file.add_dimension("z", layers)?;
        file.add_dimension("bound", 2)?;
        for variable in [Z, Z_BOUNDS] {
            define(
                file,
                &variable,
                variable.dims,
                &[layers, 2][..variable.dims.len()],
            )?;
        }
        describe(file, "z", "bounds", "z_bounds")?;
        describe(file, "z", "axis", "Z")?;
        describe(file, "z", "positive", "up")?;
        let centres = Array1::from_vec(profile::centres(&edges)).into_dyn();
        put(file, &Z, &[0], &centres)?;
        let bounds = Array::from_shape_fn((layers, 2), |(l, side)| edges[l + side]);
        put(file, &Z_BOUNDS, &[0, 0], &bounds.into_dyn())?;

        for profile in &variables {
            let chunk = [CHUNK, layers, 3, 3];
            let variable = profile.variable();
            rows.define(variable, &chunk[..=variable.dims.len()])?;
        }
        Ok(Self {
            rows,
            variables,
            edges,
        })
    }
}

impl OutputFile for ProfilesFile {
    fn write(&mut self, frame: &Frame) -> Result<()> {
        self.rows.begin(frame)?;
        for profile in &self.variables {
            let values = profile.read(frame, &self.edges);
            self.rows.array(profile.variable(), &values)?;
        }
        self.rows.end();
        Ok(())
    }

    fn sync(&mut self) -> Result<()> {
        self.rows.sync()
    }
}
