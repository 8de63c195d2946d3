#!/usr/bin/env python3
"""Cost of output: whole runs that write results, compared with the same run without fields.

    ./dev bench output [--repeat 15]

In each repetition the runs follow one another, in changing order. The ratio is that of their total times, which include the
start of the program; the table shows its median and quartiles, and the size of results.h5. Writes the table of
docs/reliability.md.
"""

import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

BENCH = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(BENCH), str(BENCH / "step")]
import bodies
from measurement import Arguments, table, write_parts

VARIANTS = {
    "no fields": ["output.fields_every=0"],
    "default": [],
    "single precision, compression 1": ["output.fields_precision=single", "output.compression=1"],
    "all fields": ['output.fields=["all"]'],
    "a checkpoint every 100 steps": ["output.checkpoint_every=100"],
}


def seconds(program, path, output, settings):
    command = [program, "run", path, "-o", output, "--force", "--quiet", "--threads", "1", "--log-level", "error"]
    for setting in settings:
        command += ["--set", setting]
    started = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - started


def measure(program, path, directory, repeat):
    """Returns, per variant, the ratios to the run without fields and the sizes of results.h5."""
    ratios, sizes, plain = {name: [] for name in VARIANTS}, {}, []
    for k in range(repeat):
        times = {}
        names = list(VARIANTS)
        for name in names[k % len(names):] + names[:k % len(names)]:
            output = directory / "out"
            shutil.rmtree(output, ignore_errors=True)
            times[name] = seconds(program, path, output, VARIANTS[name])
            results = output / "results.h5"
            sizes[name] = results.stat().st_size / 1e6 if results.exists() else 0.0
        plain.append(times["no fields"])
        for name in VARIANTS:
            ratios[name].append(times[name] / times["no fields"])
    return statistics.median(plain), ratios, sizes


def cell(ratios, size):
    low, middle, high = statistics.quantiles(ratios, n=4)
    return f"{middle:.2f} ({low:.2f}–{high:.2f}), {size:.0f} MB"


def main():
    parser = Arguments("output", __doc__, repeat=15, build="the program")
    arguments = parser.parse()
    if arguments.repeat < 2:
        parser.error("argument --repeat: must be at least 2")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        directory = pathlib.Path(folder)
        for label, name, dimension, size, steps in (("disc, 1,060 dofs, 1500 steps", "disc", 2, 0.09, 1500),
                                                    ("disc, 18,000 dofs, 300 steps", "disc", 2, 0.0202, 300),
                                                    ("ball, 4,060 dofs, 400 steps", "ball", 3, 0.155, 400),
                                                    ("ball, 12,000 dofs, 160 steps", "ball", 3, 0.101, 160)):
            newmark = f'scheme = "newmark"\npreset = "trapezoidal"\nstep = {0.16 / steps!r}\nend = 0.16\n'
            path = bodies.case(directory, (name, dimension, size), time=newmark, output="")
            plain, ratios, sizes = measure(arguments.build / "ricochet", path, directory, arguments.repeat)
            rows.append([label, f"{plain:.2f} s", *(cell(ratios[variant], sizes[variant]) for variant in list(VARIANTS)[1:])])
            print(*rows[-1], sep=" | ", flush=True)
    write_parts("reliability.md", {"output": table(["body", "without fields", *list(VARIANTS)[1:]], rows)})


if __name__ == "__main__":
    main()
