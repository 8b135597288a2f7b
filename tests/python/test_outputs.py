"""Does xarray open what a run writes, and know its axes?"""

import os
import subprocess

import numpy as np
import pytest
import xarray

from labels import check_labels, check_variable

FILES = ("series", "profiles", "grains", "contacts")

# What users and later versions rely on: names, dimensions and units.
VARIABLES = {
    "series": {
        "strain": (("time",), "1"),
        "shear_stress_top": (("time",), "Pa"),
        "shear_stress_bottom": (("time",), "Pa"),
        "normal_stress_top": (("time",), "Pa"),
        "wall_height": (("time",), "m"),
        "dilation": (("time",), "1"),
        "solid_fraction": (("time",), "1"),
        "coordination_number": (("time",), "1"),
        "inertial_number": (("time",), "1"),
    },
    "profiles": {
        "velocity": (("time", "z", "component"), "m s-1"),
        "solid_fraction": (("time", "z"), "1"),
        "stress": (("time", "z", "component", "face"), "Pa"),
        "strain_rate": (("time", "z"), "s-1"),
        "angular_velocity": (("time", "z", "component"), "rad s-1"),
    },
    "grains": {
        "position": (("time", "grain", "component"), "m"),
        "displacement": (("time", "grain", "component"), "m"),
        "velocity": (("time", "grain", "component"), "m s-1"),
        "angular_velocity": (("time", "grain", "component"), "rad s-1"),
        "force": (("time", "grain", "component"), "N"),
        "pressure": (("time", "grain"), "Pa"),
        "coordination_number": (("time", "grain"), "1"),
    },
    "contacts": {
        "pair": (("contact", "member"), "1"),
        "force": (("contact", "component"), "N"),
        "overlap": (("contact",), "m"),
        "branch": (("contact", "component"), "m"),
        "sliding": (("contact",), "1"),
    },
}

# Every entry of the energy ledger, in J.
LEDGER = (
    "kinetic_energy",
    "rotational_energy",
    "elastic_energy_normal",
    "elastic_energy_tangential",
    "elastic_energy_rolling",
    "dissipated_friction",
    "dissipated_viscosity",
    "dissipated_rolling",
    "work_walls",
    "work_drive",
    "work_gravity",
    "energy_residual",
)
VARIABLES["series"] |= {name: (("time",), "J") for name in LEDGER}


@pytest.mark.parametrize(
    ("file", "name"), [(file, name) for file in VARIABLES for name in VARIABLES[file]]
)
def test_variable_is_there_with_its_dimensions_and_units(files, file, name):
    check_variable(files[file][name], *VARIABLES[file][name])


@pytest.mark.parametrize("file", FILES)
def test_everything_has_a_long_name_and_units(files, file):
    check_labels(files[file])


@pytest.mark.parametrize("file", FILES)
def test_a_plain_open_gives_time_in_float_seconds(run, file):
    if tuple(map(int, xarray.__version__.split(".")[:2])) < (2026, 0):
        pytest.skip("xarray before 2026 decodes seconds to timedelta unless told otherwise")
    with xarray.open_dataset(run / f"{file}.nc") as data:
        time = data.time
        assert time.dtype == np.float64
        assert time.attrs["units"] == "s"
        assert (np.diff(time) > 0).all()


@pytest.mark.parametrize("file", FILES)
def test_no_value_of_the_sheared_bed_is_missing_or_infinite(files, file):
    # Before, a wall that nothing touches yet has no friction; above the bed nothing
    # has a velocity.
    data = files[file]
    sheared = data.isel(time=(data.phase == 1).values)
    assert sheared.sizes["time"] > 1
    if file == "profiles":
        sheared = sheared.isel(z=(sheared.solid_fraction > 0).all("time").values)
        assert sheared.sizes["z"] > 3
    for name, variable in sheared.variables.items():
        if variable.dtype.kind == "f":
            finite = np.isfinite(variable)
            # Both are ratios to the load; a wall that bounces has none for a while.
            if name in ("friction", "inertial_number"):
                finite = finite | (sheared.normal_stress_top_mean <= 0)
            assert finite.all(), name


@pytest.mark.parametrize("file", FILES)
def test_attributes_tell_where_the_file_comes_from(files, file):
    attributes = files[file].attrs
    for name in ("title", "scene", "version", "commit", "seed", "machine"):
        assert name in attributes, name
    assert "[[phase]]" in attributes["scene"]


def test_the_scene_in_a_file_is_a_scene(files, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(files["series"].attrs["scene"])
    command = [os.environ["ESKER"], "check", scene]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "phase shear" in done.stdout


@pytest.mark.parametrize("file", FILES)
def test_phase_and_strain_are_coordinates(files, file):
    coordinates = files[file].coords
    assert coordinates["strain"].dims == coordinates["phase"].dims == ("time",)
    assert coordinates["phase"].attrs["flag_meanings"].split() == ["consolidate", "shear"]
    assert list(coordinates["phase"].attrs["flag_values"]) == [0, 1]


def test_rows_of_contacts_are_counted(files):
    contacts = files["contacts"]
    count, offset = contacts["count"].values, contacts["offset"].values
    assert contacts.sizes["contact"] == count.sum()
    assert (offset == np.cumsum(count) - count).all()
    # Each pair is there once, and a grain is never its own partner.
    for first, number in zip(offset, count):
        pair = contacts.pair.values[first : first + number]
        assert len(np.unique(pair, axis=0)) == number
        assert (pair[:, 0] != pair[:, 1]).all()


def test_vectors_are_labelled_by_component(files):
    for file in ("profiles", "grains", "contacts"):
        assert list(files[file].component.values) == ["x", "y", "z"]


def test_profiles_lie_along_z(files):
    z = files["profiles"].z
    assert z.attrs["units"] == "m"
    assert (np.diff(z) > 0).all()
