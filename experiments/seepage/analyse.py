"""A bed under rising water against Ergun and the weight of the grains: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
SOAK, RISE = 1, 2  # numbers of the phases
AREA = 6e-3**2  # [m2]
DIAMETER, DENSITY, GRAVITY = 1e-3, 2600.0, 9.81
WATER, VISCOSITY = 1000.0, 1e-3
TIMES, FLUXES = [0.4, 1.3, 1.4, 2.0], [0.0, 0.015, 0.015, 0.005]  # [s], [m/s]
LOW, HIGH = 5e-3, 20e-3  # where pressure is read: inside of the bed [m]


def main():
    """Compare, print the differences, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    names = ("series", "fluid", "grains")
    series, fluid, grains = (xarray.open_dataset(folder / f"{n}.nc", decode_timedelta=False) for n in names)
    soak, rise = (series.isel(time=(series.phase == p).values) for p in (SOAK, RISE))
    volume = float((4 / 3 * np.pi * grains.radius**3).sum())
    weight = volume * (DENSITY - WATER) * GRAVITY / AREA  # of the bed in water [Pa]

    moving = grains.isel(time=(grains.phase == SOAK).values)
    speed = np.sqrt((moving.velocity**2).sum("component")).max("grain").values
    print(f"at rest in water: fastest grain {speed[0]:.1e} m/s, {speed[-1]:.1e} m/s at the end; bottom bears "
          f"{float(soak.effective_stress_bottom[-1]) / weight - 1:+.2%} more than the buoyant weight; "
          f"pressure at the base {float(soak.pore_pressure_base[-1]):.1e} of {weight:.0f} Pa")

    fluid = fluid.isel(time=(fluid.phase == RISE).values)
    flux = np.interp(fluid.time, TIMES, FLUXES)
    z = fluid.z * float(series.wall_height[0])
    layers = fluid[["pressure", "porosity"]].mean(("x", "y")).assign_coords(z=z)
    inside = layers.sel(z=slice(LOW, HIGH))
    gradient = -inside.pressure.polyfit("z", 1).polyfit_coefficients.sel(degree=1).values
    porosity = inside.porosity.mean("z").values
    bears = (1 - porosity) * (DENSITY - WATER) * GRAVITY
    up = fluid.time.values <= TIMES[1]
    down = fluid.time.values >= TIMES[2]

    # Before: the law.
    fixed = up & (flux > 4e-3) & (flux < 8e-3)
    ratio = gradient[fixed] / ergun(porosity[fixed], flux[fixed])
    print(f"gradient of pressure over Ergun's from 4 to 8 mm/s: {ratio.mean():.3f} +- {ratio.std():.3f}")
    # The flux at which it bears the weight.
    first = int(np.nonzero(up & (gradient > bears))[0][0])
    share = (gradient - bears)[first - 1 : first + 1]
    onset = flux[first] - share[1] / (share[1] - share[0]) * (flux[first] - flux[first - 1])
    theory = least(porosity[first])
    print(f"the bed floats at {1e3 * onset:.2f} mm/s, by Ergun at its porosity of {porosity[first]:.3f} at "
          f"{1e3 * theory:.2f} mm/s: {onset / theory - 1:+.1%}")
    rising = np.interp(rise.time, TIMES, FLUXES)
    borne = rise.effective_stress_bottom / weight
    empty = float(rising[(borne < 0.01).values][0])
    print(f"the bottom bears less than a hundredth of the weight from {1e3 * empty:.2f} mm/s: {empty / theory - 1:+.1%}")
    floats = flux > 1.15 * theory
    print(f"afterwards gradient over weight {(gradient / bears)[floats].mean():.3f} +- "
          f"{(gradient / bears)[floats].std():.3f}")
    fluxes = np.linspace(5e-3, 15e-3, 2001)
    expanded = np.array([expansion(q) for q in fluxes])
    held = (fluid.time.values > 0.5 * (TIMES[1] + TIMES[2])) & ~down
    print(f"held at {1e3 * FLUXES[1]:.0f} mm/s: porosity {porosity[held].mean():.3f}, by Ergun {expansion(FLUXES[1]):.3f}")

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.4), layout="constrained")
    figure.suptitle(series.attrs["title"])
    for rows, colour, label in ((up, "C0", "flux rises"), (down, "C1", "flux falls")):
        left.plot(1e3 * flux[rows], gradient[rows] / 1e3, "o", ms=3, color=colour, label=label)
        middle.plot(1e3 * flux[rows], porosity[rows], "o", ms=3, color=colour, label=label)
    q = np.linspace(0, 12.5e-3, 100)
    left.plot(1e3 * q, ergun(porosity[fixed].mean(), q) / 1e3, "k", lw=1, label="Ergun, packed bed")
    left.plot(1e3 * flux, bears / 1e3, "k--", lw=1, label="weight in water")
    left.set(xlabel="flux (mm/s)", ylabel="gradient of pressure (kPa/m)", ylim=(0, 12))
    middle.plot(1e3 * fluxes[fluxes > theory], expanded[fluxes > theory], "k", lw=1, label="Ergun, floating")
    middle.set(xlabel="flux (mm/s)", ylabel="porosity inside of the bed")
    rises = rise.time.values <= TIMES[1]
    for rows, colour, label in ((rises, "C0", "flux rises"), (rise.time.values >= TIMES[2], "C1", "flux falls")):
        right.plot(1e3 * rising[rows], borne[rows], color=colour, lw=1, label=label)
    right.axvline(1e3 * theory, color="k", lw=1, ls="--", label="Ergun")
    right.set(xlabel="flux (mm/s)", ylabel="load on the bottom over the bed's weight", ylim=(-0.05, 1.15))
    for panel in (left, middle, right):
        panel.grid(alpha=0.3)
        panel.legend(fontsize="small")
    figure.savefig(folder / "figure.png", dpi=100)
    print(f"drawn: {folder / 'figure.png'}")


def ergun(porosity, flux):
    """Gradient of pressure in a bed of spheres [Pa/m]."""
    solid = 1 - porosity
    viscous = 150 * VISCOSITY * solid**2 / (porosity**3 * DIAMETER**2)
    return viscous * flux + 1.75 * WATER * solid / (porosity**3 * DIAMETER) * flux**2


def least(porosity):
    """Flux at which that is the weight of the grains [m/s]."""
    flux = np.linspace(0, 0.1, 100001)
    return float(flux[np.argmax(ergun(porosity, flux) > (1 - porosity) * (DENSITY - WATER) * GRAVITY)])


def expansion(flux):
    """Porosity at which a flux bears the grains."""
    porosity = np.linspace(0.3, 0.9, 60001)
    return float(porosity[np.argmax(ergun(porosity, flux) < (1 - porosity) * (DENSITY - WATER) * GRAVITY)])


main()
