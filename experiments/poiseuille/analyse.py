"""Flow between plates against the exact parabola and its start: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
GRAVITY = 0.01  # body force over density [m/s2]
VISCOSITY = 1.792e-3 / 999.8  # kinematic [m2/s]
TERMS = 200  # of the series for the start


def main():
    """Compare, print the errors, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    fluid = xarray.open_dataset(folder / "fluid.nc", decode_timedelta=False)
    series = xarray.open_dataset(folder / "series.nc", decode_timedelta=False)
    velocity = fluid.velocity.sel(component="x").isel(x=0, y=0)
    height = float(fluid.z_bounds.max())

    steady = exact(fluid.z.values, np.inf, height)
    error = np.abs(velocity.isel(time=-1) - steady).max() / steady.max()
    print(f"steady: {float(error):.1e} of the fastest flow (the file keeps single precision, 6e-8)")
    mean = flux(series.time.values, height)
    late = series.time > 0.01
    start = np.abs(series.flux_x - mean)[late].max() / mean[-1]
    print(f"start, from 10 ms on: mean flux off by at most {float(start):.1e} of the steady one")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    figure.suptitle(fluid.attrs["title"])
    fine = np.linspace(0, height, 200)
    times = (0.02, 0.04, 0.08, 0.16, float(fluid.time[-1]))
    for time, colour in zip(times, plt.cm.viridis(np.linspace(0.1, 0.85, len(times)))):
        row = velocity.sel(time=time, method="nearest")
        left.plot(1e3 * exact(fine, float(row.time), height), 1e3 * fine, color=colour, lw=1)
        label = f"{1e3 * float(row.time):.0f} ms" if time < 1 else "steady"
        left.plot(1e3 * row, 1e3 * fluid.z, "o", ms=3.5, color=colour, label=label)
    left.set(xlabel="velocity (mm/s)", ylabel="height between the plates (mm)", xlim=(0, 1))
    left.legend(title="after", loc="center right")
    right.plot(1e3 * series.time, 1e3 * mean, "k", lw=1, label="exact")
    right.plot(1e3 * series.time[::4], 1e3 * series.flux_x[::4], "o", ms=3.5, label="esker")
    right.set(xlabel="time (ms)", ylabel="mean velocity (mm/s)", xlim=(0, 300), ylim=(0, None))
    right.legend(loc="lower right")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def exact(z, time, height):
    """Velocity at height z [m] so long after the start [m/s]."""
    u = GRAVITY / (2 * VISCOSITY) * z * (height - z)
    for n in np.arange(1, TERMS, 2):
        k = n * np.pi / height
        u -= 4 * GRAVITY / (VISCOSITY * height * k**3) * np.sin(k * z) * np.exp(-VISCOSITY * k**2 * time)
    return u


def flux(time, height):
    """Mean of the velocity from plate to plate [m/s]."""
    mean = np.full(len(time), GRAVITY * height**2 / (12 * VISCOSITY))
    for n in np.arange(1, TERMS, 2):
        k = n * np.pi / height
        mean -= 8 * GRAVITY / (VISCOSITY * height**2 * k**4) * np.exp(-VISCOSITY * k**2 * time)
    return mean


main()
