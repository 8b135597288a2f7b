"""The program where there is a graphics device, and where there is none."""

import os
import subprocess
from pathlib import Path

import pytest
import xarray

HERE = Path(__file__).parent
# Some hundred steps of a few grains.
SHORT = (
    "grains.count=60",
    "phase.consolidate.end.max_duration=2 ms",
    "phase.shear.end.strain=0.002",
    "output.series.every=0.2 ms",
)


def esker(*arguments, **environment):
    program = os.environ["ESKER"]
    environment = os.environ | environment
    return subprocess.run([program, *arguments], capture_output=True, text=True, env=environment)


def run(out, backend, **environment):
    sets = [f"--set={change}" for change in SHORT]
    return esker(
        "run", HERE / "short.toml", "--out", out, "--backend", backend, *sets, **environment
    )


@pytest.fixture(scope="module")
def nowhere(tmp_path_factory):
    """Environment in which the Vulkan loader finds no driver."""
    if os.uname().sysname != "Linux":
        pytest.skip("hides the drivers of Linux alone")
    empty = str(tmp_path_factory.mktemp("drivers") / "none.json")
    return {"VK_DRIVER_FILES": empty, "VK_ICD_FILENAMES": empty}


def test_a_gpu_that_is_not_there_is_an_error_with_a_remedy(tmp_path, nowhere):
    done = run(tmp_path / "run", "gpu", **nowhere)
    assert done.returncode != 0
    assert "--backend gpu" in done.stderr and "install" in done.stderr
    assert not (tmp_path / "run").exists()


def test_auto_takes_the_processor_where_there_is_no_gpu(tmp_path, nowhere):
    done = run(tmp_path / "run", "auto", **nowhere)
    assert done.returncode == 0, done.stderr
    with xarray.open_dataset(tmp_path / "run" / "series.nc", decode_timedelta=False) as series:
        assert series.attrs["backend"] == "cpu"
    assert "no graphics hardware" in esker("info", **nowhere).stdout


def test_xarray_opens_what_a_gpu_has_computed(tmp_path):
    done = run(tmp_path / "run", "gpu")
    if "no graphics device" in done.stderr:
        pytest.skip("no graphics device here")
    assert done.returncode == 0, done.stderr
    for name in ("series", "profiles", "grains", "contacts"):
        path = tmp_path / "run" / f"{name}.nc"
        with xarray.open_dataset(path, decode_timedelta=False) as data:
            assert data.attrs["backend"] == "gpu"
            # Name, interface and driver; the name stands in `esker info` too.
            assert data.attrs["device"].split(" (")[0] in esker("info").stdout
            assert data.sizes["time"] > 1
