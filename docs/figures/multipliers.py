#!/usr/bin/env python3
"""The disc of the source with each multiplier space: contact pressure against a fine reference. Prints the table of
docs/multipliers.md and draws its figure. From the repository root, with gmsh, python3-h5py and python3-matplotlib
installed (a few minutes):

    /usr/bin/python3 docs/figures/multipliers.py
"""
import pathlib
import subprocess

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

END = 0.06  # s: a little beyond the first contact
INSTANTS = np.linspace(0.008, 0.056, 49)  # every millisecond
ANGLES = np.radians(np.linspace(-60, 60, 2401))  # from the lowest point
RADIUS, CENTRE = 0.02, (0.0, 0.021)
SPACES = ("nodal", "p0", "p1", "dual")


def pressures(degree, size, space, step):
    """Pressure at INSTANTS (rows) and ANGLES (columns), linear between the nodes of the boundary."""
    name = f"out/multipliers/degree{degree}-{size:g}-{space}"
    mesh = f"out/multipliers/disc-{size:g}-{degree}.msh"
    pathlib.Path("out/multipliers").mkdir(parents=True, exist_ok=True)
    geometry = pathlib.Path(mesh).with_suffix(".geo")
    geometry.write_text(pathlib.Path("cases/disc/disc.geo").read_text().replace("size = 0.0020;", f"size = {size:g};"))
    command = ["gmsh", geometry, "-2", "-format", "msh41", "-order", str(degree), "-o", mesh, "-v", "1"]
    subprocess.run(command, check=True)
    every = round(0.001 / step)
    settings = [f"mesh.file={pathlib.Path(mesh).resolve()}", f"mesh.degree={degree}", f"contact.0.multipliers={space}", f"time.step={step:g}"]
    settings += [f"time.end={END}", f"output.fields_every={every}", "time.scheme=newmark", "time.preset=trapezoidal"]
    if degree == 1 and space == "p0":
        settings.append("contact.0.unstable_multipliers=allow")
    command = ["build/ricochet", "run", "cases/disc/disc.toml", "-o", name, "--force", "--quiet", "--log-level", "error"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, stdout=subprocess.DEVNULL)  # status 5: the case's expectations are not for these settings
    with h5py.File(f"{name}/results.h5") as file:
        nodes = file["mesh/nodes"][:, :2] - np.array(CENTRE)
        on_boundary = np.abs(np.hypot(*nodes.T) - RADIUS) < 1e-6 * RADIUS
        lower = on_boundary & (nodes[:, 1] < 0)
        angle = np.arctan2(nodes[lower, 0], -nodes[lower, 1])
        order = np.argsort(angle)
        frames = sorted(file["frames"])
        wanted = [frames[round(t / 0.001)] for t in INSTANTS]
        rows = [file[f"frames/{f}/contact_pressure"][:][lower][order] for f in wanted]
    return np.array([np.interp(ANGLES, angle[order], row) for row in rows])


def main():
    reference = pressures(2, 0.00025, "dual", 1.25e-5)
    scale = np.sqrt(np.mean(reference**2))
    peak = reference.max()
    print(f"reference: largest pressure {peak:.4g} Pa at {1e3 * INSTANTS[reference.max(axis=1).argmax()]:.0f} ms")
    print("| degree | multipliers | size 2 mm: error | largest pressure | size 1 mm: error | largest pressure | order |")
    print("|---|---|---|---|---|---|---|")
    figure, panels = plt.subplots(1, 2, figsize=(11, 4), sharey=True)
    instant = int(np.argmin(np.abs(INSTANTS - 0.030)))
    degrees = np.degrees(ANGLES)
    for degree, axes in zip((1, 2), panels):
        axes.plot(degrees, reference[instant], color="0.75", linewidth=5, label="fine reference")
        for space in SPACES:
            errors, peaks = [], []
            for size in (0.002, 0.001):
                found = pressures(degree, size, space, 0.05 * size)
                errors.append(np.sqrt(np.mean((found - reference) ** 2)) / scale)
                peaks.append(found.max() / peak)
                if size == 0.002:
                    axes.plot(degrees, found[instant], linewidth=1.3, label=space, linestyle="--" if space == "dual" else "-")
            print(
                f"| {degree} | {space} | {100 * errors[0]:.1f} % | {peaks[0]:.3f} | {100 * errors[1]:.1f} % | "
                f"{peaks[1]:.3f} | {np.log2(errors[0] / errors[1]):.2f} |"
            )
        axes.set(title=f"degree {degree}, cells of 2 mm, t = 30 ms", xlabel="angle from the lowest point, degrees")
        axes.set(xlim=(-45, 45))
        axes.grid(alpha=0.3)
    panels[0].set(ylabel="contact pressure, Pa")
    panels[0].legend()
    figure.tight_layout()
    figure.savefig("docs/figures/multipliers.png", dpi=80)


if __name__ == "__main__":
    main()
