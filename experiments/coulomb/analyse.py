"""Strength against normal stress and rate: python analyse.py SWEEP_FOLDER

Prints every number of README.md and draws figure.png into the folder.
"""

import argparse
import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

HERE = Path(__file__).resolve().parent
# The critical state: strains over which strength is averaged, in blocks for its error.
FROM, TO, BLOCKS = 0.3, 0.6, 6
NAMES = ("without rolling resistance", "with rolling resistance")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sweep", type=Path, help="folder with sweep.nc")
    folder = parser.parse_args().sweep
    data = xarray.open_dataset(folder / "sweep.nc", decode_timedelta=False)
    beds = [strength(data.isel(rolling=k)) for k in range(data.sizes["rolling"])]
    fits = [report(name, bed) for name, bed in zip(NAMES, beds)]
    table(beds)
    figure = draw(beds, fits)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def strength(data):
    """Mean stresses of each point in the critical state, and the error of their ratio."""
    edges = np.linspace(FROM, TO, BLOCKS + 1)
    blocks = []
    for low, high in zip(edges[:-1], edges[1:]):
        inside = (data.strain > low) & (data.strain <= high)
        stresses = {name: data[f"{name}_stress_top_mean"] for name in ("shear", "normal")}
        blocks.append(xarray.Dataset(stresses).where(inside).mean("row"))
    blocks = xarray.concat(blocks, "block")
    ratio = blocks.shear / blocks.normal
    bed = blocks.mean("block")
    bed["friction"] = bed.shear / bed.normal
    bed["error"] = ratio.std("block", ddof=1) / np.sqrt(BLOCKS)
    inside = (data.strain > FROM) & (data.strain <= TO)
    bed["fraction"] = data.solid_fraction.where(inside).mean("row")
    bed["number"] = data.inertial_number.where(inside & np.isfinite(data.inertial_number)).median("row")
    return bed


def line(x, y, weight):
    """Slope and intercept with their standard errors from the scatter, and the rms residual."""
    values, covariance = np.polyfit(x, y, 1, w=weight, cov=True)
    rest = weight * (y - np.polyval(values, x))
    return values, np.sqrt(np.diag(covariance)), np.sqrt((rest**2).mean())


def slope_over(x, y):
    """Slope of y over x with its error, and the rms residual."""
    x, y = xarray.broadcast(x, y)
    y = y.transpose(*x.dims)
    (slope, _), (error, _), rest = line(x.values.ravel(), y.values.ravel(), np.ones(x.size))
    return slope, error, rest


def report(name, bed):
    """Print the fits of one bed; returns the slope and intercept of the envelope."""
    shear, normal = bed.shear.values.ravel(), bed.normal.values.ravel()
    # Friction scatters by the same everywhere, so stresses do by their size.
    (slope, intercept), (slope_error, intercept_error), rest = line(normal, shear, 1 / normal)
    angle, angle_error = np.degrees([np.arctan(slope), slope_error / (1 + slope**2)])
    print(f"{name}: {bed.friction.size} runs, median error of one {float(bed.error.median()):.4f}")
    print(f"  angle {angle:.2f} +- {angle_error:.2f} degrees, slope {slope:.4f} +- {slope_error:.4f}")
    print(f"  intercept {intercept:.0f} +- {intercept_error:.0f} Pa, residual {rest:.4f} of the normal stress")
    slow = bed.isel(strain_rate=slice(0, -1))
    for part, which in ((bed, "all rates"), (slow, "without the fastest")):
        trend, error, rest = slope_over(np.log10(part.strain_rate), part.friction)
        power, power_error, _ = slope_over(np.log(part.strain_rate), np.log(part.friction))
        print(f"  {which}: friction {trend:+.4f} +- {error:.4f} a decade of rate, residual {rest:.4f};")
        print(f"    as a power of the rate {power:+.4f} +- {power_error:.4f}")
    mean = bed.friction.mean("normal_stress")
    print(f"  friction at the fastest over that at the slowest rate {float(mean[-1] / mean[0]):.3f}")
    low, high = float(bed.number.min()), float(bed.number.max())
    print(f"  inertial number from {low:.1e} to {high:.1e}")
    print(f"  solid fraction {float(bed.fraction.mean()):.4f}")
    return slope, intercept


def table(beds):
    """Friction of each run."""
    for name, bed in zip(NAMES, beds):
        print(f"friction {name}; rates in 1/s: {bed.strain_rate.values}")
        friction = bed.friction.transpose("normal_stress", "strain_rate")
        for stress, row in zip(bed.normal_stress.values, friction.values):
            print(f"  {stress / 1e3:4.0f} kPa: " + " ".join(f"{f:.3f}" for f in row))


def draw(beds, fits):
    """The envelopes with what is known of tills, and friction against rate."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.6), layout="constrained")
    stress = np.linspace(0, 125e3, 2)
    markers = "ov^s"
    for k, (name, bed, (slope, intercept)) in enumerate(zip(NAMES, beds, fits)):
        for marker, rate in zip(markers, bed.strain_rate.values):
            one = bed.sel(strain_rate=rate)
            label = f"{rate:g} 1/s" if k == 0 else None
            left.plot(one.normal / 1e3, one.shear / 1e3, marker, color=f"C{k}", ms=5, mfc="none", label=label)
        angle = np.degrees(np.arctan(slope))
        label = f"{name}: {angle:.1f}°"
        left.plot(stress / 1e3, (slope * stress + intercept) / 1e3, color=f"C{k}", label=label)
        for j, value in enumerate(bed.normal_stress.values):
            one = bed.sel(normal_stress=value)
            rate = one.strain_rate * (1 + 0.03 * (j - 2.5))
            right.errorbar(rate, one.friction, one.error, fmt=".", color=f"C{k}", alpha=0.25 + 0.15 * j, lw=1)
        mean = bed.friction.mean("normal_stress")
        right.plot(bed.strain_rate, mean, color=f"C{k}", label=name)
    with open(HERE / "laboratory.csv", encoding="utf-8") as file:
        for style, known in zip((":", "-."), csv.DictReader(file)):
            shear = float(known["slope"]) * stress / 1e3 + float(known["intercept_kPa"])
            left.plot(stress / 1e3, shear, style, color="0.4", label=known["name"])
    left.set(xlabel="normal stress (kPa)", ylabel="shear stress (kPa)", xlim=(0, 125), ylim=(0, None))
    left.legend(fontsize=8)
    right.set(xlabel="strain rate (1/s)", ylabel="friction τ/σ", xscale="log", ylim=(0, 0.7))
    rates = beds[0].strain_rate.values
    right.set_xticks(rates, [f"{rate:g}" for rate in rates])
    right.minorticks_off()
    right.legend(fontsize=8, title="lines: means over normal stresses", title_fontsize=8)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    return figure


main()
