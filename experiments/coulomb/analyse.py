"""Strength against normal stress and rate: python analyse.py SWEEP_FOLDER...

Several folders are sweeps that differ by their seed. Prints every number of README.md and draws figure.png
into the first folder.
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
NAMES = ("without rolling resistance", "with rolling resistance")
# The share of the last phase that is left out: the bed gets used to the new rate.
USED_TO = 0.25
# Inertial numbers below which a run counts as quasi-static.
QUASI_STATIC = 5e-3


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sweeps", type=Path, nargs="+", help="folders with a sweep.nc")
    folders = parser.parse_args().sweeps
    beds = xarray.concat([strength(opened(folder)) for folder in folders], "seed", join="outer")
    beds = [beds.isel(rolling=k) for k in range(beds.sizes["rolling"])]
    fits = [report(name, bed) for name, bed in zip(NAMES, beds)]
    table(beds)
    figure = draw(beds, fits)
    figure.savefig(folders[0] / "figure.png", dpi=150)
    print(f"drawn: {folders[0] / 'figure.png'}")


def opened(folder):
    """The sweep with rolling, normal_stress and strain_rate as dimensions instead of its list of points."""
    data = xarray.open_dataset(folder / "sweep.nc", decode_timedelta=False)
    data = data.rename(shear_top_normal_stress="normal_stress")
    data = data.drop_vars(["consolidate_top_normal_stress", "approach_top_normal_stress"])
    return data.set_index(point=["rolling", "normal_stress", "strain_rate"]).unstack("point")


def strength(data):
    """Means of each point over its last phase, in the critical state."""
    last = data.phase == data.attrs["phases"].split().index("shear")
    strain = data.strain - data.strain.where(last).min("row")
    data = data.where(last & (strain > USED_TO * strain.max("row")))
    bed = xarray.Dataset(
        {
            "shear": data.shear_stress_top_mean.mean("row"),
            "normal": data.normal_stress_top_mean.mean("row"),
            "fraction": data.solid_fraction.mean("row"),
            # At the stress of the scene: that of a short time scatters.
            "number": data.inertial_number.median("row"),
        }
    )
    # Volume gained over shear strain, as a line has it.
    loss = -xarray.cov(data.strain, data.solid_fraction, "row") / data.strain.var("row", ddof=1)
    bed["dilation"] = loss / bed.fraction
    bed["friction"] = bed.shear / bed.normal
    return bed


def envelope(bed):
    """Slope and intercept [Pa] of the quasi-static runs, and their rms residual over the normal stress.

    Friction scatters by the same everywhere, so stresses do by their size.
    """
    still = (bed.number < QUASI_STATIC).values
    shear, normal = bed.shear.values[still], bed.normal.values[still]
    slope, intercept = np.polyfit(normal, shear, 1, w=1 / normal)
    return slope, intercept, np.sqrt(np.mean((shear / normal - slope - intercept / normal) ** 2))


def power(bed):
    """Of the rate, to which the friction of quasi-static runs grows."""
    still = (bed.number < QUASI_STATIC).values
    return np.polyfit(np.log(bed.number.values[still]), np.log(bed.friction.values[still]), 1)[0]


def inertia(bed):
    """Friction at rest, and its growth with the inertial number, of all runs: a line."""
    done = np.isfinite(bed.friction.values)
    return np.polyfit(bed.number.values[done], bed.friction.values[done], 1)[::-1]


def errors(law, bed):
    """Standard errors of what `law` finds, by leaving out one bed after the other (jackknife).

    A bed is one seed under one normal stress: its runs share their approach to the critical state.
    """
    beds = bed.stack(bed=("seed", "normal_stress")).dropna("bed", how="all")
    number = beds.sizes["bed"]
    found = [law(beds.isel(bed=np.arange(number) != k)) for k in range(number)]
    return np.sqrt((number - 1) * np.var(found, axis=0))


def standard_error(values, across=None):
    """Of the mean over `across`."""
    return values.std(across, ddof=1) / np.sqrt(values.count(across))


def report(name, bed):
    """Print the fits of one bed; returns the slope and intercept of the envelope, and the law of inertia."""
    (slope, intercept, rest), (slope_error, intercept_error, _) = envelope(bed), errors(envelope, bed)
    angle, angle_error = np.degrees([np.arctan(slope), slope_error / (1 + slope**2)])
    still = bed.number < QUASI_STATIC
    print(f"{name}: {int(bed.friction.count())} runs, of which {int(still.sum())} below I = {QUASI_STATIC:g}:")
    print(f"  angle {angle:.2f} +- {angle_error:.2f} degrees, slope {slope:.4f} +- {slope_error:.4f}")
    print(f"  intercept {intercept:.0f} +- {intercept_error:.0f} Pa, residual {rest:.4f} of the normal stress")
    print(f"  solid fraction {float(bed.fraction.where(still).mean()):.4f}, dilation {float(bed.dilation.where(still).mean()):+.4f}")
    lowest = float(bed.number.min())
    print(f"  friction grows with the power {power(bed):+.4f} +- {errors(power, bed):.4f} of I, from {lowest:.1e} on")
    (rest, growth), (rest_error, growth_error) = inertia(bed), errors(inertia, bed)
    print(f"  all runs: friction {rest:.4f} +- {rest_error:.4f} + ({growth:.2f} +- {growth_error:.2f}) I: 5 % more at I = {0.05 * rest / growth:.3f}")
    across = ["seed", "normal_stress"]
    number = np.exp(np.log(bed.number).mean(across))
    mean, error = bed.friction.mean(across), standard_error(bed.friction, across)
    for k, rate in enumerate(bed.strain_rate.values):
        print(f"  {rate:5g} 1/s, I about {float(number[k]):.1e}: friction {float(mean[k]):.4f} +- {float(error[k]):.4f}, "
              f"solid fraction {float(bed.fraction.mean(across)[k]):.4f}, dilation {float(bed.dilation.mean(across)[k]):+.4f}")
    return slope, intercept, (rest, growth)


def table(beds):
    """Friction of each run."""
    for name, bed in zip(NAMES, beds):
        for seed in range(bed.sizes["seed"]):
            print(f"friction {name}, sweep {seed + 1}; rates in 1/s: {bed.strain_rate.values}")
            friction = bed.friction.isel(seed=seed).transpose("normal_stress", "strain_rate")
            for stress, row in zip(bed.normal_stress.values, friction.values):
                print(f"  {stress / 1e3:4.0f} kPa: " + " ".join(f"{f:.3f}" for f in row))


def draw(beds, fits):
    """The envelopes with what is known of tills, and friction against inertial number."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.6), layout="constrained")
    stress = np.linspace(0, 125e3, 2)
    numbers = np.geomspace(2e-4, 1e-1, 100)
    markers = "ov^s"
    for k, (name, bed, (slope, intercept, (rest, growth))) in enumerate(zip(NAMES, beds, fits)):
        for marker, rate in zip(markers, bed.strain_rate.values):
            one = bed.sel(strain_rate=rate)
            label = f"{rate:g} 1/s" if k == 0 else None
            style = {"color": f"C{k}", "mfc": "none", "ls": ""}
            left.plot(one.normal.values.ravel() / 1e3, one.shear.values.ravel() / 1e3, marker, ms=5, label=label, **style)
            right.plot(one.number.values.ravel(), one.friction.values.ravel(), marker, ms=4, alpha=0.5, **style)
            # The mean over stresses and seeds, with its standard error.
            middle = np.exp(np.log(one.number).mean())
            right.errorbar(middle, one.friction.mean(), standard_error(one.friction), fmt=marker, color=f"C{k}", ms=7, lw=2, capsize=4)
        angle = np.degrees(np.arctan(slope))
        left.plot(stress / 1e3, (slope * stress + intercept) / 1e3, color=f"C{k}", label=f"{name}: {angle:.1f}°")
        label = f"{name}: {rest:.3f} + {growth:.2f} I"
        right.plot(numbers, rest + growth * numbers, color=f"C{k}", label=label)
    with open(HERE / "laboratory.csv", encoding="utf-8") as file:
        for style, known in zip((":", "-."), csv.DictReader(file)):
            shear = float(known["slope"]) * stress / 1e3 + float(known["intercept_kPa"])
            left.plot(stress / 1e3, shear, style, color="0.4", label=known["name"])
    left.set(xlabel="normal stress (kPa)", ylabel="shear stress (kPa)", xlim=(0, 125), ylim=(0, None))
    left.legend(fontsize=8)
    right.axvspan(numbers[0], QUASI_STATIC, color="0.93", zorder=0)
    right.text(1.1 * numbers[0], 0.66, "quasi-static: makes the lines on the left", fontsize=8)
    right.set(xlabel="inertial number γ̇ d √(ρ/σ)", ylabel="friction τ/σ", xscale="log", xlim=numbers[[0, -1]], ylim=(0, 0.7))
    right.legend(fontsize=8, title="large: means over normal stresses", title_fontsize=8, loc="lower right")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    return figure


main()
