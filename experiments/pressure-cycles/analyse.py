"""Creep, slip and pressure of a bed under cycles of water pressure: python analyse.py FOLDER

FOLDER holds the runs of runs.csv, one folder each, at any depth: that of `esker sweep`; or a single run. Prints
every number of README.md and draws figure.png into it. Runs that differ only by their seed are taken together.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np

# This folder becomes a part of the program: nothing may be left in it.
sys.dont_write_bytecode = True
from runs import AMPLITUDE, DAY, DIAMETER, LOAD, PERIOD, YEAR, Case, Run, has_cycles

# Effective stresses at the top at which rates are compared [Pa].
LEVELS = (50e3, 65e3, 80e3, 100e3)
# Friction of the dry beds in the critical state, before the shear stress falls.
FRICTION = 0.33
# Rates below this are elastic, or none [1/s].
STILL = 1e-3


def main():
    """Read all runs, print what the page quotes, draw."""
    folder = Path(sys.argv[1])
    runs = [Run(path.parent) for path in folder.glob("**/series.nc") if has_cycles(path.parent)]
    labels = dict.fromkeys(run.case for run in runs)
    cases = [Case(label, [run for run in runs if run.case == label]) for label in labels]
    cases.sort(key=lambda case: (case.stress < 20e3, not case.wet, case.wet and case.runs[0].report["permeability"]))
    for case in cases:
        tell(case)
    figure = draw(cases)
    figure.savefig(folder / "figure.png", dpi=100)
    print(f"drawn: {folder / 'figure.png'}")


def of(values, form=".3f", scale=1.0):
    """Mean and standard deviation over seeds, and the seeds one by one."""
    values = values * scale
    spread = f" ± {values.std('seed', ddof=1):{form.lstrip('+')}}" if values.sizes["seed"] > 1 else ""
    return f"{values.mean('seed'):{form}}{spread} (" + ", ".join(f"{value:{form}}" for value in values.values) + ")"


def tell(case):
    """What the page quotes: means ± standard deviations over seeds (and each seed)."""
    print(f"{case.label}, shear stress {case.stress / 1e3:.0f} kPa, seeds {case.days.seed.values}:")
    real = np.mean([run.height for run in case.runs]) * PERIOD / DAY * YEAR
    days = case.each_day()
    for whole in days.whole.values:
        day = days.sel(whole=whole)
        print(f"  day {whole}: fastest {of(day.fastest, '.4f')} 1/s, {of(day.after, '+.3f')} days after the weakest; "
              f"moves {of(day.moved, '.2f', 1e3)} mm")
    means = days.mean("whole")
    print(f"  all days: fastest {of(means.fastest, '.4f')} 1/s, {of(means.fastest, '.2f', real)} m/a; moves {of(means.moved, '.2f', 1e3)} mm a day")
    for carried in LEVELS:
        falling, rising = case.at(carried)
        print(f"  {carried / 1e3:.0f} kPa at the top: {of(falling, '+.4f')} 1/s as it weakens, {of(rising, '+.4f')} as it "
              f"strengthens, {of(rising / falling, '.2f')} times as fast")
    if not case.wet:
        return
    base = case.runs[0]
    depth = np.sqrt(2 * base.diffusivity() / (2 * np.pi / PERIOD))
    print(f"  seed {base.seed}: M {base.report['stiffness']:.3e} Pa, c_v {base.diffusivity():.3f} m²/s, skin depth {depth:.3f} m of "
          f"{base.height:.3f} m, drained in {base.report['drainage_time']:.3f} s, D_n {base.report['D_n']:.2f}")
    waves = case.over_seeds(lambda run: run.waves())
    theory = case.over_seeds(lambda run: run.theory(waves.z.values))
    for layer in (0, waves.sizes["z"] // 2, waves.sizes["z"] - 2):
        seen, expected = waves.isel(z=layer), theory.isel(z=layer)
        print(f"  {float(waves.z[layer]) / DIAMETER:.1f} d over the base: amplitude {of(seen.amplitude)}, lag {of(seen.lag)} days; "
              f"elastic bed {of(expected.amplitude)}, {of(expected.lag)}")


def draw(cases):
    """Eight panels."""
    figure, panels = plt.subplots(2, 4, figsize=(18, 8), layout="constrained")
    figure.suptitle(cases[0].runs[0].series.attrs["title"])
    (force, loop, cumulated, moved), (inside, amplitude, lag, depth) = panels
    slipping = [case for case in cases if case.stress > 20e3]
    wet = [case for case in slipping if case.wet]
    colours = {case.label: f"C{k}" for k, case in enumerate(cases)}
    base = wet[0].runs[0]

    force.plot(base.days.day, base.days.carried / 1e3, color="0.5")
    force.set(xlabel="days", ylabel="effective stress at the top (kPa)", ylim=(0, 200))
    other = force.twinx()
    for case in wet:
        for seed, rate in enumerate(case.days.rate):
            label = case.label if seed == 0 else None
            other.plot(case.days.day, rate.where(rate > STILL), color=colours[case.label], lw=0.8, label=label)
    other.set(ylabel="shear rate (1/s), three seeds", yscale="log", ylim=(STILL, 10))
    other.legend(fontsize="small", loc="upper right")

    for case in slipping:
        mean = case.loop()
        rate, carried = mean.rate, mean.carried.mean("seed") / 1e3
        for way, style, mark in ((mean.age_bins < 0, "-", "<"), (mean.age_bins > 0, "--", ">")):
            # Where all seeds move; their geometric mean, and all they span.
            there = (way & (rate > STILL).all("seed")).values
            some, at = rate.isel(age_bins=there), carried.isel(age_bins=there)
            colour = {"color": colours[case.label]}
            label = f"{case.label}" if style == "-" else None
            loop.plot(at, np.exp(np.log(some).mean("seed")), mark + style, ms=4, label=label, **colour)
            loop.fill_between(at, some.min("seed"), some.max("seed"), alpha=0.12, lw=0, **colour)
    loop.axvline(base.stress / FRICTION / 1e3, color="0.5", ls=":", lw=1, label=f"τ / {FRICTION}, dry")
    loop.set(yscale="log", ylim=(STILL, None), xlabel="effective stress at the top (kPa)", ylabel="shear rate (1/s)")
    loop.legend(fontsize="small", title="< weakening, > strengthening\nbands: seeds", title_fontsize="small")

    for case in slipping:
        for run in case.runs:
            strain = run.series.strain - run.series.strain[0]
            label = case.label if run is case.runs[0] else None
            cumulated.plot((run.series.time - run.begin) / PERIOD, np.maximum(strain, 1e-4), lw=0.9, color=colours[case.label], label=label)
    cumulated.set(yscale="log", xlabel="days", ylabel="shear strain since the first day")
    cumulated.legend(fontsize="small")

    for place, case in enumerate(slipping):
        days = 1e3 * case.each_day().moved
        for k, one in enumerate(days.transpose("seed", "whole")):
            at = place + 0.12 * (k - (days.sizes["seed"] - 1) / 2) + np.linspace(-0.03, 0.03, one.size)
            moved.plot(at, one, "o", ms=4, mfc="none", color=colours[case.label])
        moved.plot([place - 0.3, place + 0.3], 2 * [np.exp(np.log(days).mean())], color=colours[case.label])
    moved.set_xticks(range(len(slipping)), [case.label for case in slipping], fontsize="small")
    moved.set(yscale="log", ylabel="moves by (mm a day)", title="days 2 to 4 of each seed, geometric mean")

    age = (base.profiles.time - base.begin) / PERIOD
    depths = (1, 3, 5, 8, 14)
    for down, colour in zip(depths, plt.cm.viridis(np.linspace(0, 0.85, len(depths)))):
        there = base.profiles.pore_pressure.sel(z=base.height - down * DIAMETER, method="nearest")
        inside.plot(age, there / 1e3, color=colour, label=f"{down} d")
    inside.plot(base.days.day, (LOAD - base.days.carried) / 1e3, "k:", lw=1, label="at the top")
    inside.set(xlabel="days", ylabel="pore pressure (kPa)", title=f"{base.case}, seed {base.seed}", xlim=(1, None))
    inside.legend(fontsize="x-small", title="depth", loc="upper right")

    fine = np.linspace(0, base.height, 100)
    for k, case in enumerate(case for case in cases if case.wet):
        waves = case.over_seeds(lambda run: run.waves())
        theory = case.over_seeds(lambda run: run.theory(fine)).mean("seed")
        for panel, name in ((amplitude, "amplitude"), (lag, "lag")):
            mean, spread = waves[name].mean("seed"), waves[name].std("seed")
            style = {"fmt": "osd"[k], "ms": 4, "lw": 1.5, "color": colours[case.label], "label": case.label}
            panel.errorbar(mean, waves.z / DIAMETER, xerr=spread, **style)
            panel.plot(theory[name], fine / DIAMETER, color=colours[case.label], lw=1)
    amplitude.set(xlabel=f"daily amplitude of pore pressure over {AMPLITUDE / 1e3:.0f} kPa", ylabel="height (diameters)", xlim=(0, 1.1))
    lag.set(xlabel="lag behind the top (days)", ylabel="height (diameters)", xlim=(0, None))
    amplitude.legend(fontsize="small", title="bars: spread of seeds; lines: elastic bed", title_fontsize="small")

    for part, style in (((0.1, 0.25), "-"), ((0.25, 0.4), "--"), ((0.4, 0.5), ":")):
        for case in wet:
            shares = case.over_seeds(lambda run: run.sheared(part) / abs(run.sheared(part)).max())
            label = f"{part[0]} to {part[1]} days" if case is wet[0] else None
            depth.plot(shares.mean("seed"), shares.z / DIAMETER, style, color=colours[case.label], label=label)
    depth.set(xlabel="velocity over that of the fastest layer", ylabel="height (diameters)", xlim=(-0.2, 1.1))
    depth.legend(fontsize="small", title="after the rise began; means of seeds", title_fontsize="small")
    for panel in panels.flat:
        panel.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    main()
