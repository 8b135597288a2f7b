"""Permeability of a packing against Kozeny-Carman and van der Hoef et al.: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

VISCOSITY = 1.792e-3 / 999.8  # kinematic [m2/s]
GRAVITY = 0.01  # body force over density [m/s2]
HERE = Path(__file__).resolve().parent


def main():
    """Compare, print the numbers, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    fluid = xarray.open_dataset(folder / "fluid.nc", decode_timedelta=False)
    series = xarray.open_dataset(folder / "series.nc", decode_timedelta=False)
    porosity = float(fluid.porosity.mean())
    diameter = sauter(HERE / "bed.csv")
    found = float(series.permeability_x[-1])
    print(f"porosity of the voxels {porosity:.4f}, mean diameter {1e3 * diameter:.4f} mm")
    print(f"permeability {found:.4e} m2")
    laws = {"Kozeny-Carman": kozeny_carman, "van der Hoef et al.": van_der_hoef}
    for name, law in laws.items():
        known = law(porosity, diameter)
        print(f"{name}: {known:.4e} m2; found {100 * (found / known - 1):+.1f} %")

    figure, (left, middle, right) = plt.subplots(
        1, 3, figsize=(14, 4.3), layout="constrained", width_ratios=(1.25, 1, 1)
    )
    figure.suptitle(fluid.attrs["title"])
    last = fluid.isel(time=-1)
    middle_of = last.isel(y=last.sizes["y"] // 2)
    speed = 1e6 * np.sqrt((middle_of.velocity**2).sum("component", skipna=False))
    edges = [1e3 * np.append(fluid[f"{a}_bounds"][:, 0], fluid[f"{a}_bounds"][-1, 1]) for a in "xz"]
    left.set_facecolor("0.75")
    drawn = left.pcolormesh(*edges, speed, cmap="viridis", vmin=0, vmax=float(speed.quantile(0.995)))
    left.set(xlabel="x (mm), along the flow", ylabel="z (mm)", aspect="equal", title="a cut through the middle")
    figure.colorbar(drawn, ax=left, label="speed (µm/s); grains are grey", extend="max")

    middle.plot(1e3 * series.time, 1e9 * series.permeability_x, label="esker")
    for (name, law), style in zip(laws.items(), ("--", ":")):
        middle.axhline(1e9 * law(porosity, diameter), color="k", lw=1, ls=style, label=name)
    middle.set(xlabel="time (ms)", ylabel="permeability (10⁻⁹ m²)", ylim=(0, None))
    middle.legend(fontsize="small", loc="lower right")

    range_of = np.linspace(0.3, 0.5, 100)
    for (name, law), style in zip(laws.items(), ("--", ":")):
        right.plot(range_of, 1e9 * law(range_of, diameter), "k", lw=1, ls=style, label=name)
    right.plot(porosity, 1e9 * found, "o", label="esker")
    right.set(ylim=(0, None), xlabel="porosity", ylabel="permeability of 1 mm grains (10⁻⁹ m²)")
    right.legend(fontsize="small", loc="upper left")
    for axes in (middle, right):
        axes.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def sauter(bed):
    """Diameter of grains of one size with the same volume for their surface [m]."""
    lines = [line for line in bed.read_text().splitlines() if not line.startswith("#")]
    radius = np.array([float(line.split(",")[3]) for line in lines[1:]])
    return 2 * (radius**3).sum() / (radius**2).sum()


def kozeny_carman(porosity, diameter):
    """Carman (1937), Trans. Inst. Chem. Eng. 15, 150."""
    return diameter**2 * porosity**3 / (180 * (1 - porosity) ** 2)


def van_der_hoef(porosity, diameter):
    """k = d2 phi / (18 c F), F = 10 c / phi2 + phi2 (1 + 1.5 sqrt(c)), for random beds of spheres."""
    solid = 1 - porosity
    drag = 10 * solid / porosity**2 + porosity**2 * (1 + 1.5 * np.sqrt(solid))
    return diameter**2 * porosity / (18 * solid * drag)


main()
