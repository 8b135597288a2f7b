"""Draws the tables of this folder: map.png and accuracy.png."""

import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

HERE = Path(__file__).parent
STIFFNESS = {1e7: "10$^7$", 4e7: "4·10$^7$", 1e8: "10$^8$", 1e9: "10$^9$"}


def table(name):
    """Rows of a table, numbers where they are some."""

    def number(text):
        try:
            return float(text)
        except ValueError:
            return text

    with open(HERE / name, newline="") as file:
        return [{k: number(v) for k, v in row.items()} for row in csv.DictReader(file)]


def power(x):
    return f"10$^{{{round(np.log10(x))}}}$"


def grid(axes, rows, contact):
    """Error over permeability and interval, with real water."""
    rows = [r for r in rows if r["contact stiffness"] == contact and r["times softer"] == 1]
    permeabilities = sorted({r["permeability"] for r in rows})
    intervals = sorted({r["interval"] for r in rows})
    errors = np.full((len(intervals), len(permeabilities)), np.nan)
    for r in rows:
        at = intervals.index(r["interval"]), permeabilities.index(r["permeability"])
        if r["energy left"] == "refused":
            text, colour = "–", "0.5"
        elif not r["energy left"] < 1:
            text, colour = "blows up", "red"
        else:
            errors[at] = 100 * abs(r["error"])
            text, colour = f"{100 * r['error']:+.1f}", "black"
        axes.text(at[1], at[0], text, ha="center", va="center", fontsize=6, color=colour)
    axes.imshow(errors, origin="lower", aspect="auto", cmap="YlOrRd", vmin=0, vmax=12)
    axes.set_xticks(range(len(permeabilities)), [power(k) for k in permeabilities])
    axes.set_yticks(range(len(intervals)), [f"{n:g}" for n in intervals])
    axes.set(
        xlabel="permeability [m²]",
        ylabel="grain steps per fluid step n",
        title=f"water as it is, k$_n$ = {STIFFNESS[contact]} N/m: error [% of p$_0$], – refused",
    )


def softened(axes, rows, contact):
    """Error over permeability for water that is softer, against real water."""
    chosen = [r for r in rows if r["contact stiffness"] == contact and r["error"] != ""]
    for times, style in ((1, "o-"), (10, "s-"), (100, "^-")):
        found = {}
        for r in chosen:
            # At each permeability the longest interval that all waters have.
            if r["times softer"] == times and r["interval"] in (1, 16):
                found[r["permeability"]] = 100 * r["error"]
        axes.semilogx(*zip(*sorted(found.items())), style, ms=3, lw=1, label=f"{times} ×")
    axes.axhline(0, color="0.7", lw=0.5)
    axes.set(
        xlabel="permeability [m²]",
        ylabel="pressure less that of real water [% of p$_0$]",
        title=f"softened water, k$_n$ = {STIFFNESS[contact]} N/m",
        ylim=(-105, 15),
    )
    axes.legend(fontsize=7, title="softer by", title_fontsize=7, loc="lower right")


def deborah(axes):
    rows = table("deborah.csv")
    number = np.array([r["De"] for r in rows])
    # Suction over that of a bed from which nothing drains.
    scale = [-max(abs(r["theory"]) for r in rows)] * len(rows)
    base = np.array([r["base"] for r in rows]) / scale
    theory = np.array([r["theory"] for r in rows]) / scale
    axes.loglog(number, theory, "k-", lw=1, label="exact")
    axes.loglog(number, base, "o", ms=4, label="coupled")
    ends = np.array([number.min(), 1.0])
    axes.loglog(ends, 0.5 * ends, "k:", lw=1, label="drained: De/2")
    axes.axhline(1, color="k", ls="--", lw=1, label="undrained: 1")
    axes.set(xlabel="Deborah number", ylabel="suction at the base / undrained", title="C4: dilation")
    axes.legend(fontsize=7)


