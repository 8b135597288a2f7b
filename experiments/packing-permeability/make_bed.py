"""Write bed.csv from a run of bed.toml: python make_bed.py RUN_FOLDER"""

import sys
from pathlib import Path

import xarray

HERE = Path(__file__).resolve().parent


def main():
    """The grains at the end of the run, as esker reads a bed."""
    grains = xarray.open_dataset(Path(sys.argv[1]) / "grains.nc", decode_timedelta=False)
    last = grains.isel(time=-1)
    height = float(last.position.sel(component="z").max())
    print(f"{last.sizes['grain']} grains, the highest centre at {1000 * height:.3f} mm")
    with open(HERE / "bed.csv", "w") as file:
        file.write("# Spheres of 1 mm, settled and pressed by 10 kPa: bed.toml; periodic along x and y, 5 mm\n")
        file.write("x,y,z,radius\n")
        for place, radius in zip(last.position.values, last.radius.values):
            file.write(",".join(f"{value:.7e}" for value in (*place, radius)) + "\n")


main()
