"""How strong the bed is at large strain, wet and dry, and what the water loses there.

python experiments/wet-shear/critical.py results/wet-shear-critical
"""

import sys
from pathlib import Path

import numpy as np
import xarray

WINDOWS = ((0.5, 1.0), (1.0, 1.5), (1.5, 2.0), (2.0, 2.5))
AREA = 0.16 * 0.16  # of the scene [m²]


def within(series, low, high):
    return series.isel(time=((series.strain > low) & (series.strain <= high)).values)


def mean(series, name):
    return float(series[name].mean())


# Points of critical.csv: wet and dry in turn, a seed each pair.
folders = sorted(Path(sys.argv[1]).glob("shear-*"), key=lambda path: int(path.name.split("-")[1]))
runs = [xarray.open_dataset(path / "series.nc", decode_timedelta=False) for path in folders]
wet, dry = runs[0::2], runs[1::2]
for window in WINDOWS:
    strong, weak = ([mean(within(run, *window), "shear_stress_top_mean") / 1e3 for run in some]
                    for some in (wet, dry))
    more = np.subtract(strong, weak)
    solid = [np.mean([mean(within(run, *window), "solid_fraction") for run in some])
             for some in (wet, dry)]
    pressure = np.mean([mean(within(run, *window), "pore_pressure_mean") for run in wet]) / 1e3
    print(f"strain {window[0]} to {window[1]}: wet {np.mean(strong):.1f} kPa, dry {np.mean(weak):.1f}, "
          f"more by {more.mean():.1f} ± {more.std(ddof=1) / len(more)**0.5:.1f}; pressure {pressure:.1f} kPa; "
          f"solid fraction {solid[0]:.4f} and {solid[1]:.4f}")
# Work per volume and strain is a stress.
for name in ("dissipated_loose", "dissipated_darcy"):
    stress = []
    for run in wet:
        late = within(run, 1.0, 2.5)
        volume = AREA * mean(late, "wall_height")
        lost, strain = (float(late[v][-1] - late[v][0]) for v in (name, "strain"))
        stress.append(lost / (volume * strain) / 1e3)
    print(f"{name}, strain 1 to 2.5, as a shear stress: {np.mean(stress):.2f} kPa")
