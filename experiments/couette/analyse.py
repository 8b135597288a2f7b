"""Flow below a moving plate against the exact profile and its start: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
SPEED = 1e-3  # of the plate [m/s]
VISCOSITY = 1.792e-3 / 999.8  # kinematic [m2/s]
TERMS = 400  # of the series for the start


def main():
    """Compare, print the errors, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    fluid = xarray.open_dataset(folder / "fluid.nc", decode_timedelta=False)
    velocity = fluid.velocity.sel(component="x").isel(x=0, y=0)
    height = float(fluid.z_bounds.max())

    errors = [
        np.abs(row - exact(fluid.z.values, float(row.time), height)).max() / SPEED for row in velocity[1:]
    ]
    print(f"steady: {float(errors[-1]):.1e} of the plate's speed (the file keeps single precision, 6e-8)")
    print(f"start, after 10 ms: {float(errors[0]):.1e}; after 50 ms: {float(errors[4]):.1e}")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    figure.suptitle(fluid.attrs["title"])
    fine = np.linspace(0, height, 200)
    times = (0.01, 0.03, 0.06, 0.12, float(fluid.time[-1]))
    for time, colour in zip(times, plt.cm.viridis(np.linspace(0.1, 0.85, len(times)))):
        row = velocity.sel(time=time, method="nearest")
        left.plot(1e3 * exact(fine, float(row.time), height), 1e3 * fine, color=colour, lw=1)
        label = f"{1e3 * float(row.time):.0f} ms" if time < 1 else "steady"
        left.plot(1e3 * row, 1e3 * fluid.z, "o", ms=3.5, color=colour, label=label)
    left.set(xlabel="velocity (mm/s)", ylabel="height over the plate at rest (mm)")
    left.legend(title="after", loc="lower right")
    right.semilogy(1e3 * fluid.time[1:], errors, ".-", lw=0.8)
    right.set(xlabel="time (ms)", ylabel="greatest error, over the plate's speed")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def exact(z, time, height):
    """Velocity at height z [m] so long after the plate was set in motion [m/s]."""
    u = SPEED * z / height
    for n in range(1, TERMS):
        k = n * np.pi / height
        u += 2 * SPEED / np.pi * (-1) ** n / n * np.sin(k * z) * np.exp(-VISCOSITY * k**2 * time)
    return u


main()
