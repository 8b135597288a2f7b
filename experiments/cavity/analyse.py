"""The vortex below a moving lid against published tables: python analyse.py RUN_FOLDER"""

import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

VISCOSITY = 1.792e-3 / 999.8  # kinematic [m2/s]
# Ghia, Ghia and Shin (1982), tables I and II: velocity along x on the vertical and along z on the
# horizontal middle line, over that of the lid.
Z = (0.0547, 0.0625, 0.0703, 0.1016, 0.1719, 0.2813, 0.4531, 0.5, 0.6172, 0.7344, 0.8516, 0.9531, 0.9609, 0.9688, 0.9766)
X = (0.0625, 0.0703, 0.0781, 0.0938, 0.1563, 0.2266, 0.2344, 0.5, 0.8047, 0.8594, 0.9063, 0.9453, 0.9531, 0.9609, 0.9688)
U = {
    100: (-0.03717, -0.04192, -0.04775, -0.06434, -0.10150, -0.15662, -0.21090, -0.20581, -0.13641, 0.00332, 0.23151,
          0.68717, 0.73722, 0.78871, 0.84123),
    1000: (-0.18109, -0.20196, -0.22220, -0.29730, -0.38289, -0.27805, -0.10648, -0.06080, 0.05702, 0.18719, 0.33304,
           0.46604, 0.51117, 0.57492, 0.65928),
}
W = {
    100: (0.09233, 0.10091, 0.10890, 0.12317, 0.16077, 0.17507, 0.17527, 0.05454, -0.24533, -0.22445, -0.16914,
          -0.10313, -0.08864, -0.07391, -0.05906),
    1000: (0.27485, 0.29012, 0.30353, 0.32627, 0.37095, 0.33075, 0.32235, 0.02526, -0.31966, -0.42665, -0.51550,
           -0.39188, -0.33714, -0.27669, -0.21388),
}
# Marchi, Suero and Araki (2009): least u, least and greatest w at 100, on a far finer grid.
MARCHI = (-0.21404, -0.25380, 0.17957)


def main():
    """Compare, print the errors, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    last = xarray.open_dataset(folder / "fluid.nc", decode_timedelta=False).isel(y=0, time=-1)
    lid = speed_of_lid(last.attrs["scene"])
    side = float(last.x_bounds.max())
    reynolds = lid * side / VISCOSITY
    table = min(U, key=lambda known: abs(known - reynolds))
    print(f"Reynolds number {reynolds:.1f}; table for {table}")

    # The middle lines lie between two cells.
    u = last.velocity.sel(component="x").isel(x=middle(last.sizes["x"])).mean("x") / lid
    w = last.velocity.sel(component="z").isel(z=middle(last.sizes["z"])).mean("z") / lid
    x, z = last.x / side, last.z / side
    for name, line, place, at, known in (("u", u, z, Z, U[table]), ("w", w, x, X, W[table])):
        difference = np.abs(np.interp(at, place, line) - known)
        worst = int(np.argmax(difference))
        print(f"{name}: at most {difference[worst]:.4f} from Ghia et al., at {at[worst]}")
    if table == 100:
        found = float(u.min()), float(w.min()), float(w.max())
        for name, value, known in zip(("least u", "least w", "greatest w"), found, MARCHI):
            print(f"{name}: {value:.5f}, Marchi et al. {known:.5f}, {100 * (value / known - 1):+.2f} %")

    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    figure.suptitle(f"{last.attrs['title']}, Re {reynolds:.0f}")
    speed = np.hypot(last.velocity.sel(component="x"), last.velocity.sel(component="z")) / lid
    drawn = left.pcolormesh(x, z, speed, cmap="viridis", vmin=0, vmax=0.6, shading="nearest")
    left.streamplot(
        x.values, z.values, last.velocity.sel(component="x").values, last.velocity.sel(component="z").values,
        color="w", density=1.3, linewidth=0.7, arrowsize=0.7,
    )
    left.set(xlabel="x / L", ylabel="z / L", aspect="equal", xlim=(0, 1), ylim=(0, 1))
    figure.colorbar(drawn, ax=left, label="speed over that of the lid", extend="max")

    right.plot(u, z, "C0", lw=1.2, label="u on the vertical middle line")
    right.plot(U[table], Z, "C0o", ms=4, mfc="none")
    right.plot(w, x, "C1", lw=1.2, label="w on the horizontal middle line")
    right.plot(W[table], X, "C1o", ms=4, mfc="none")
    right.plot([], [], "ko", ms=4, mfc="none", label="Ghia et al. (1982)")
    right.set(xlabel="velocity over that of the lid", ylabel="z / L for u, x / L for w", ylim=(0, 1))
    right.legend(loc="lower right", fontsize="small")
    right.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def middle(n):
    """The two cells in the middle of n."""
    return slice(n // 2 - 1, n // 2 + 1)


def speed_of_lid(scene):
    """Velocity of the lid [m/s], as the scene in the results says."""
    value, unit = re.search(r'top = \{ velocity = \["([-0-9.e]+) (m|mm|cm)/s"', scene).groups()
    return float(value) * {"m": 1, "cm": 1e-2, "mm": 1e-3}[unit]


main()
