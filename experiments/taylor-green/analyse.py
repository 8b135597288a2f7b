"""Decaying vortices against their exact solution: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
SPEED = 1e-3  # at the start [m/s]
DENSITY, VISCOSITY = 999.8, 1.792e-3 / 999.8  # [kg/m3], kinematic [m2/s]


def main():
    """Compare, print the errors, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    fluid = xarray.open_dataset(folder / "fluid.nc", decode_timedelta=False).isel(y=0)
    series = xarray.open_dataset(folder / "series.nc", decode_timedelta=False)
    wave = 2 * np.pi / float(fluid.x_bounds.max())

    last = fluid.isel(time=-1)
    u, w, p = exact(last, wave, float(last.time))
    scale = np.sqrt((u**2 + w**2).mean())
    difference = (last.velocity.sel(component="x") - u) ** 2 + (last.velocity.sel(component="z") - w) ** 2
    print(f"velocity at {float(last.time):.2f} s: {float(np.sqrt(difference.mean()) / scale):.1e} off")
    off = np.sqrt(((last.pressure - last.pressure.mean() - p) ** 2).mean() / (p**2).mean())
    print(f"pressure there: {float(off):.1e} off")
    settled = series.isel(time=series.time > 0.1)
    rate = -np.polyfit(settled.time, np.log(settled.kinetic_energy), 1)[0]
    print(f"viscosity from the decay of energy: {rate / (4 * wave**2 * VISCOSITY) - 1:+.1e} off")

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    figure.suptitle(fluid.attrs["title"])
    speed = 1e3 * np.hypot(last.velocity.sel(component="x"), last.velocity.sel(component="z"))
    edges = 1e3 * np.append(fluid.x_bounds[:, 0], fluid.x_bounds[-1, 1])
    drawn = left.pcolormesh(edges, edges, speed, cmap="viridis", vmin=0)
    step = slice(3, None, 6)
    arrows = last.isel(x=step, z=step)
    left.quiver(
        1e3 * arrows.x, 1e3 * arrows.z, arrows.velocity.sel(component="x"), arrows.velocity.sel(component="z"),
        color="w", width=0.005,
    )
    left.set(xlabel="x (mm)", ylabel="z (mm)", aspect="equal", title=f"at {float(last.time):.1f} s")
    figure.colorbar(drawn, ax=left, label="speed (mm/s)")

    fine = np.linspace(0, float(fluid.z_bounds.max()), 200)
    column = fluid.isel(x=0)
    for time, colour in zip((0, 0.3, 0.7, 1.5), plt.cm.viridis(np.linspace(0.1, 0.85, 4))):
        row = column.sel(time=time, method="nearest")
        now = SPEED * decay(wave, float(row.time))
        curve = now * np.cos(wave * float(row.x)) * np.sin(wave * fine)
        middle.plot(1e3 * curve, 1e3 * fine, color=colour, lw=1)
        middle.plot(
            1e3 * row.velocity.sel(component="x")[::3], 1e3 * row.z[::3], "o", ms=3.5, color=colour,
            label=f"{float(row.time):.1f} s",
        )
    middle.set(xlabel="velocity along x, at x = 0 (mm/s)", ylabel="z (mm)")
    middle.legend(loc="upper right")

    energy = series.kinetic_energy / series.kinetic_energy[0]
    right.semilogy(series.time, decay(wave, series.time) ** 2, "k", lw=1, label="exact")
    right.semilogy(series.time[::6], energy[::6], "o", ms=3.5, label="esker")
    right.set(xlabel="time (s)", ylabel="kinetic energy over that at the start")
    right.legend()
    for axes in (middle, right):
        axes.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def decay(wave, time):
    """What is left of the velocity after so long."""
    return np.exp(-2 * VISCOSITY * wave**2 * time)


def exact(cells, wave, time):
    """Velocity along x and z [m/s], and pressure [Pa]."""
    x, z = np.meshgrid(wave * cells.x.values, wave * cells.z.values)
    now = SPEED * decay(wave, time)
    pressure = -DENSITY * now**2 / 4 * (np.cos(2 * x) + np.cos(2 * z))
    return now * np.cos(x) * np.sin(z), -now * np.sin(x) * np.cos(z), pressure


main()
