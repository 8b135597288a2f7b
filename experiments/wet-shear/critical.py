"""How much stronger water makes a bed that dilates no more, and where its work goes there.

python experiments/wet-shear/critical.py results/wet-shear-critical
"""

import sys
from pathlib import Path

import numpy as np
import xarray

# Of the strain from 1 on; what comes before is the way from dry to wet.
WINDOWS = ((1.05, 1.6), (1.6, 2.2), (1.05, 2.2))
AREA = 0.16 * 0.16  # of the scene [m²]


def within(series, low, high):
    return series.isel(time=((series.strain > low) & (series.strain <= high)).values)


def means(runs, window, name):
    return np.array([float(within(run, *window)[name].mean()) for run in runs])


def told(values):
    return f"{values.mean():.2f} ± {values.std(ddof=1) / len(values) ** 0.5:.2f}"


# Points of critical.csv: wet and dry in turn, a seed each pair.
folders = sorted(Path(sys.argv[1]).glob("critical-*"), key=lambda path: int(path.name.split("-")[1]))
runs = [xarray.open_dataset(path / "series.nc", decode_timedelta=False) for path in folders]
wet, dry = runs[0::2], runs[1::2]
for window in WINDOWS:
    strong, weak = (means(some, window, "shear_stress_top_mean") / 1e3 for some in (wet, dry))
    print(
        f"strain {window[0]} to {window[1]} [kPa]: wet {told(strong)}, dry {told(weak)}, "
        f"more by {told(strong - weak)}; "
        f"pressure {told(means(wet, window, 'pore_pressure_mean') / 1e3)}"
    )
print("each seed:", np.round(strong - weak, 1))
# Work per volume and strain is a stress.
for name in ("dissipated_loose", "dissipated_darcy"):
    stress = []
    for run in wet:
        late = within(run, *WINDOWS[-1])
        volume = AREA * float(late.wall_height.mean())
        lost, strain = (float(late[v][-1] - late[v][0]) for v in (name, "strain"))
        stress.append(lost / (volume * strain) / 1e3)
    print(f"{name} as a shear stress: {told(np.array(stress))} kPa")
