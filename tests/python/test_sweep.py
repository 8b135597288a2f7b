"""Does xarray open what a sweep collects, and does its command line do what it says?"""

import itertools
import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
import xarray

from labels import check_labels

SCENE = Path(__file__).parent / "short.toml"
STRESS = "phase.consolidate.top.normal_stress,phase.shear.top.normal_stress"
RATE = "phase.shear.shear.strain_rate"
SHORT = ["--set", "phase.shear.end.strain=0.02"]


def sweep(*arguments):
    """A finished `esker sweep`."""
    command = [os.environ["ESKER"], "sweep", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


def collected(folder):
    return xarray.open_dataset(folder / "sweep.nc", decode_timedelta=False)


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    """Folder of two stresses times two rates."""
    folder = tmp_path_factory.mktemp("sweep") / "grid"
    vary = ["--vary", f"{STRESS}=5,10 kPa", "--vary", f"{RATE}=1,2 1/s"]
    done = sweep(SCENE, *SHORT, *vary, "--out", folder, "--jobs", 2)
    assert done.returncode == 0, done.stderr
    assert "4 of 4 points" in done.stdout
    assert "4 of 4 points done, 0 running, 0 failed, nothing left" in done.stderr
    return folder


def test_a_grid_has_dimensions_with_units(grid):
    data = collected(grid)
    assert data.normal_stress.attrs["units"] == "Pa"
    assert data.strain_rate.attrs["units"] == "s-1"
    assert list(data.normal_stress) == [5e3, 1e4] and list(data.strain_rate) == [1, 2]
    assert data.dilation.dims == ("normal_stress", "strain_rate", "row")
    assert data.dilation_late.dims == ("normal_stress", "strain_rate")
    check_labels(data)
    for name in ("version", "commit", "machine", "backend", "device", "scene"):
        assert data.attrs[name], name
    assert (data.status == 0).all()


def test_series_are_those_of_the_runs_padded_at_their_end(grid):
    data = collected(grid)
    assert {"time", "phase", "strain"} <= set(data.dilation.coords)
    lengths = set()
    for stress, rate in itertools.product(data.normal_stress, data.strain_rate):
        one = data.sel(normal_stress=stress, strain_rate=rate)
        rows = int(one.time.notnull().sum())
        lengths.add(rows)
        assert one.time[rows:].isnull().all() and (one.phase[rows:] == -1).all()
        assert (np.diff(one.time[:rows]) > 0).all()
        run = xarray.open_dataset(grid / str(one.folder.item()) / "series.nc", decode_timedelta=False)
        assert one.dilation_final == run.dilation[-1]
        assert (one.dilation[rows - run.sizes["time"] + 1 : rows].values == run.dilation[1:]).all()
        # The mean since the row before, weighted by its length: exact.
        late = run.time > run.time[-1] - 0.2 * (run.time[-1] - run.time[0])
        width = run.time.diff("time")
        mean = run.normal_stress_top_mean.where(late, drop=True).weighted(width).mean()
        assert np.isclose(one.normal_stress_top_late, mean, rtol=1e-12)
    assert len(lengths) > 1


def test_what_is_done_is_not_run_again(grid):
    before = (grid / "shear-0" / "state.h5").stat().st_mtime_ns
    done = sweep("--out", grid)
    assert done.returncode == 0 and "4 of 4 points" in done.stdout, done.stderr
    assert (grid / "shear-0" / "state.h5").stat().st_mtime_ns == before
    other = sweep(SCENE, "--vary", f"{RATE}=1,3 1/s", "--out", grid)
    assert other.returncode == 1 and "another sweep" in other.stderr


def test_runs_are_printed_and_collected_afterwards(grid, tmp_path):
    printed = sweep("--out", grid, "--print", "commands").stdout
    assert printed.count("--only") == 6 and "--collect" in printed
    script = tmp_path / "job.sh"
    script.write_text(sweep("--out", grid, "--print", "slurm").stdout)
    assert subprocess.run(["bash", "-n", script]).returncode == 0
    for line in printed.splitlines():
        if not line.startswith("#"):
            words = line.split()[2:]
            done = sweep(*words)
            assert done.returncode == 0, done.stderr


def test_hypercubes_lie_along_points(tmp_path):
    vary = ["--vary", f"{RATE}=1..4 1/s log", "--vary", "phase.shear.friction=0.2..0.6"]
    cube = ["--hypercube", 3, "--hypercube-seed", 5]
    done = sweep(SCENE, *SHORT, *vary, *cube, "--out", tmp_path / "cube")
    assert done.returncode == 0, done.stderr
    data = collected(tmp_path / "cube")
    assert data.dilation_late.dims == ("point",)
    # `friction` is a variable of the series.
    assert {"strain_rate", "shear_friction"} <= set(data.dilation_late.coords)
    check_labels(data.drop_vars("point"))


def test_failures_are_named_and_stop_no_other_point(tmp_path):
    top = 'phase.consolidate.top={ velocity = "1 mm/s" },{ velocity = "10 m/s" }'
    end = ["--set", 'phase.consolidate.end={ duration = "20 ms" }']
    done = sweep(SCENE, *SHORT, *end, "--vary", top, "--out", tmp_path / "half")
    assert done.returncode == 1
    assert "1 of 2 points are not done" in done.stderr
    assert "point 1: phase.consolidate.top" in done.stderr and "went through the bed" in done.stderr
    data = collected(tmp_path / "half")
    assert list(data.status) == [0, 1]
    assert np.isfinite(data.dilation_late[0]) and np.isnan(data.dilation_late[1])


@pytest.mark.parametrize("ended", [signal.SIGKILL, signal.SIGINT])
def test_what_was_broken_off_goes_on(tmp_path, ended):
    folder = tmp_path / "broken"
    long = [SCENE, "--set", "phase.shear.end.strain=2.0", "--vary", f"{RATE}=1,5 1/s"]
    program = subprocess.Popen(
        [os.environ["ESKER"], "sweep", *map(str, long), "--out", folder, "--jobs", "2"],
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 120
    while not (folder / "shear-0" / "series.nc").exists():
        assert program.poll() is None and time.monotonic() < deadline
        time.sleep(0.01)
    time.sleep(0.2)
    program.send_signal(ended)
    said = program.communicate()[1]
    assert not (folder / "shear-0" / "outcome.json").exists(), "it was too late"
    if ended == signal.SIGINT:
        assert program.returncode == 130 and f"esker sweep --out {folder}" in said
    bed = (folder / "consolidate-0" / "state.h5").stat().st_mtime_ns
    done = sweep("--out", folder)
    assert done.returncode == 0, done.stderr
    assert (folder / "consolidate-0" / "state.h5").stat().st_mtime_ns == bed
    # Only what was told to stop knows where it stood; what was killed begins its phase again.
    assert (folder / "shear-0" / "before-1").exists() == (ended == signal.SIGINT)
    data = collected(folder)
    time_of = data.time.isel(strain_rate=0).dropna("row")
    assert (np.diff(time_of) > 0).all() and np.diff(time_of).max() < 1.5e-3
    assert abs(data.strain_final[0] - 2) < 1e-2
    if ended == signal.SIGKILL:
        alone = tmp_path / "alone"
        command = [os.environ["ESKER"], "run", SCENE, "--out", alone, "--quiet", "--threads", "1"]
        sets = ["--set", "phase.shear.end.strain=2.0", "--set", f"{RATE}=1 1/s"]
        assert subprocess.run(command + sets).returncode == 0
        own = xarray.open_dataset(alone / "series.nc", decode_timedelta=False)
        rows = own.sizes["time"]
        for name in ("dilation", "shear_stress_top_mean", "kinetic_energy"):
            mine = data[name].isel(strain_rate=0)[:rows]
            assert np.array_equal(mine, own[name], equal_nan=True), name


def test_wrong_paths_are_refused_before_anything_runs(tmp_path):
    done = sweep(SCENE, "--vary", "phase.shear.top.normal_stres=1,2 kPa", "--out", tmp_path / "no")
    assert done.returncode == 1
    assert "did you mean `normal_stress`?" in done.stderr
    assert "--vary phase.shear.top.normal_stres=1 kPa" in done.stderr
    assert not (tmp_path / "no").exists()
