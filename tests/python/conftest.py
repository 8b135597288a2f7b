"""One very short run of the program, for all tests."""

import os
import subprocess
from pathlib import Path

import pytest
import xarray

HERE = Path(__file__).parent


@pytest.fixture(scope="session")
def run(tmp_path_factory):
    """Folder with the files of a run of short.toml by the program that $ESKER names."""
    program = os.environ.get("ESKER")
    assert program, "set ESKER to the program to test, or start scripts/test.sh"
    folder = tmp_path_factory.mktemp("run") / "short"
    command = [program, "run", HERE / "short.toml", "--out", folder, "--threads", "1", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="session")
def files(run):
    """The four files as users open them."""
    names = ("series", "profiles", "grains", "contacts")
    return {n: xarray.open_dataset(run / f"{n}.nc", decode_timedelta=False) for n in names}
