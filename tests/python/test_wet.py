"""Does xarray open what a run with water between its grains writes, and know its axes?"""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import xarray

from conftest import run_of
from labels import check_labels, check_variable

HERE = Path(__file__).parent

SERIES = {
    "pore_pressure_mean": "Pa",
    "pore_pressure_base": "Pa",
    "pore_pressure_top": "Pa",
    "effective_stress_top": "Pa",
    "effective_stress_bottom": "Pa",
    "total_stress_top": "Pa",
    "total_stress_bottom": "Pa",
    "friction_total": "1",
    "darcy_flux_base": "m s-1",
    "darcy_flux_top": "m s-1",
    "water_volume": "m3",
    "water_left_bottom": "m3",
    "water_left_top": "m3",
    "vapour_volume": "m3",
    "elastic_energy_water": "J",
    "kinetic_energy_water": "J",
    "work_water": "J",
    "work_walls_water": "J",
    "work_sides_water": "J",
    "dissipated_darcy": "J",
    "dissipated_method_water": "J",
    "dissipated_loose": "J",
    "energy_residual_water": "J",
    "rattlers": "1",
    "solid_fraction_drift": "1",
}
PROFILES = {"pore_pressure": "Pa", "darcy_flux": "m s-1"}
FLUID = {
    "pressure": (("time", "z", "y", "x"), "Pa"),
    "darcy_flux": (("time", "z", "y", "x", "component"), "m s-1"),
    "porosity": (("time", "z", "y", "x"), "1"),
    "vapour": (("time", "z", "y", "x"), "m3"),
    "height": (("time",), "m"),
}


@pytest.fixture(scope="module")
def wet(tmp_path_factory):
    """The files of a run of wet.toml."""
    folder = run_of("wet.toml", tmp_path_factory.mktemp("run") / "wet")
    names = ("series", "profiles", "grains", "fluid")
    return {n: xarray.open_dataset(folder / f"{n}.nc", decode_timedelta=False) for n in names}


def test_series_say_what_the_water_does(wet):
    series = wet["series"]
    pressed = series.phase == 0
    for name, units in SERIES.items():
        variable = series[name]
        check_variable(variable, ("time",), units)
        # A dry phase has none.
        assert variable[pressed].isnull().all(), name
        assert variable[~pressed].notnull().all(), name
    check_labels(series)


def test_the_energy_of_grains_and_water_is_found(wet):
    series = wet["series"].isel(time=wet["series"].phase > 0).groupby("phase").last()
    work = abs(series.work_water) + abs(series.work_drive) + abs(series.work_walls)
    assert (abs(series.energy_residual) < 1e-3 * work).all()
    assert (abs(series.energy_residual_water) < 1e-2 * abs(series.work_water)).all()


def test_profiles_have_the_water_beside_the_grains(wet):
    profiles = wet["profiles"]
    height = wet["series"].wall_height.reindex(time=profiles.time, method="nearest")
    inside = profiles.z < height
    assert inside.any() and not inside.all()
    for name, units in PROFILES.items():
        variable = profiles[name]
        check_variable(variable, ("time", "z"), units)
        soaked = (profiles.phase > 0) & inside
        assert (variable.notnull() == soaked).all(), name
    check_labels(profiles)
    # What drains at the top flows there, and little at the tight base.
    last = profiles.isel(time=-1)
    assert abs(float(last.darcy_flux[0])) < 0.5 * float(abs(last.darcy_flux).max())


def test_what_leaves_is_what_the_pores_lose(wet):
    series = wet["series"]
    loaded = series.isel(time=(series.phase == 1).values)
    lost = float(loaded.water_volume[0] - loaded.water_volume[-1])
    left = float(loaded.water_left_top[-1] - loaded.water_left_top[0])
    assert lost > 0 and abs(left / lost - 1) < 0.01
    assert (loaded.water_left_bottom == 0).all()


def test_cells_lie_between_the_walls(wet):
    fluid = wet["fluid"]
    for name, (dimensions, units) in FLUID.items():
        variable = fluid[name]
        check_variable(variable, dimensions, units)
        assert variable.notnull().all(), name
    assert fluid.sizes["x"] == fluid.sizes["y"] == 2 and fluid.sizes["z"] > 3
    assert (np.diff(fluid.z) > 0).all() and 0 < fluid.z[0] < fluid.z[-1] < 1
    assert fluid.z.attrs["units"] == "1" and fluid.x.attrs["units"] == "m"
    check_labels(fluid)
    assert set(fluid.phase.values) == {1, 2}
    heights = wet["series"].wall_height.sel(time=fluid.time[-1])
    assert float(fluid.height[-1]) == float(heights)


def test_attributes_tell_the_numbers_of_the_coupling(wet):
    for name in ("series", "fluid"):
        attributes = wet[name].attrs
        assert "coupling_press" not in attributes
        load, shear = (json.loads(attributes[f"coupling_{p}"]) for p in ("load", "shear"))
        assert load["interval"] >= 1 and 0 < load["D_n"]
        assert 0 < load["stiffness"] == shear["stiffness"]
        assert load["B"] == pytest.approx(1 / (1 + load["S_M"]))
        assert load["deborah"] == 0 < shear["deborah"]


def test_check_tells_what_is_known(tmp_path):
    command = [os.environ["ESKER"], "check", HERE / "wet.toml"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for words in ("2 x 2 x ", "permeability", "storage S", "dry", "top at 0", "Deborah"):
        assert words in done.stdout, done.stdout
