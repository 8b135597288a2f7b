"""Drainage of a column against Terzaghi's series: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
START = 1e4  # pressure at the start [Pa]
PERMEABILITY, POROSITY = 1e-15, 0.4  # [m2], [-]
VISCOSITY, COMPRESSIBILITY = 1.792e-3, 5.09e-10  # [Pa s], [1/Pa]
TERMS = 200


def main():
    """Compare, print the errors, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    fluid = xarray.open_dataset(folder / "fluid.nc", decode_timedelta=False).isel(x=0, y=0)
    series = xarray.open_dataset(folder / "series.nc", decode_timedelta=False)
    height = float(fluid.z_bounds.max())
    diffusivity = PERMEABILITY / (VISCOSITY * POROSITY * COMPRESSIBILITY)
    age = diffusivity * fluid.time / height**2
    depth = fluid.z / height
    for wanted in (0.05, 0.2, 1.0):
        row = int(np.abs(age.values - wanted).argmin())
        known = pressure(depth.values, float(age[row]))
        error = np.sqrt(((fluid.pressure[row] / START - known) ** 2).sum() / (known**2).sum())
        print(f"T = {float(age[row]):.3f}: pressure {float(error):.1e} off")
    ages = diffusivity * series.time / height**2
    drained = 1 - series.content / series.content[0]
    known = degree(ages.values)
    print(f"degree of consolidation: at most {float(np.abs(drained - known)[1:].max()):.1e} off")
    half = float(np.interp(0.5, drained, ages))
    print(f"half drained at T = {half:.4f}, Terzaghi 0.1968")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
    figure.suptitle(fluid.attrs["title"])
    fine = np.linspace(0, 1, 200)
    times = (0.05, 0.1, 0.2, 0.4, 0.7, 1.0)
    for wanted, colour in zip(times, plt.cm.viridis(np.linspace(0.1, 0.85, len(times)))):
        row = int(np.abs(age.values - wanted).argmin())
        left.plot(START / 1e3 * pressure(fine, float(age[row])), fine * height, color=colour, lw=1)
        left.plot(fluid.pressure[row] / 1e3, fluid.z, "o", ms=3.5, color=colour,
                  label=f"{float(fluid.time[row]):.0f} s, T = {float(age[row]):.2f}")
    left.set(xlabel="pressure beyond that at rest (kPa)", ylabel="height over the tight base (m)", xlim=(0, 14.5))
    left.legend(fontsize="small", loc="center right")
    right.plot(series.time, 100 * known, "k", lw=1, label="Terzaghi")
    right.plot(series.time[::12], 100 * drained[::12], "o", ms=3.5, label="esker")
    right.set(xlabel="time (s)", ylabel="water that has left, of what will (%)", ylim=(0, 100))
    right.legend(loc="lower right")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def pressure(z, age):
    """p / p0 at the height z / H over the base."""
    m = np.pi * (2 * np.arange(TERMS)[:, None] + 1) / 2
    return (2 / m * np.sin(m * (1 - z)) * np.exp(-(m**2) * age)).sum(axis=0)


def degree(age):
    """Part of the water that has left."""
    m = np.pi * (2 * np.arange(TERMS)[:, None] + 1) / 2
    return 1 - (2 / m**2 * np.exp(-(m**2) * age)).sum(axis=0)


main()
