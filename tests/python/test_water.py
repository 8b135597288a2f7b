"""Does xarray open what a run of water writes, and know its axes?"""

import os
import subprocess

import numpy as np
import pytest

from labels import check_labels, check_variable

# What users and later versions rely on: names, dimensions and units.
VARIABLES = {
    "series": {
        "flux_z": (("time",), "m s-1"),
        "pressure_drop_z": (("time",), "Pa"),
        "permeability_z": (("time",), "m2"),
        "pressure_bottom": (("time",), "Pa"),
        "pressure_top": (("time",), "Pa"),
        "speed_max": (("time",), "m s-1"),
        "content": (("time",), "m3"),
    },
    "fluid": {
        "pressure": (("time", "z", "y", "x"), "Pa"),
        "darcy_flux": (("time", "z", "y", "x", "component"), "m s-1"),
        "porosity": (("z", "y", "x"), "1"),
    },
}


@pytest.mark.parametrize(
    ("file", "name"), [(file, name) for file in VARIABLES for name in VARIABLES[file]]
)
def test_variable_is_there_with_its_dimensions_and_units(water, file, name):
    check_variable(water[file][name], *VARIABLES[file][name])


@pytest.mark.parametrize("file", VARIABLES)
def test_everything_has_a_long_name_and_units(water, file):
    check_labels(water[file])


@pytest.mark.parametrize("file", VARIABLES)
def test_attributes_tell_where_the_file_comes_from(water, file):
    attributes = water[file].attrs
    for name in ("title", "scene", "version", "commit", "machine", "backend", "device"):
        assert name in attributes, name
    assert "[water]" in attributes["scene"]


def test_cells_lie_along_their_axes(water):
    fluid = water["fluid"]
    assert fluid.sizes["x"] == 4 and fluid.sizes["y"] == 3 and fluid.sizes["z"] == 8
    for axis in "xyz":
        cells, bounds = fluid[axis], fluid[f"{axis}_bounds"]
        assert cells.attrs["units"] == "m" and cells.attrs["axis"] == axis.upper()
        assert np.allclose(bounds.mean("bound"), cells)
        assert np.allclose(np.diff(cells), 1e-3)
    assert list(fluid.component.values) == ["x", "y", "z"]
    assert (np.diff(fluid.time) > 0).all() and fluid.sizes["time"] >= 5


def test_values_stand_where_their_cells_are(water):
    fluid = water["fluid"]
    solid = fluid.porosity == 0
    # The grain fills the cells around its middle, on the edge of four of them.
    assert int(solid.sum()) == 4
    assert bool(solid.sel(x=2e-3, y=1.5e-3, z=4e-3, method="nearest"))
    layers = fluid.porosity.where(~solid).mean(("x", "y"))
    assert np.allclose(layers, [0.3] * 4 + [0.5] * 4)
    last = fluid.isel(time=-1)
    assert last.pressure.isnull().equals(solid) or bool((last.pressure.isnull() == solid).all())
    # Water comes in at the bottom, where pressure is high.
    mean = last.pressure.mean(("x", "y"))
    assert mean[0] > 500 and mean[0] > mean[4] > mean[7]
    assert float(last.darcy_flux.sel(component="z").isel(z=0).mean()) > 0


def test_the_scene_in_a_file_is_a_scene(water, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(water["fluid"].attrs["scene"])
    command = [os.environ["ESKER"], "check", scene]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for word in ("acoustic", "sigma", "tau", "cells2 a step", "porosity", "run time"):
        assert word in done.stdout, word
