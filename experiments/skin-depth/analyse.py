"""A wave of pressure that sinks into a bed against the exact one: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray

# What the scene says.
AMPLITUDE, PERIOD = 1e5, 86400.0  # [Pa], [s]
PERMEABILITY, POROSITY = 1e-16, 0.3  # [m2], [-]
VISCOSITY, COMPRESSIBILITY = 1.792e-3, 5.09e-10  # [Pa s], [1/Pa]
DAY = 86400.0


def main():
    """Compare, print the errors, draw figure.png into the folder."""
    folder = Path(sys.argv[1])
    fluid = xarray.open_dataset(folder / "fluid.nc", decode_timedelta=False).isel(x=0, y=0)
    height = float(fluid.z_bounds.max())
    diffusivity = PERMEABILITY / (VISCOSITY * POROSITY * COMPRESSIBILITY)
    skin = np.sqrt(diffusivity * PERIOD / np.pi)
    omega = 2 * np.pi / PERIOD

    # The last period: its Fourier component at the frequency of the sun.
    last = fluid.isel(time=fluid.time > fluid.time[-1] - PERIOD * (1 - 1e-6)).pressure
    basis = np.stack([np.sin(omega * last.time), np.cos(omega * last.time), np.ones(last.sizes["time"])], axis=1)
    sine, cosine, _ = np.linalg.lstsq(basis, last.values, rcond=None)[0]
    found = (sine + 1j * cosine) / AMPLITUDE
    depth = height - fluid.z.values
    known = wave(depth, height, skin)
    near = depth < 3 * skin
    print(f"skin depth {skin:.3f} m; errors down to three of them:")
    print(f"amplitude: at most {np.abs(np.abs(found) - np.abs(known))[near].max():.1e} of that at the top")
    lag = -np.angle(found / known)[near] / omega
    print(f"delay: at most {np.abs(lag).max():.0f} s of a day")
    slope = np.polyfit(depth[near], np.log(np.abs(found[near])), 1)[0]
    print(f"skin depth from the amplitudes: {-1 / slope:.3f} m")

    figure, (left, middle, right) = plt.subplots(
        1, 3, figsize=(13, 4.4), layout="constrained", width_ratios=(1, 1, 1.3)
    )
    figure.suptitle(fluid.attrs["title"])
    fine = np.linspace(0, height, 300)
    hours = (0, 3, 6, 9)
    for hour, colour in zip(hours, plt.cm.viridis(np.linspace(0.1, 0.85, len(hours)))):
        row = fluid.sel(time=5 * DAY + 3600 * hour, method="nearest")
        phase = np.exp(1j * omega * float(row.time))
        left.plot((AMPLITUDE * wave(fine, height, skin) * phase).imag / 1e3, fine, color=colour, lw=1)
        left.plot(row.pressure / 1e3, depth, "o", ms=3, color=colour, label=f"{hour} h")
    left.set(xlabel="pressure (kPa)", ylabel="depth (m)", ylim=(12, 0))
    left.legend(title="on the sixth day", fontsize="small", loc="lower right")
    middle.semilogx(np.abs(wave(fine, height, skin)), fine, "k", lw=1, label="exact")
    middle.semilogx(np.abs(found), depth, "o", ms=3, label="esker")
    middle.axhline(skin, color="0.5", lw=0.8, ls="--")
    middle.text(1.2e-2, skin - 0.15, "skin depth", color="0.4", fontsize="small")
    middle.set(xlabel="amplitude over that at the top", ylim=(12, 0), xlim=(1e-2, 1.2))
    middle.legend(fontsize="small", loc="lower right")
    days = fluid.time / DAY
    edges = np.append(fluid.z_bounds[:, 0], fluid.z_bounds[-1, 1])
    mesh = right.pcolormesh(days, height - fluid.z, fluid.pressure.T / 1e3, cmap="RdBu_r", vmin=-100, vmax=100,
                            shading="nearest", rasterized=True)
    right.set(xlabel="time (days)", ylabel="depth (m)", ylim=(12, 0))
    figure.colorbar(mesh, ax=right, label="pressure (kPa)")
    for axes in (left, middle):
        axes.grid(alpha=0.3)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def wave(depth, height, skin):
    """Amplitude and phase at a depth below the top, over a tight base at `height`; as a half-space
    where the base is far."""
    k = (1 + 1j) / skin
    return np.cosh(k * (height - depth)) / np.cosh(k * height)


main()
