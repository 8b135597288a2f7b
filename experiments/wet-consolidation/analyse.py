"""Pressure and shortening of a loaded bed against Terzaghi: python analyse.py RUN_FOLDER"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
PROBE, RELEASE, CONSOLIDATE = 2, 3, 4  # numbers of the phases
VISCOSITY = 1.8e-3  # [Pa s]
BEFORE, LOAD = 100e3, 10e3  # stress before, and what is added [Pa]
DIAMETER = 0.02  # [m]
TERMS = 200


def main():
    """Compare, print the differences, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    names = ("series", "fluid", "grains")
    whole, fluid, grains = (xarray.open_dataset(folder / f"{n}.nc", decode_timedelta=False) for n in names)
    series = whole.isel(time=(whole.phase == CONSOLIDATE).values)
    begin = float(whole.time[(whole.phase == RELEASE).values][-1])
    # Measured before the first step of the phase, and nothing fitted to it.
    report = json.loads(whole.attrs["coupling_consolidate"])
    height, storage = report["height"], report["storage"]
    loading, unloading = (inside(grains, phase, height) for phase in (PROBE, RELEASE))
    print(f"M of the whole bed {report['stiffness']:.3e} Pa; inside {loading:.3e} as it is loaded "
          f"and {unloading:.3e} as it is released")
    stiffness = unloading
    share, diffusivity = terzaghi(report, stiffness)
    first, unit = LOAD * share, height**2 / diffusivity
    print(f"S M = {storage * stiffness:.4f}, B = {share:.4f}, c_v = {diffusivity:.4f} m2/s, "
          f"H2/c_v = {unit:.4f} s")

    age, ages = (fluid.time - begin) / unit, (series.time - begin) / unit
    layers = fluid.pressure.mean(("x", "y"))
    # Between three diameters from the bottom and from the top: nearer, smooth walls make a softer bed.
    low, high = 3 * DIAMETER / height, 1 - 3 * DIAMETER / height
    start = grains.isel(time=((grains.phase == RELEASE).values).nonzero()[0][-1])
    moving = grains.isel(time=(grains.phase == CONSOLIDATE).values)
    shortened = sunk(start, moving, high * height) - sunk(start, moving, low * height)
    grain_age = ((moving.time - begin) / unit).values
    shortening = LOAD * height / stiffness * shares(low, high, share, grain_age)
    for wanted in (0.05, 0.1, 0.2):
        # A mean over a tenth of the age before and after.
        near = np.abs(age / wanted - 1) < 0.1
        found = float(layers.isel(z=0)[near].mean())
        theory = np.mean([first * pressure(float(fluid.z[0]), float(a)) for a in age[near]])
        late = np.abs(grain_age / wanted - 1) < 0.1
        ratio = float(shortened[late].mean()) / shortening[late].mean()
        print(f"T = {wanted:.2f}: pressure at the base {found / theory - 1:+.1%}, "
              f"shortening inside {ratio - 1:+.1%}")
    # The same instant, by the stiffness of the whole bed.
    other_share, other = terzaghi(report, report["stiffness"])
    ages_then = age[near] * other / diffusivity
    theory = np.mean([LOAD * other_share * pressure(float(fluid.z[0]), float(a)) for a in ages_then])
    print(f"there, against M of the whole bed: pressure at the base {found / theory - 1:+.1%}")

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.4), layout="constrained")
    figure.suptitle(whole.attrs["title"])
    fine = np.linspace(0, 1, 200)
    times = (0.01, 0.03, 0.06, 0.1, 0.2)
    for wanted, colour in zip(times, plt.cm.viridis(np.linspace(0.05, 0.85, len(times)))):
        near = np.abs(age / wanted - 1) < 0.1
        left.plot(first / 1e3 * pressure(fine, wanted), fine, color=colour, lw=1)
        left.plot(layers[near].mean("time") / 1e3, fluid.z, "o", ms=3.5, color=colour,
                  label=f"T = {wanted}")
    left.set(xlabel="pore pressure (kPa)", ylabel="height over that of the bed", xlim=(0, 1.1 * LOAD / 1e3))
    left.legend(fontsize="small", loc="lower left")
    middle.plot(grain_age, 1e6 * shortening, "k", lw=1, label="Terzaghi, inside")
    middle.plot(grain_age, 1e6 * shortened, "o", ms=2.5, color="C0", label="grains inside")
    top = float(whole.wall_height[(whole.phase == RELEASE).values][-1])
    middle.plot(ages, 1e6 * (top - series.wall_height), color="C7", lw=1, label="top wall")
    middle.set(xlabel="T = c$_v$ t / H²", ylabel="settlement (µm)", ylim=(0, None))
    middle.legend(loc="upper left")
    right.plot(ages, series.total_stress_bottom / 1e3, color="C7", lw=0.8, label="grains and water, bottom")
    right.plot(ages, series.effective_stress_bottom / 1e3, color="C1", lw=1, label="grains, bottom")
    theory = BEFORE + LOAD - first * np.array([pressure(0.0, a) for a in ages.values])
    right.plot(ages, theory / 1e3, "k", lw=1, label="Terzaghi")
    right.set(xlabel="T = c$_v$ t / H²", ylabel="normal stress (kPa)", ylim=(99, 115))
    right.legend(loc="center right")
    for panel in (left, middle, right):
        panel.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=100)
    print(f"drawn: {folder / 'figure.png'}")


def terzaghi(report, stiffness):
    """Share of the load that water takes at once, and diffusivity of pressure [m2/s]."""
    storage = report["storage"]
    diffusivity = report["permeability"] / VISCOSITY / (storage + 1 / stiffness)
    return 1 / (1 + storage * stiffness), diffusivity


def inside(grains, phase, height):
    """Stiffness from what grains away from the walls move in a phase that changes the load."""
    rows = [int(np.nonzero((grains.phase == p).values)[0][-1]) for p in (phase - 1, phase)]
    z = grains.position.sel(component="z").isel(time=rows[0]).values
    moved = grains.displacement.sel(component="z")
    moved = (moved.isel(time=rows[1]) - moved.isel(time=rows[0])).values
    # Rattlers fall as they like.
    held = (np.abs(moved) < 1e-4) & (z > 3 * DIAMETER) & (z < height - 3 * DIAMETER)
    return LOAD / abs(np.polyfit(z[held], moved[held], 1)[0])


def sunk(start, moving, level):
    """How far grains within a diameter of a level have sunk, the median of them."""
    z = start.position.sel(component="z")
    near = (np.abs(z - level) < DIAMETER).values
    moved = start.displacement.sel(component="z") - moving.displacement.sel(component="z")
    return moved.isel(grain=near).median("grain").values


def pressure(z, age):
    """p / p0 at heights z / H over the base."""
    m = np.pi * (2 * np.arange(TERMS) + 1) / 2
    terms = 2 / m * np.sin(np.multiply.outer(1 - np.asarray(z), m)) * np.exp(-(m**2) * max(age, 0))
    return terms.sum(axis=-1)


def shares(low, high, share, ages):
    """Shortening between two heights over that of the whole bed at last."""
    z = np.linspace(low, high, 201)
    return np.array([(high - low) * np.mean(1 - share * pressure(z, age)) for age in ages])


main()
