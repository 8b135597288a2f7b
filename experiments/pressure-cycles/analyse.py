"""Creep, slip and pressure of a bed under cycles of water pressure: python analyse.py FOLDER

FOLDER holds the runs of runs.csv, one folder each, at any depth: that of `esker sweep`; or a single run.
"""

import json
import sys
import tomllib
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

PERIOD = 0.5  # [s], a day
DAY, YEAR = 86400.0, 3.156e7  # [s]
LOAD, AMPLITUDE = 100e3, 60e3  # [Pa]
DIAMETER = 0.02  # [m]
# Rates are differences over so many rows of the series.
ROWS = 10
# Effective stresses at the top at which rates are compared, and how near counts [Pa].
LEVELS, NEAR = (50e3, 65e3, 80e3, 100e3), 3e3


class Run:
    """One run: what its scene says, and its last phase."""

    def __init__(self, folder):
        whole, profiles = (
            xarray.open_dataset(folder / f"{name}.nc", decode_timedelta=False)
            for name in ("series", "profiles")
        )
        number = phases(whole).index("cycles")
        self.series, self.profiles = (
            data.isel(time=(data.phase == number).values) for data in (whole, profiles)
        )
        scene = tomllib.loads(whole.attrs["scene"])
        phase = next(p for p in scene["phase"] if p["name"] == "cycles")
        self.stress = float(phase["shear"]["shear_stress"].split()[0])
        self.stress *= 1e3 if phase["shear"]["shear_stress"].endswith("kPa") else 1
        self.wet = "coupling_cycles" in whole.attrs
        self.report = json.loads(whole.attrs.get("coupling_cycles", "null"))
        self.viscosity = float(scene["water"]["liquid"]["viscosity"].split()[0])
        time = self.series.time.values
        # The phase begins with a whole period.
        self.begin = PERIOD * round(time[0] / PERIOD)
        strain = self.series.strain.values
        self.time = (time[ROWS:] + time[:-ROWS]) / 2
        self.rate = (strain[ROWS:] - strain[:-ROWS]) / (time[ROWS:] - time[:-ROWS])
        self.day = (self.time - self.begin) / PERIOD
        self.carried = self.at_top(self.time)
        self.label = "dry" if not self.wet else f"k = {self.report['permeability']:.0e} m²"
        if self.stress < 20e3:
            self.label += f", {self.stress / 1e3:.0f} kPa"

    def at_top(self, time):
        """Effective normal stress at the top that is prescribed [Pa]."""
        wave = np.sin(2 * np.pi * time / PERIOD)
        return LOAD + AMPLITUDE * (-wave if self.wet else wave)

    def days(self):
        """Rows of each whole day but the first."""
        return [(self.day >= d) & (self.day < d + 1) for d in range(1, int(self.day[-1] + 0.05))]

    def rate_at(self, carried, falls):
        """Mean rate of all days but the first where the top carries so much, on its way down or up [1/s]."""
        way = np.gradient(self.carried)
        near = (self.day > 1) & (np.abs(self.carried - carried) < NEAR) & ((way < 0) == falls)
        return self.rate[near].mean()

    def diffusivity(self):
        """c_v by what was measured before the first step of the phase [m²/s]."""
        compliance = self.report["storage"] + 1 / self.report["stiffness"]
        return self.report["permeability"] / self.viscosity / compliance

    def waves(self):
        """Heights [m], amplitude over that at the top, and lag [days] of the daily part of pressure."""
        rows = self.profiles.isel(time=(self.profiles.time > self.begin + PERIOD).values)
        rows = rows.isel(time=slice(0, rows.sizes["time"] // 100 * 100))
        turns = np.exp(-2j * np.pi * rows.time.values / PERIOD)
        pressure = rows.pore_pressure.values
        held = np.isfinite(pressure).all(axis=0)
        complex_sine = 2j * np.mean(pressure[:, held] * turns[:, None], axis=0) / AMPLITUDE
        return rows.z.values[held], np.abs(complex_sine), -np.unwrap(np.angle(complex_sine)[::-1])[::-1] / 2 / np.pi

    def height(self):
        """Height of the bed [m]."""
        return float(self.series.wall_height.mean())

    def theory(self, z):
        """The same of a bed that stays elastic, cosh κz / cosh κh."""
        kappa = np.sqrt(2j * np.pi / PERIOD / self.diffusivity())
        wave = np.cosh(kappa * z) / np.cosh(kappa * self.height())
        return np.abs(wave), -np.unwrap(np.angle(wave)[::-1])[::-1] / 2 / np.pi

    def sheared(self, between):
        """Heights [m] and mean velocity along x [m/s] in parts of the days but the first."""
        age = (self.profiles.time - self.begin) / PERIOD
        rows = (age > 1) & (age % 1 > between[0]) & (age % 1 <= between[1])
        mean = self.profiles.isel(time=rows.values).velocity.sel(component="x").mean("time")
        return self.profiles.z.values, mean.values


def main():
    """Read all runs, print what the page quotes, draw."""
    folder = Path(sys.argv[1])
    paths = sorted(folder.glob("**/series.nc"))
    # A sweep has runs that only lay and shear a bed.
    runs = [Run(path.parent) for path in paths if "cycles" in phases(xarray.open_dataset(path, decode_timedelta=False))]
    runs.sort(key=lambda run: (run.stress < 20e3, not run.wet, run.wet and run.report["permeability"]))
    for run in runs:
        tell(run)
    figure = draw(runs)
    figure.savefig(folder / "figure.png", dpi=100)
    print(f"drawn: {folder / 'figure.png'}")


def phases(data):
    """Names of the phases."""
    return data.phase.attrs["flag_meanings"].split()


def tell(run):
    """What the page quotes."""
    print(f"{run.label}, shear stress {run.stress / 1e3:.0f} kPa:")
    real = run.height() * PERIOD / DAY * YEAR
    for day, rows in enumerate(run.days(), 2):
        top = np.nonzero(rows)[0][run.rate[rows].argmax()]
        weakest = run.day[rows][run.carried[rows].argmin()]
        strain = run.rate[rows].mean() * PERIOD
        print(f"  day {day}: fastest {run.rate[top]:.4f} 1/s, {run.rate[top] * real:.2f} m/a, {run.day[top] - weakest:+.3f} days "
              f"after the weakest; strain {strain:.5f}, {1e3 * strain * run.height():.2f} mm")
    for carried in LEVELS:
        falling, rising = (run.rate_at(carried, falls) for falls in (True, False))
        print(f"  {carried / 1e3:.0f} kPa at the top: {falling:+.4f} 1/s as it weakens, {rising:+.4f} as it strengthens")
    if not run.wet:
        return
    depth = np.sqrt(2 * run.diffusivity() / (2 * np.pi / PERIOD))
    print(f"  M {run.report['stiffness']:.3e} Pa, c_v {run.diffusivity():.3f} m²/s, skin depth {depth:.3f} m of "
          f"{run.height():.3f} m, drained in {run.report['drainage_time']:.3f} s, D_n {run.report['D_n']:.2f}")
    z, amplitude, lag = run.waves()
    expected, late = run.theory(z)
    for layer in (0, len(z) // 2, len(z) - 2):
        print(f"  {z[layer] / DIAMETER:.1f} d over the base: amplitude {amplitude[layer]:.3f}, lag {lag[layer]:.3f} days; "
              f"elastic bed {expected[layer]:.3f}, {late[layer]:.3f}")
    fastest = run.rate.argmax()
    there = run.profiles.sel(time=run.time[fastest], method="nearest").pore_pressure
    print(f"  when it is fastest: prescribed {(LOAD - run.carried[fastest]) / 1e3:.1f} kPa, "
          f"two diameters below the top {float(there[len(z) - 3]) / 1e3:.1f} kPa")


def draw(runs):
    """Six panels."""
    figure, panels = plt.subplots(2, 3, figsize=(14, 8), layout="constrained")
    figure.suptitle(runs[0].series.attrs["title"])
    (force, loop, cumulated), (inside, waves, depth) = panels
    slipping = [run for run in runs if run.stress > 20e3]
    wet = [run for run in slipping if run.wet]
    colours = {run.label: f"C{k}" for k, run in enumerate(runs)}
    base = wet[0]

    force.plot(base.day, base.carried / 1e3, color="0.5")
    force.set(xlabel="days", ylabel="effective stress at the top (kPa)", ylim=(0, 200))
    other = force.twinx()
    for run in wet:
        forward = np.where(run.rate > 1e-3, run.rate, np.nan)
        other.plot(run.day, forward, color=colours[run.label], lw=1, label=run.label)
    other.set(ylabel="shear rate (1/s)", yscale="log", ylim=(1e-3, 10))
    other.legend(fontsize="small", loc="upper right")

    for run in slipping:
        rows = run.day > 1
        loop.plot(run.carried[rows] / 1e3, np.where(run.rate[rows] > 1e-3, run.rate[rows], np.nan), ".", ms=2,
                  color=colours[run.label], label=run.label)
        # The mean loop, with arrows.
        for part, mark in (((0.0, 0.5), "<"), ((0.5, 1.0), ">")):
            phase = ((run.day + (0.25 if run.wet else 0.75)) % 1)[rows]
            middle = np.linspace(*part, 11)
            number = np.digitize(phase, middle)
            mean = [run.rate[rows][number == k].mean() for k in range(1, 11)]
            carried = [run.carried[rows][number == k].mean() / 1e3 for k in range(1, 11)]
            loop.plot(carried, mean, mark, ms=5, color=colours[run.label])
    loop.axvline(base.stress / 0.33 / 1e3, color="0.5", ls="--", lw=1, label="τ / 0.33, dry")
    loop.set(yscale="log", ylim=(1e-3, None), xlabel="effective stress at the top (kPa)", ylabel="shear rate (1/s)")
    loop.legend(fontsize="small", title="< weakening, > strengthening", title_fontsize="small")

    for run in slipping:
        strain = run.series.strain - run.series.strain[0]
        cumulated.plot((run.series.time - run.begin) / PERIOD, np.maximum(strain, 1e-4), color=colours[run.label], label=run.label)
    cumulated.set(yscale="log", xlabel="days", ylabel="shear strain since the first day")
    cumulated.legend(fontsize="small")

    age = (base.profiles.time - base.begin) / PERIOD
    layers = [13, 11, 9, 6, 0]
    for layer, colour in zip(layers, plt.cm.viridis(np.linspace(0, 0.85, len(layers)))):
        z = float(base.profiles.z[layer])
        inside.plot(age, base.profiles.pore_pressure[:, layer] / 1e3, color=colour, label=f"{(base.height() - z) / DIAMETER:.0f} d")
    inside.plot(base.day, (LOAD - base.carried) / 1e3, "k:", lw=1, label="at the top")
    inside.set(xlabel="days", ylabel="pore pressure (kPa)", title=base.label, xlim=(1, None))
    inside.legend(fontsize="x-small", title="depth", loc="upper right")

    lags = waves.twiny()
    for run in [run for run in runs if run.wet]:
        z, amplitude, lag = run.waves()
        fine = np.linspace(0, run.height(), 100)
        expected, late = run.theory(fine)
        colour = colours[run.label]
        waves.plot(amplitude, z / DIAMETER, "o", ms=4, color=colour, label=run.label)
        lags.plot(lag, z / DIAMETER, "s", ms=4, mfc="none", color=colour)
        waves.plot(expected, fine / DIAMETER, color=colour, lw=1)
        lags.plot(late, fine / DIAMETER, ":", color=colour, lw=1)
    waves.set(xlabel="amplitude over that at the top (filled, —)", ylabel="height (diameters)", xlim=(0, 1.4))
    lags.set(xlabel="lag (days; hollow, ...)", xlim=(0, 0.8))
    waves.legend(fontsize="x-small")

    for part, style in (((0.1, 0.25), "-"), ((0.25, 0.4), "--"), ((0.4, 0.5), ":")):
        for run in wet:
            z, velocity = run.sheared(part)
            share = velocity / np.nanmax(np.abs(velocity))
            depth.plot(share, z / DIAMETER, style, color=colours[run.label],
                       label=f"{part[0]} to {part[1]} days" if run is base else None)
    depth.set(xlabel="velocity over that of the driven layer", ylabel="height (diameters)", xlim=(-0.2, 1.1))
    depth.legend(fontsize="small", title="colours as above", title_fontsize="small")
    for panel in panels.flat:
        panel.grid(alpha=0.3)
    return figure


main()