def intervals(axes):
    rows = table("intervals.csv")
    for name in ("T 0.1", "T 0.2", "T 0.4"):
        kept = [r for r in rows if r["prediction"] == "true"]
        error = [100 * r[name] for r in kept]
        axes.plot([r["interval"] for r in kept], error, "o-", ms=4, lw=1, label=f"{name} s"[:-2])
    plain = [r for r in rows if r["prediction"] == "false"]
    lost = [r["interval"] for r in plain if not r["energy left"] < 1]
    held = [r["interval"] for r in plain if r["energy left"] < 1]
    axes.plot(lost, [0] * len(lost), "rx", ms=8, label="without prediction: blows up")
    axes.plot(held, [0] * len(held), "k+", ms=8, label="without prediction: stable")
    axes.axhspan(-3, 3, color="0.9", zorder=0)
    axes.set_xscale("log", base=2)
    axes.set_xticks([r["interval"] for r in kept], [f"{r['interval']:g}" for r in kept])
    axes.set(
        xlabel="grain steps per fluid step n (D$_n$ = 0.014 n)",
        ylabel="pressure at the base, error [%]",
        title="C8: consolidation, k = 10$^{-12}$ m²",
    )
    axes.legend(fontsize=7)


def loose(axes):
    rows = table("loose.csv")
    for contact, colour in ((1e7, "C0"), (4e7, "C2"), (1e8, "C4"), (1e9, "C1")):
        mine = [r for r in rows if r["contact stiffness"] == contact]
        weights = sorted({r["f"] for r in mine})
        errors = [[100 * r["T 0.4"] for r in mine if r["f"] == f] for f in weights]
        for f, some in zip(weights, errors):
            axes.plot([f] * len(some), some, "o", ms=3, color=colour, alpha=0.5)
        name = f"k$_n$ = {STIFFNESS[contact]} N/m, {len(errors[0])} beds"
        axes.plot(weights, [np.mean(some) for some in errors], "-", color=colour, label=name)
    axes.axhspan(-3, 3, color="0.9", zorder=0)
    axes.set_xscale("log", base=2)
    axes.set_xticks(weights, [f"{f:g}" for f in weights])
    axes.set(
        xlabel="f: load that counts half, over the mean",
        ylabel="pressure at T = 0.4, error [%]",
        title="weight of loosely held grains",
    )
    axes.legend(fontsize=7)


def shear(axes):
    rows = table("shear.csv")
    seeds = sorted({r["seed"] for r in rows})

    def of(permeability, interval, exchange=1):
        case = (permeability, exchange, interval, 1.0)
        keys = ("permeability", "exchange", "interval", "f")
        return [r["shear stress"] / 1e3 for r in rows if tuple(r[key] for key in keys) == case]

    steps = [1, 2, 4, 8, 16]
    for k, seed in enumerate(seeds):
        curve = [of(1e-11, n)[k] for n in steps]
        axes.plot(steps, curve, "o-", ms=3, lw=0.7, color="C0", label="k = 10$^{-11}$ m²" if not k else None)
    for permeability, colour in ((1e-10, "C1"), (1e-9, "C2")):
        for n in (1, 2):
            some = of(permeability, n)
            label = f"k = {power(permeability)} m²" if n == 1 else None
            axes.plot([n] * len(some), some, "s", ms=4, color=colour, label=label)
    # Fluid steps at each exchange, both every two grain steps.
    for permeability in (1e-11, 1e-10, 1e-9):
        some = of(permeability, 2, 2)
        label = "exchange every 2 as well" if permeability == 1e-11 else None
        axes.plot([2] * len(some), some, "x", ms=6, color="k", label=label)
    dry = [r["shear stress"] / 1e3 for r in rows if r["permeability"] == "dry"]
    axes.axhspan(min(dry), max(dry), color="0.8", label="dry")
    axes.set_xscale("log", base=2)
    axes.set_xticks(steps, [f"{n:g}" for n in steps])
    axes.set(
        xlabel="grain steps per fluid step n (D$_n$ = 0.14 n at 10$^{-11}$)",
        ylabel="shear stress, strain 0.01 to 0.05 [kPa]",
        title=f"beds that drain while sheared, {len(seeds)} beds",
        ylim=(0, None),
    )
    axes.legend(fontsize=7)


def main():
    rows = table("map.csv")
    figure, axes = plt.subplots(2, 2, figsize=(11, 7), layout="constrained")
    for column, contact in enumerate((1e7, 1e9)):
        grid(axes[0, column], rows, contact)
        softened(axes[1, column], rows, contact)
    figure.savefig(HERE / "map.png", dpi=150)
    figure, axes = plt.subplots(2, 2, figsize=(11, 8), layout="constrained")
    for draw, one in zip((deborah, intervals, loose, shear), axes.flat):
        draw(one)
    figure.savefig(HERE / "accuracy.png", dpi=150)


main()
