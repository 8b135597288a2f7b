"""Thin series.nc of a finished run to reference.csv: means over 0.01 of strain.

    python experiments/poster-shear/reference.py results/poster-shear > reference.csv
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr

series = xr.open_dataset(Path(sys.argv[1]) / "series.nc", decode_timedelta=False)
shear = series.sel(time=series.strain.values > 0)
friction = shear.shear_stress_top_mean / shear.normal_stress_top_mean
residual = shear.energy_residual / shear.work_drive
columns = {
    "strain": shear.strain,
    "friction": friction,
    "dilation": shear.dilation,
    "solid_fraction": shear.solid_fraction,
    "coordination_number": shear.coordination_number,
    "wall_height_m": shear.wall_height,
    "residual_over_drive": residual,
}
bins = np.minimum((shear.strain.values / 0.01).astype(int), 99)
print(",".join(columns))
for k in range(100):
    here = bins == k
    if here.any():
        print(",".join(f"{column.values[here].mean():.6g}" for column in columns.values()))
