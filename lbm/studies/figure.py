"""Draws the tables of this folder: convergence.png."""

import csv
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = Path(__file__).parent


def table(name):
    """Rows of a table, numbers where they are some."""

    def number(text):
        try:
            return float(text)
        except ValueError:
            return text

    with open(HERE / name, newline="") as file:
        rows = csv.DictReader(file)
        return [{key: number(value) for key, value in row.items()} for row in rows]


def curves(rows, by, x, y):
    """Lists of x and y for each value of `by`."""
    found = defaultdict(lambda: ([], []))
    for row in rows:
        found[by(row)][0].append(x(row))
        found[by(row)][1].append(y(row))
    return dict(found)


def orders(axes, cases):
    rows = [row for row in table("orders.csv") if row["case"].startswith(cases)]
    for case, (n, error) in curves(
        rows,
        lambda row: row["case"],
        lambda row: row["cells"],
        lambda row: row["relative error"],
    ).items():
        axes.loglog(n, error, "o-", ms=3, lw=1, label=case)
    n = [16, 128]
    axes.loglog(n, [2e-2 * (16 / x) ** 2 for x in n], "k--", lw=1, label="second order")
    ticks(axes.xaxis, [8, 16, 32, 64, 128])
    axes.set(xlabel="cells", ylabel="relative error")
    axes.legend(fontsize=6, loc="lower left")


def ticks(axis, values, unit=""):
    axis.set_ticks(values, [f"{x:g}{unit}" for x in values])
    axis.set_ticks([], minor=True)


def cavity(axes):
    rows = table("cavity.csv")
    n = [row["cells"] for row in rows]
    for column, label in [("mean deviation", "mean"), ("of extremes", "of the extremes")]:
        axes.loglog(n, [100 * row[column] for row in rows], "o-", ms=3, label=label)
    axes.loglog(n, [8 * (48 / x) ** 2 for x in n], "k--", lw=1, label="second order")
    ticks(axes.xaxis, n)
    ticks(axes.yaxis, [1, 2, 4, 8], " %")
    axes.set(xlabel="cells along an edge", ylabel="deviation")
    axes.set_title("driven cube, Re 1000\nagainst Albensoeder and Kuhlmann (2005)")
    axes.legend(fontsize=7)


def spheres(axes):
    rows = [row for row in table("spheres.csv") if row["array"] == "SimpleCubic"]
    by_solid = {}
    # Of voxels, the solid fraction is only nearly the same at all resolutions.
    wanted = [0.064, 0.125, 0.216, 0.343]
    for row in rows:
        near = min(wanted, key=lambda c: abs(row["solid fraction"] / c - 1))
        if row["solid fraction"] < 0.4:
            by_solid.setdefault((near, row["shrink"]), []).append(row)
    for (fraction, shrink), of in sorted(by_solid.items()):
        axes.plot(
            [row["cells"] for row in of],
            [100 * (row["K"] / row["reference"] - 1) for row in of],
            "o:" if shrink else "o-",
            ms=3,
            lw=1,
            mfc="none" if shrink else None,
            color=f"C{wanted.index(fraction)}",
            label=None if shrink else f"c = {fraction}",
        )
    axes.plot([], [], "o:k", ms=3, mfc="none", label="radii 0.075 cells less")
    axes.axhspan(-3, 3, color="0.93", zorder=0)
    axes.set(xlabel="cells a period", ylabel="drag off by [%]")
    axes.set_title("simple cubic arrays of spheres\nagainst Zick and Homsy (1982)")
    axes.legend(fontsize=7)


def packing(axes):
    rows = table("packing.csv")
    for shrink, of in curves(
        rows,
        lambda row: row["shrink"],
        lambda row: 1 / row["cells"] ** 2,
        lambda row: 1e4 * row["permeability"],
    ).items():
        label = "radii 0.075 cells less" if shrink else "as they are"
        color = "C1" if shrink else "C0"
        axes.plot(*of, "o-", ms=3, color=color, label=label)
        # Second order, from the two finest.
        (b, a), (k_b, k_a) = ([values[i] for i in (-2, -1)] for values in of)
        axes.plot([0, a], [(k_a * b - k_b * a) / (b - a), k_a], ":", color=color)
    finest = rows[-1]
    axes.axhline(1e4 * finest["Kozeny-Carman"], color="k", lw=0.8, label="Kozeny-Carman")
    axes.axhline(1e4 * finest["van der Hoef"], color="k", lw=0.8, ls="--", label="van der Hoef")
    axes.set(xlim=(0, None), ylim=(4, None))
    axes.plot([], [], ":", color="0.4", label="extrapolated")
    cells = sorted({row["cells"] for row in rows})
    axes.set_xticks([1 / n**2 for n in cells], [f"{n:.0f}" for n in cells])
    axes.set(xlabel="cells a diameter (their inverse square)", ylabel="permeability [1e-4 d²]")
    axes.set_title("packing of 1000 grains")
    axes.legend(fontsize=7)


def numbers(axes):
    rows = table("numbers.csv")
    for n, color in [(16, "C0"), (32, "C1")]:
        of = [row for row in rows if row["cells"] == n]
        sigma = [row["drag"] for row in of]
        axes.loglog(sigma, [row["error f64"] for row in of], "o-", ms=3, lw=1, color=color,
                    label=f"f64, {n} cells")
        axes.loglog(sigma, [row["error f32"] for row in of], "o:", ms=3, mfc="none", color=color,
                    label=f"f32, {n} cells")
        limit = of[0]["drag"] / of[0]["least over diffusivity"]
        axes.axvline(limit, color=color, lw=0.8)
    axes.set(xlabel="drag σ at storage 3 (lines: f32 refused beyond)", ylabel="relative error")
    axes.set_title("column at T = 0.2, p = 1e-6 ρc²")
    axes.legend(fontsize=7)


def main():
    figure, axes = plt.subplots(2, 3, figsize=(13, 8), layout="constrained")
    orders(axes[0, 0], ("Taylor", "free layer"))
    axes[0, 0].set_title("free water")
    orders(axes[0, 1], ("Terzaghi", "manufactured", "tide", "wave"))
    axes[0, 1].set(title="bed", ylim=(1e-7, None))
    cavity(axes[0, 2])
    spheres(axes[1, 0])
    packing(axes[1, 1])
    numbers(axes[1, 2])
    figure.savefig(HERE / "convergence.png", dpi=110)


if __name__ == "__main__":
    main()
