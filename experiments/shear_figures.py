"""Draw the figure of a shear experiment from the files that `esker run` wrote."""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files only: no display needed

import matplotlib.pyplot as plt
import numpy as np
import xarray


def main():
    """Draw figure.png into the folder of a run, which the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path, help="folder with series.nc, profiles.nc, grains.nc")
    folder = parser.parse_args().run

    series, profiles, grains = (
        xarray.open_dataset(folder / f"{name}.nc", decode_timedelta=False)
        for name in ("series", "profiles", "grains")
    )
    figure = draw(series, profiles, grains)
    figure.savefig(folder / "figure.png", dpi=150)
    print(f"drawn: {folder / 'figure.png'}")


def draw(series, profiles, grains):
    """Friction, dilation and velocity of the sheared bed, and a picture of its grains."""
    shear = series.where(abs(series.strain) > 0, drop=True)
    if shear.sizes["time"] == 0:
        raise SystemExit("the bed was not sheared: there is nothing to draw")
    figure = plt.figure(figsize=(11, 6), layout="constrained")
    figure.suptitle(series.attrs["title"])
    axes = figure.subplot_mosaic("GF;GD;GV", width_ratios=(3, 2))
    draw_grains(axes["G"], grains.isel(time=-1))
    draw_stress(axes["F"], shear)
    draw_dilation(axes["D"], shear)
    draw_velocity(axes["V"], profiles)
    axes["D"].sharex(axes["F"])
    return figure


def draw_stress(axes, shear):
    """Shear stress over normal stress at the top, against strain."""
    axes.plot(shear.strain, shear.friction, lw=0.8)
    axes.axhline(0, color="0.5", lw=0.8)  # shear towards -x has a negative friction
    axes.set(xlabel="shear strain", ylabel="friction τ/σ")
    axes.grid(alpha=0.3)


def draw_dilation(axes, shear):
    """Volumetric strain of the bed against strain."""
    axes.plot(shear.strain, 100 * shear.dilation, lw=0.8)
    axes.set(xlabel="shear strain", ylabel="dilation (%)")
    axes.grid(alpha=0.3)


def draw_velocity(axes, profiles):
    """Velocity along x against height, mean over the last half of the strain."""
    last = profiles.where(abs(profiles.strain) > 0.5 * abs(profiles.strain[-1]), drop=True)
    velocity = last.velocity.sel(component="x").mean("time")
    axes.plot(1000 * velocity, 100 * profiles.z, marker=".")
    axes.set(xlabel="velocity (mm/s)", ylabel="height (cm)")
    axes.grid(alpha=0.3)


def draw_grains(axes, grains):
    """The bed from the front, a little from the right and above, coloured by pressure."""
    pressure = grains.pressure.values / 1000
    # Few grains carry much: the scale ends where the strongest 2 % begin.
    scale = plt.cm.ScalarMappable(plt.Normalize(0, np.percentile(pressure, 98)), "plasma")
    colour = scale.to_rgba(pressure)[:, :3]
    axes.imshow(render(grains.position.values, grains.radius.values, colour))
    axes.set_axis_off()
    bar = axes.inset_axes((0.2, -0.07, 0.6, 0.03))
    label = f"pressure on the grains at strain {grains.strain.item():.2f} (kPa)"
    axes.figure.colorbar(scale, cax=bar, label=label, orientation="horizontal", extend="max")


def render(position, radius, colour, width=1200):
    """Image of lit spheres in parallel projection; `colour` is one RGB triple a grain."""
    right, up, towards = camera(azimuth=np.radians(25), elevation=np.radians(20))
    u, v, depth = position @ right, position @ up, position @ towards
    left, top = (u - radius).min(), (v + radius).max()
    pixel = ((u + radius).max() - left) / width
    height = int(np.ceil((top - (v - radius).min()) / pixel))

    image = np.ones((height, width, 3))
    nearest = np.full((height, width), -np.inf)
    light = np.array([-0.4, 0.5, 0.77])  # in the axes of the picture, a unit vector
    for k in range(len(radius)):
        column, row, reach = (u[k] - left) / pixel, (top - v[k]) / pixel, radius[k] / pixel
        y, x = np.ogrid[
            int(row - reach) : min(int(row + reach) + 1, height),
            int(column - reach) : min(int(column + reach) + 1, width),
        ]
        normal_x, normal_y = (x + 0.5 - column) / reach, (row - y - 0.5) / reach
        square = 1 - normal_x**2 - normal_y**2
        normal_z = np.sqrt(np.maximum(square, 0))
        surface = depth[k] + radius[k] * normal_z
        seen = (square > 0) & (surface > nearest[y, x])
        shade = normal_x * light[0] + normal_y * light[1] + normal_z * light[2]
        brightness = 0.35 + 0.65 * np.maximum(shade, 0)
        nearest[y, x] = np.where(seen, surface, nearest[y, x])
        image[y, x] = np.where(seen[..., None], brightness[..., None] * colour[k], image[y, x])
    return image


def camera(azimuth, elevation):
    """Unit vectors of the picture, right, up and towards the eye, in the axes of the bed."""
    towards = np.array(
        [
            np.cos(elevation) * np.sin(azimuth),
            -np.cos(elevation) * np.cos(azimuth),
            np.sin(elevation),
        ]
    )
    right = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    return right, np.cross(towards, right), towards
