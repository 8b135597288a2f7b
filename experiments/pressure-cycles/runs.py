"""The runs of the sweep, read: days, rates, and the daily wave of pressure inside."""

import json
import tomllib

import numpy as np
import xarray

PERIOD = 0.5  # [s], a day
DAY, YEAR = 86400.0, 3.156e7  # [s]
LOAD, AMPLITUDE = 100e3, 60e3  # [Pa]
DIAMETER = 0.02  # [m]
# Rates are differences over so many rows of the series.
ROWS = 10
# Parts of a day over which the loop of rate against stress is averaged.
PARTS = 24
# How near to a stress counts [Pa].
NEAR = 3e3


def phases(data):
    """Names of the phases."""
    return data.phase.attrs["flag_meanings"].split()


def has_cycles(folder):
    """Whether a run has the cycles: a sweep has others, that only lay and shear a bed."""
    with xarray.open_dataset(folder / "series.nc", decode_timedelta=False) as data:
        return "cycles" in phases(data)


class Run:
    """One run: what its scene says, and its last phase."""

    def __init__(self, folder):
        whole, profiles = (
            xarray.open_dataset(folder / f"{name}.nc", decode_timedelta=False)
            for name in ("series", "profiles")
        )
        number = phases(whole).index("cycles")
        self.series, self.profiles = (data.isel(time=(data.phase == number).values) for data in (whole, profiles))
        scene = tomllib.loads(whole.attrs["scene"])
        phase = next(p for p in scene["phase"] if p["name"] == "cycles")
        value, unit = phase["shear"]["shear_stress"].split()
        self.stress = float(value) * {"Pa": 1, "kPa": 1e3}[unit]
        self.seed = scene["seed"]
        self.wet = "coupling_cycles" in whole.attrs
        self.report = json.loads(whole.attrs.get("coupling_cycles", "null"))
        self.viscosity = float(scene["water"]["liquid"]["viscosity"].split()[0])
        # The phase begins with a whole period.
        self.begin = PERIOD * round(float(self.series.time[0]) / PERIOD)
        # Height of the bed [m].
        self.height = float(self.series.wall_height.mean())
        self.case = "dry" if not self.wet else f"k = {self.report['permeability']:.0e} m²"
        if self.stress < 20e3:
            self.case += f", {self.stress / 1e3:.0f} kPa"
        self.days = self.rates()

    def rates(self):
        """Shear rate and effective stress at the top over the days; `age` is what went by since that was least."""
        time, strain = self.series.time.values, self.series.strain.values
        middle = (time[ROWS:] + time[:-ROWS]) / 2
        rate = (strain[ROWS:] - strain[:-ROWS]) / (time[ROWS:] - time[:-ROWS])
        wave = np.sin(2 * np.pi * middle / PERIOD) * (-1 if self.wet else 1)
        day = (middle - self.begin) / PERIOD
        least = 0.25 if self.wet else 0.75
        return xarray.Dataset(
            {
                "rate": ("day", rate, {"long_name": "shear rate", "units": "s-1"}),
                "carried": ("day", LOAD + AMPLITUDE * wave, {"long_name": "effective stress at the top", "units": "Pa"}),
            },
            {
                "day": ("day", day, {"long_name": "time since the water came", "units": "days"}),
                "age": ("day", (day - least + 0.5) % 1 - 0.5, {"long_name": "time since the top carried least", "units": "days"}),
            },
        )

    def diffusivity(self):
        """c_v by what was measured before the first step of the phase [m²/s]."""
        compliance = self.report["storage"] + 1 / self.report["stiffness"]
        return self.report["permeability"] / self.viscosity / compliance

    def waves(self):
        """Amplitude over that at the top, and lag [days], of the daily part of pressure, over height."""
        rows = self.profiles.isel(time=(self.profiles.time > self.begin + PERIOD).values)
        # Whole days only.
        each = round(PERIOD / float(rows.time.diff("time").median()))
        rows = rows.isel(time=slice(0, rows.sizes["time"] // each * each))
        pressure = rows.pore_pressure.dropna("z")
        turns = xarray.DataArray(np.exp(-2j * np.pi * rows.time.values / PERIOD), dims="time")
        return wave((2j * pressure * turns).mean("time") / AMPLITUDE)

    def theory(self, z):
        """The same of a bed that stays elastic, cosh κz / cosh κh."""
        kappa = np.sqrt(2j * np.pi / PERIOD / self.diffusivity())
        z = xarray.DataArray(z, dims="z", coords={"z": z})
        return wave(np.cosh(kappa * z) / np.cosh(kappa * self.height))

    def sheared(self, between):
        """Mean velocity along x [m/s] over height, in parts of the days but the first."""
        age = (self.profiles.time - self.begin) / PERIOD
        rows = (age > 1) & (age % 1 > between[0]) & (age % 1 <= between[1])
        return self.profiles.isel(time=rows.values).velocity.sel(component="x").mean("time")


def wave(turning):
    """Amplitude and lag [days] of what turns in the complex plane, counted from the top."""
    lag = -np.unwrap(np.angle(turning.values)[::-1])[::-1] / 2 / np.pi
    return xarray.Dataset({"amplitude": abs(turning), "lag": ("z", lag)})


class Case:
    """The runs that differ only by their seed."""

    def __init__(self, label, runs):
        self.label, self.runs = label, sorted(runs, key=lambda run: run.seed)
        self.wet, self.stress = runs[0].wet, runs[0].stress
        self.days = self.over_seeds(lambda run: run.days)

    def over_seeds(self, read):
        """What `read` finds in each run, along the dimension `seed`."""
        seeds = xarray.DataArray([run.seed for run in self.runs], dims="seed", name="seed")
        return xarray.concat([read(run) for run in self.runs], seeds, join="override")

    def later(self):
        """All days but the first, along `whole` days."""
        days = self.days.isel(day=(self.days.day > 1).values)
        return days.assign_coords(whole=np.floor(days.day).astype(int) + 1)

    def each_day(self):
        """Fastest rate [1/s], when [days after the top carried least], and movement [m] of each day but the first."""
        found = []
        for whole, day in self.later().groupby("whole"):
            # The last one may lack half a difference of rows.
            if day.day.max() - day.day.min() > 0.95:
                top = day.rate.argmax("day")
                height = xarray.DataArray([run.height for run in self.runs], dims="seed")
                one = {"fastest": day.rate.max("day"), "after": day.age[top], "moved": day.rate.mean("day") * PERIOD * height}
                found.append(xarray.Dataset(one).reset_coords(drop=True).assign_coords(whole=whole))
        return xarray.concat(found, "whole")

    def at(self, carried):
        """Mean rates [1/s] where the top carries so much: on its way down, and on its way up again."""
        days = self.later()
        near = abs(days.carried - carried).isel(seed=0) < NEAR
        return (days.rate.where(near & way).mean("day") for way in (days.age < 0, days.age > 0))

    def loop(self):
        """Mean rate and stress over parts of the day."""
        edges = np.linspace(-0.5, 0.5, PARTS + 1)
        return self.later().groupby_bins("age", edges, labels=(edges[1:] + edges[:-1]) / 2).mean("day")
