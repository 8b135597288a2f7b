"""Very short runs of the program, for all tests."""

import os
import subprocess
from pathlib import Path

import pytest
import xarray

HERE = Path(__file__).parent


def run_of(scene, folder):
    """Folder with the files of a run of a scene by the program that $ESKER names."""
    program = os.environ.get("ESKER")
    assert program, "set ESKER to the program to test, or start scripts/test.sh"
    command = [program, "run", HERE / scene, "--out", folder, "--threads", "1", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="session")
def run(tmp_path_factory):
    """Folder with the files of a run of short.toml."""
    return run_of("short.toml", tmp_path_factory.mktemp("run") / "short")


@pytest.fixture(scope="session")
def water(tmp_path_factory):
    """The two files of a run of water.toml as users open them."""
    folder = run_of("water.toml", tmp_path_factory.mktemp("run") / "water")
    names = ("series", "fluid")
    return {n: xarray.open_dataset(folder / f"{n}.nc", decode_timedelta=False) for n in names}


@pytest.fixture(scope="session")
def files(run):
    """The four files as users open them."""
    names = ("series", "profiles", "grains", "contacts")
    return {n: xarray.open_dataset(run / f"{n}.nc", decode_timedelta=False) for n in names}
