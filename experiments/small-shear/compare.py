"""A dense, a middling and a loose bed: run what is missing, print the table, draw the figure.

    python experiments/small-shear/compare.py results/small-shear-beds

Each run takes about a minute and stays in a folder below the one that is named; the figure is
densities.png there.
"""

import argparse
import subprocess
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# Friction while the bed settles, which decides how dense it is laid; none: the scene's own.
BEDS = {"dense": "none", "middling": None, "loose": "1.0"}
# Strain over which a mean is taken for the peak.
WINDOW = 0.02
# Strain from which on the bed is taken to be in its critical state.
LATE = 0.5


def main():
    """Run, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="where the three runs are, or are to be")
    parser.add_argument("--esker", default="esker", help="the program")
    parser.add_argument("--threads", help="for each run; default: one for each core")
    options = parser.parse_args()

    print("| `phase.settle.friction` | fraction | peak friction | ultimate friction | dilation | fraction then |")
    print("|---|---|---|---|---|---|")
    figure, (above, below) = plt.subplots(2, sharex=True, figsize=(7, 6), layout="constrained")
    for name, friction in BEDS.items():
        series = shear_of(options, name, friction)
        print(row("as it is, 0.58 and 0.47" if friction is None else f"`{friction}`", series))
        above.plot(*means(series), label=f"{name}, fraction {fraction_at_first(series):.3f}")
        below.plot(series.strain, 100 * series.dilation)
    above.set(ylabel=f"friction τ/σ, mean over {WINDOW} of strain")
    above.legend()
    below.set(xlabel="shear strain", ylabel="dilation (%)")
    for axes in (above, below):
        axes.grid(alpha=0.3)
    figure.savefig(options.folder / "densities.png", dpi=150)


def shear_of(options, name, friction):
    """Series of the shear phase of one bed, and of the moment before it."""
    folder = options.folder / name
    if not (folder / "series.nc").exists():
        command = [options.esker, "run", "small-shear", "--out", folder, "--quiet"]
        if options.threads:
            command += ["--threads", options.threads]
        if friction is not None:
            command += ["--set", f"phase.settle.friction={friction}"]
        subprocess.run(command, check=True)
    series = xarray.open_dataset(folder / "series.nc", decode_timedelta=False)
    names = series.phase.attrs["flag_meanings"].split()
    first = int(np.argmax(series.phase.values == names.index("shear")))
    shear = series.isel(time=slice(first, None))
    if shear.strain[-1] < 0.999:
        raise SystemExit(f"{folder}: sheared to a strain of {shear.strain[-1]:.3f} only")
    return shear.assign_attrs(fraction_at_first=float(series.solid_fraction[first - 1]))


def fraction_at_first(series):
    """Solid fraction before the shear, three diameters away from the layers."""
    return series.attrs["fraction_at_first"]


def means(series):
    """Middles of the windows of strain, and the friction in each."""
    number = np.minimum(series.strain.values / WINDOW, 1 / WINDOW - 1).astype(int)
    stress = [
        np.bincount(number, weights=mean.fillna(0))
        for mean in (series.shear_stress_top_mean, series.normal_stress_top_mean)
    ]
    return WINDOW * (np.arange(number.max() + 1) + 0.5), stress[0] / stress[1]


def row(bed, series):
    """One line of the table."""
    strain, friction = means(series)
    peak = np.argmax(friction)
    late = series.isel(time=(series.strain > LATE).values)
    ultimate = float(late.shear_stress_top_mean.mean() / late.normal_stress_top_mean.mean())
    cells = (
        bed,
        f"{fraction_at_first(series):.3f}",
        f"{friction[peak]:.3f} at strain {strain[peak]:.2f}",
        f"{ultimate:.3f}",
        f"{100 * float(late.dilation.mean()):.1f} %",
        f"{float(late.solid_fraction.mean()):.3f}",
    )
    return "| " + " | ".join(cells) + " |"


main()
