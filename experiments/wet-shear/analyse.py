"""Suction and hardening of sheared wet beds against theory: python analyse.py FOLDER

FOLDER holds the runs of runs.csv, one folder each, at any depth: that of `esker sweep`.
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

# Strain over which the bed dilates steadily, and from which on it is taken to be in its critical state.
EARLY, LATE = (0.02, 0.1), (0.5, 1.0)
# Strain over which curves are averaged.
WINDOW = 0.02
DIAMETER = 0.02  # [m]
LOAD = 100e3  # normal stress [Pa]
# Solid fraction between those of the loose and the dense bed.
DENSE = 0.61


class Run:
    """One run: what its scene says, and what its shear did."""

    def __init__(self, folder):
        whole, self.grains, self.profiles, fluid = (
            xarray.open_dataset(folder / f"{name}.nc", decode_timedelta=False)
            for name in ("series", "grains", "profiles", "fluid")
        )
        self.number = phases(whole).index("shear")
        self.series = whole.isel(time=(whole.phase == self.number).values)
        scene = tomllib.loads(whole.attrs["scene"])
        phase = next(p for p in scene["phase"] if p["name"] == "shear")
        self.rate = float(phase["shear"]["strain_rate"].split()[0])
        self.seed = int(whole.attrs["seed"])
        self.dense = float(self.series.solid_fraction[0]) > DENSE
        self.wet = "coupling_shear" in whole.attrs
        self.viscosity, self.permeability = np.nan, np.inf
        if not self.wet:
            return
        self.report = json.loads(whole.attrs["coupling_shear"])
        self.viscosity = float(scene["water"]["liquid"]["viscosity"].split()[0])
        self.permeability = self.report["permeability"]
        top = phase.get("water", {}).get("top", scene["water"]["sides"]["top"])
        self.sealed = top == "tight"
        self.fine = float(fluid.x[1] - fluid.x[0]) < 1.5 * DIAMETER

    def within(self, bounds, data=None):
        """Rows of a strain."""
        data = self.series if data is None else data
        return data.isel(time=((data.strain > bounds[0]) & (data.strain <= bounds[1])).values)

    def mean(self, name, bounds):
        """Mean of a variable over a strain."""
        return float(self.within(bounds)[name].mean())

    def dilatancy(self, bounds):
        """Volumetric over shear strain."""
        rows = self.within(bounds)
        return float(np.polyfit(rows.strain, rows.dilation, 1)[0])

    def curve(self, name):
        """A variable over strain, in means over WINDOW of it."""
        edges = np.arange(0, float(self.series.strain[-1]) + WINDOW / 2, WINDOW)
        rows = self.series.groupby_bins("strain", edges)
        return edges[:-1] + WINDOW / 2, rows.mean()[name].values

    def height(self, bounds):
        """Mean height of the bed."""
        return self.mean("wall_height", bounds)

    def line(self, bounds):
        """Suction at the base of a bed that dilates as this one, at all heights alike [Pa]."""
        flow = self.viscosity * self.dilatancy(bounds) * self.rate / self.permeability
        return flow * self.height(bounds) ** 2 / 2

    def risen(self, bounds):
        """Middles of layers [m], and mean upward velocity of the grains in them [m/s]."""
        rows = self.within(bounds, self.grains.isel(time=(self.grains.phase == self.number).values))
        first, last = rows.isel(time=0), rows.isel(time=-1)
        z = first.position.sel(component="z").values
        way = (last.displacement - first.displacement).sel(component="z").values
        edges = np.arange(0, z.max() + DIAMETER, DIAMETER)
        number = np.digitize(z, edges) - 1
        mean = np.bincount(number, way) / np.maximum(np.bincount(number), 1)
        return (edges + DIAMETER / 2)[: len(mean)], mean / float(last.time - first.time)

    def suction_of_grains(self, bounds):
        """Suction at heights [m] that lets all the water in that the rising grains make room for."""
        z, velocity = self.risen(bounds)
        z, velocity = np.append(z, self.height(bounds)), np.append(velocity, velocity[-1])
        pieces = np.diff(z) * (velocity[1:] + velocity[:-1]) / 2
        above = np.append(np.cumsum(pieces[::-1])[::-1], 0)
        return z, self.viscosity / self.permeability * above


def main():
    """Read all runs, print what the page quotes, draw."""
    folder = Path(sys.argv[1])
    paths = sorted(folder.glob("**/series.nc"))
    # A sweep has runs that only lay a bed.
    runs = [Run(path.parent) for path in paths if "shear" in phases(xarray.open_dataset(path, decode_timedelta=False))]
    dry = {(run.dense, run.rate, run.seed): run for run in runs if not run.wet}
    wet = [run for run in runs if run.wet]
    if not wet or any((run.dense, run.rate, run.seed) not in dry for run in wet):
        raise SystemExit(f"{folder} lacks runs, of which each wet one needs a dry one; make those of runs.csv first")
    wet.sort(key=lambda run: (not run.dense, run.sealed, run.fine, run.seed, run.rate, -run.permeability))
    tables(wet, dry)
    figure = draw(wet, dry)
    figure.savefig(folder / "figure.png", dpi=100)
    print(f"drawn: {folder / 'figure.png'}")


def phases(data):
    """Names of the phases."""
    return data.phase.attrs["flag_meanings"].split()


def tables(wet, dry):
    """What the page quotes."""
    print(f"over strain {EARLY[0]} to {EARLY[1]}, stresses in kPa:")
    print("| bed | k (m²) | rate (1/s) | seed | De | ψ | τ | τ - τ dry | mean pressure | base pressure | line | by grains |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for run in [*dry.values(), *wet]:
        stress = run.mean("shear_stress_top_mean", EARLY)
        cells = ["dense" if run.dense else "loose"]
        cells += ["dry"] if not run.wet else [f"{run.permeability:.0e}" + (", cells of 1 d" if run.fine else "")]
        if run.wet and run.sealed:
            cells[-1] = "sealed"
        cells += [f"{run.rate:g}", f"{run.seed}"]
        if run.wet:
            cells.append("∞" if run.sealed else f"{run.report['drainage_time'] * run.rate:.1e}")
        else:
            cells.append("")
        cells += [f"{run.dilatancy(EARLY):.3f}", f"{stress / 1e3:.1f}"]
        if run.wet:
            cells.append(f"{hardening(run, dry, EARLY) / 1e3:+.1f}")
            cells += [f"{run.mean(f'pore_pressure_{where}', EARLY) / 1e3:.1f}" for where in ("mean", "base")]
            by_grains = "" if run.sealed else f"{-run.suction_of_grains(EARLY)[1][0] / 1e3:.1f}"
            cells += ["" if run.sealed else f"{-run.line(EARLY) / 1e3:.1f}", by_grains]
        else:
            cells += [""] * 5
        print("| " + " | ".join(cells) + " |")
    for run in wet:
        most = float(run.series.vapour_volume.max()) / (0.16**2 * run.height(EARLY))
        # Not where it opens for a moment in a cell.
        if most > 5e-5:
            first = float(run.series.strain[(run.series.vapour_volume > 0).values.argmax()])
            print(f"vapour in {name(run)}, {run.rate:g} 1/s, seed {run.seed}: from strain {first:.4f} on, at most {100 * most:.2f} % of the bed")
    for run in [run for run in wet if float(run.series.strain[-1]) > 0.9]:
        partner = dry[run.dense, run.rate, run.seed]
        for data, what in ((run, name(run)), (partner, "the same dry")):
            rows = data.within(LATE)
            print(f"strain {LATE[0]} to {LATE[1]}, {'dense' if run.dense else 'loose'}, {what}: "
                  f"τ {float(rows.shear_stress_top_mean.mean()) / 1e3:.1f} kPa, ψ {data.dilatancy(LATE):+.4f}, "
                  f"solid fraction {float(rows.solid_fraction.mean()):.3f}"
                  + (f", mean pressure {float(rows.pore_pressure_mean.mean()) / 1e3:+.1f} ± "
                     f"{float(rows.pore_pressure_mean.std()) / 1e3:.1f} kPa" if data.wet else ""))
    base = scene_of(wet)
    print(f"M {base.report['stiffness']:.3e} Pa, B {base.report['B']:.3f}, S M {base.report['S_M']:.4f}, "
          f"drained in {base.report['drainage_time']:.2e} s")
    for dense in (True, False):
        each = [run for run in runs_of(wet, dry) if run.dense == dense]
        fractions = [float(run.series.solid_fraction[0]) for run in each]
        print(f"{'dense' if dense else 'loose'}: solid fraction {min(fractions):.3f} to {max(fractions):.3f} at first")
    slope = slope_of_hardening(wet, dry)
    frictions = [run.mean("shear_stress_top_mean", EARLY) / run.mean("normal_stress_top_mean", EARLY)
                 for run in dry.values() if run.dense]
    print(f"hardening over mean suction, all dense runs: {slope:.2f}; friction of the dense dry beds "
          f"{min(frictions):.2f} to {max(frictions):.2f}")
    sealed = next((run for run in wet if run.sealed), None)
    if sealed:
        partner = dry[True, sealed.rate, sealed.seed]
        compliance = sealed.report["storage"] + 1 / sealed.report["stiffness"]
        for strain in (0.002, 0.003, 0.004):
            near = np.abs(partner.series.strain.values - strain).argmin()
            theory = -float(partner.series.dilation[near]) / compliance
            near = np.abs(sealed.series.strain.values - strain).argmin()
            print(f"undrained, strain {strain}: {float(sealed.series.pore_pressure_mean[near]) / 1e3:.1f} kPa, "
                  f"by the dry bed's dilation {theory / 1e3:.1f} kPa")


def runs_of(wet, dry):
    return [*wet, *dry.values()]


def scene_of(wet):
    """The run of the scene as it is."""
    return next(r for r in wet if r.dense and not r.sealed and r.permeability == 1e-15 and r.rate == 0.5)


def name(run):
    """How a run is called."""
    return "sealed" if run.sealed else f"k = {run.permeability:.0e} m²"


def hardening(run, dry, bounds):
    """Shear stress beyond that of the same dry bed at the same rate [Pa]."""
    partner = dry[run.dense, run.rate, run.seed]
    return run.mean("shear_stress_top_mean", bounds) - partner.mean("shear_stress_top_mean", bounds)


def slope_of_hardening(wet, dry):
    """Through the origin, of all dense runs."""
    dense = [run for run in wet if run.dense]
    suction = np.array([-run.mean("pore_pressure_mean", EARLY) for run in dense])
    gained = np.array([hardening(run, dry, EARLY) for run in dense])
    return float(suction @ gained / (suction @ suction))


def draw(wet, dry):
    """Six panels."""
    figure, panels = plt.subplots(2, 3, figsize=(14, 8), layout="constrained")
    figure.suptitle(wet[0].series.attrs["title"])
    (stress, pressure, suction), (gain, depth, start) = panels
    plain = [r for r in wet if r.dense and r.seed == 1 and r.rate == 0.5 and not r.fine and not r.sealed]
    plain.sort(key=lambda run: -run.permeability)
    colours = dict(zip((r.permeability for r in plain), plt.cm.viridis(np.linspace(0, 0.9, len(plain)))))
    base = scene_of(wet)
    partner = dry[True, 0.5, 1]

    stress.plot(*scaled(partner.curve("shear_stress_top_mean")), "k", lw=1, label="dry")
    for run in plain:
        stress.plot(*scaled(run.curve("shear_stress_top_mean")), color=colours[run.permeability], label=name(run))
        strain, p = scaled(run.curve("pore_pressure_base"))
        pressure.plot(strain, p, color=colours[run.permeability])
    for run in wet:
        if not run.dense and run.permeability == base.permeability and run.seed == 1:
            stress.plot(*scaled(run.curve("shear_stress_top_mean")), color="C3", lw=1, label="loose, k = 1e-15 m²")
            pressure.plot(*scaled(run.curve("pore_pressure_base")), color="C3", lw=1)
    if (False, 0.5, 1) in dry:
        stress.plot(*scaled(dry[False, 0.5, 1].curve("shear_stress_top_mean")), color="C3", lw=1, ls=":", label="loose, dry")
    stress.set(xlabel="shear strain", ylabel="shear stress (kPa)", ylim=(0, None))
    stress.legend(fontsize="x-small")
    pressure.set(xlabel="shear strain", ylabel="pore pressure at the base (kPa)")

    markers = {(1, 0.5): "o", (1, 0.25): "v", (1, 1.0): "^", (2, 0.5): "s", (3, 0.5): "D"}
    told = {"o": "0.5 1/s", "v": "0.25 1/s", "^": "1 1/s", "s": "0.5 1/s, seed 2", "D": "0.5 1/s, seed 3"}
    x = np.geomspace(1, 3000, 50)
    suction.plot(x, x, "k", lw=1, label="μψγ̇h²/2k")
    suction.axhline(100, color="C3", lw=1, ls="--", label="the water breaks")
    for run in wet:
        if run.sealed or not run.dense or run.fine:
            continue
        mark = markers[run.seed, run.rate]
        there = run.line(EARLY) / 1e3
        found = -run.mean("pore_pressure_base", EARLY) / 1e3
        colour = colours[run.permeability]
        suction.plot(there, found, mark, color=colour, label=told.pop(mark, None))
        suction.plot(there, run.suction_of_grains(EARLY)[1][0] / 1e3, mark, mfc="none", color=colour)
        if run.seed == 1 and run.rate == 0.5:
            deborah = f"De {run.report['drainage_time'] * run.rate:.0e}"
            suction.annotate(deborah, (there, found), fontsize="x-small", xytext=(4, -10), textcoords="offset points")
    suction.plot([], [], "ko", mfc="none", label="by the rising grains")
    suction.set(xscale="log", yscale="log", ylim=(1, 1500), xlim=(3, 2000),
                xlabel="μψγ̇h²/2k, ψ of the run (kPa)", ylabel="suction at the base (kPa)")
    suction.legend(fontsize="x-small", loc="lower right")

    slope = slope_of_hardening(wet, dry)
    for run in wet:
        if run.fine:
            continue
        each = ((EARLY, None),) if float(run.series.strain[-1]) < 0.9 else ((EARLY, None), (LATE, "none"))
        for bounds, fill in each:
            mark = "*" if run.sealed else markers[run.seed, run.rate]
            colour = "C3" if not run.dense else colours[run.permeability] if not run.sealed else "k"
            gain.plot(-run.mean("pore_pressure_mean", bounds) / 1e3, hardening(run, dry, bounds) / 1e3,
                      mark, color=colour, mfc=fill or colour)
    gain.plot([0, 100], [0, 100 * slope], "k", lw=1, label=f"{slope:.2f} of it")
    gain.plot([], [], "ko", mfc="none", label="critical state, strain 0.5 to 1")
    gain.plot([], [], "o", color="C3", label="loose")
    gain.set(xlabel="mean suction (kPa)", ylabel="shear stress over that of the dry bed (kPa)")
    gain.legend(fontsize="small")

    for run in plain[1:-1]:
        rows = run.within(EARLY, run.profiles)
        colour = colours[run.permeability]
        depth.plot(rows.pore_pressure.mean("time") / 1e3, rows.z / DIAMETER, "o", ms=3, color=colour, label=name(run))
        z, by_grains = run.suction_of_grains(EARLY)
        depth.plot(-by_grains / 1e3, z / DIAMETER, color=colour, lw=1)
        h = run.height(EARLY)
        fine = np.linspace(0, h, 100)
        depth.plot(-run.line(EARLY) / 1e3 * (1 - (fine / h) ** 2), fine / DIAMETER, ":", color=colour, lw=1)
    depth.set(xlabel="pore pressure (kPa)", ylabel="height (diameters)", xlim=(-160, 0))
    depth.legend(fontsize="x-small", title="— by the rising grains,\n... at all heights alike", title_fontsize="x-small")

    for run in wet:
        if run.sealed:
            rows = run.series.where(run.series.strain < 0.01, drop=True)
            start.plot(100 * rows.strain, rows.pore_pressure_mean / 1e3, ".-", color="C0", label="sealed bed")
            compliance = run.report["storage"] + 1 / run.report["stiffness"]
            rows = partner.series.where(partner.series.strain < 0.01, drop=True)
            start.plot(100 * rows.strain, -rows.dilation / compliance / 1e3, "k", lw=1, label="-ε(dry) / (φβ + 1/M)")
    start.axhline(-100, color="C3", lw=1, ls="--", label="the water breaks")
    start.set(xlabel="shear strain (%)", ylabel="mean pore pressure (kPa)", ylim=(-160, 40))
    start.legend(fontsize="small")
    for panel in panels.flat:
        panel.grid(alpha=0.3)
    return figure


def scaled(curve):
    """Strain, and stresses in kPa."""
    strain, values = curve
    return strain, values / 1e3


main()
