"""Settling grains, alone and together, against the drag law: python analyse.py RUN_FOLDER..."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
AREA = 8e-3**2  # [m2]
DIAMETER, DENSITY, GRAVITY = 1e-3, 2600.0, 9.81
WATER, VISCOSITY = 1000.0, 1e-3
FROM, TO = 0.08, 0.12  # when a suspension is measured [s]


def main():
    """Compare, print, draw figure.png into the last folder."""
    single = settling(0.0)
    reynolds = WATER * single * DIAMETER / VISCOSITY
    zaki = 4.45 * reynolds**-0.1
    print(f"Di Felice: one grain at {single:.4f} m/s, Re {reynolds:.0f}; Richardson and Zaki: exponent {zaki:.2f}")
    alone, together = [], []
    for folder in sys.argv[1:]:
        grains, series, fluid = (
            xarray.open_dataset(Path(folder) / f"{n}.nc", decode_timedelta=False) for n in ("grains", "series", "fluid")
        )
        spacing = float(fluid.x[1] - fluid.x[0]) if fluid.sizes["x"] > 1 else None
        if grains.sizes["grain"] == 1:
            alone.append(lone(grains, spacing, single, folder))
        else:
            together.append(crowd(grains, series, single))
    if together:
        c, v, error = (np.array(each) for each in zip(*sorted(together)))
        slope = np.polyfit(np.log(1 - c), np.log(v), 1)[0]
        through = float((np.log(v) @ np.log(1 - c)) / (np.log(1 - c) @ np.log(1 - c)))
        print(f"exponent {slope:.2f} ({slope / zaki - 1:+.1%}); through the single grain {through:.2f} ({through / zaki - 1:+.1%})")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
    figure.suptitle("Coarse sand settles in clear water")
    for time, velocity, label in alone:
        left.plot(1e3 * time, 1e3 * velocity, lw=1.2, label=label)
    time, velocity = start()
    left.plot(1e3 * time, 1e3 * velocity, "k--", lw=1, label="law, in water that stands")
    left.set(xlabel="time (ms)", ylabel="velocity of one grain (mm/s)", xlim=(0, 150))
    if together:
        right.errorbar(1 - c, v, error, fmt="o", ms=4, color="C0", label="suspensions")
    fine = np.linspace(0.6, 1, 100)
    right.plot(fine, [settling(1 - phi) / single for phi in fine], "k", lw=1, label="Di Felice")
    right.plot(fine, fine**zaki, "C3--", lw=1, label=f"Richardson and Zaki, n = {zaki:.2f}")
    right.set(xlabel="porosity", ylabel="velocity over that of one grain", xscale="log", yscale="log")
    ticks = [0.6, 0.7, 0.8, 0.9, 1.0]
    right.set_xticks(ticks, ticks)
    right.set_xticks([], minor=True)
    ticks = [0.2, 0.3, 0.4, 0.6, 0.8, 1.0]
    right.set_yticks(ticks, ticks)
    right.set_yticks([], minor=True)
    for panel in (left, right):
        panel.grid(alpha=0.3)
        panel.legend(fontsize="small")
    target = Path(sys.argv[-1]) / "figure.png"
    figure.savefig(target, dpi=100)
    print(f"drawn: {target}")


def lone(grains, spacing, single, folder):
    """One grain: its velocity, and how far it is from the law once it is steady."""
    z = grains.position.sel(component="z").isel(grain=0).values
    velocity = -grains.velocity.sel(component="z").isel(grain=0).values
    # From 25 diameters of way to a few above the ground.
    steady = (z < z[0] - 25 * DIAMETER) & (z > 5 * DIAMETER)
    way = z[steady][0] - z[steady][-1]
    mean = way / float(grains.time[steady][-1] - grains.time[steady][0])
    label = f"cells of {1e3 * spacing:.0f} d" if spacing else "one cell across"
    print(f"{folder}: one grain, {label}: {mean / single - 1:+.2%}, "
          f"unsteady by {velocity[steady].std() / single:.2%}")
    return grains.time.values, velocity, label


def crowd(grains, series, single):
    """A suspension: solid fraction and velocity in the middle, and the spread of its mean in time."""
    height = float(series.wall_height[0])
    volume = np.pi / 6 * DIAMETER**3
    chosen = grains.isel(time=((grains.time >= FROM) & (grains.time <= TO)).values)
    z, velocity = chosen.position.sel(component="z"), -chosen.velocity.sel(component="z")
    middle = (z > 0.35 * height) & (z < 0.65 * height)
    count = middle.sum("grain")
    solid = float(count.mean()) * volume / (0.3 * height * AREA)
    each = (velocity.where(middle).sum("grain") / count).values
    law = settling(solid)
    print(f"solid fraction {solid:.3f}: {each.mean() / single:.4f} of a single grain's velocity, by the law "
          f"{law / single:.4f} ({each.mean() / law - 1:+.1%})")
    return solid, each.mean() / single, each.std() / single


def drag(solid, flux):
    """R q of Di Felice over the solid fraction [Pa/m]."""
    phi = 1 - solid
    reynolds = max(WATER * flux * DIAMETER / VISCOSITY, 1e-9)
    exponent = 3.7 - 0.65 * np.exp(-0.5 * (1.5 - np.log10(reynolds)) ** 2)
    coefficient = (0.63 + 4.8 / np.sqrt(reynolds)) ** 2
    force = 0.5 * WATER * coefficient * np.pi / 4 * DIAMETER**2 * flux**2 * phi**-exponent
    return force / (phi * np.pi / 6 * DIAMETER**3)


def settling(solid):
    """Velocity in a closed box [m/s], where the flux against the grains is that of the grains."""
    low, high = 0.0, 1.0
    for _ in range(60):
        flux = 0.5 * (low + high)
        low, high = (flux, high) if drag(solid, flux) < (DENSITY - WATER) * GRAVITY else (low, flux)
    return low


def start():
    """Velocity of one grain that begins to fall, in water that does not move."""
    step, time, velocity = 1e-4, [0.0], [0.0]
    for _ in range(1500):
        push = (DENSITY - WATER) * GRAVITY - drag(0.0, velocity[-1])
        velocity.append(velocity[-1] + step * push / DENSITY)
        time.append(time[-1] + step)
    return np.array(time), np.array(velocity)


main()
