"""Is a run of small-shear right? Energy that is accounted for, and a sane friction.

python .ci/check_small_shear.py RUN_FOLDER
"""

import sys
from pathlib import Path

import xarray

# The residual over the work of the drive, the bound that poster-shear has to keep too.
RESIDUAL = 1e-3
# Independent runs give 0.355 +- 0.03 at a friction coefficient of 0.5; this bed is small.
FRICTION = (0.30, 0.42)


def main():
    """Check the series in the folder that the command line names."""
    series = xarray.open_dataset(Path(sys.argv[1]) / "series.nc", decode_timedelta=False)
    names = series.phase.attrs["flag_meanings"].split()
    shear = series.isel(time=(series.phase == names.index("shear")).values)
    strain = float(shear.strain[-1])
    assert strain > 0.99, f"sheared to a strain of {strain} only"

    # Both are sums since the phase began: the last row is the whole of it.
    residual = abs(float(shear.energy_residual[-1] / shear.work_drive[-1]))
    assert residual < RESIDUAL, f"energy: residual of {residual:.2e} of the drive's work"

    late = shear.isel(time=(shear.strain > 0.5).values)
    friction = float(late.shear_stress_top_mean.mean() / late.normal_stress_top_mean.mean())
    low, high = FRICTION
    assert low < friction < high, f"friction {friction:.3f} is not within {low} to {high}"
    print(f"small-shear: energy residual {residual:.1e} of the work, friction {friction:.3f}")


main()
