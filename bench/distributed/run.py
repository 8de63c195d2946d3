#!/usr/bin/python3
"""Cost and gain of several processes: `./dev bench distributed`. Writes tables of docs/distributed.md.

Timed processes have one core each; times are medians of --repeat runs, in which the kinds of run take turns. Runs with more
processes than cores share cores; only their messages are counted. The peer is dolfinx (dolfinx_steps.py): the same mesh, rule,
material, load and tolerance.
"""

import concurrent.futures
import json
import os
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parent), str(HERE.parent / "step")]

import bodies
import model
from measurement import BUILD, Arguments, output_of, summary, table, write_parts

ENVIRONMENT = os.environ | {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_mpi_yield_when_idle": "1", "OMP_NUM_THREADS": "1",
                            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
CROSSING = 5.6e-3  # step in which a wave crosses a median cell of a ball, for cells of size 1
STEPS = 30
PEAK = "import resource, subprocess, sys; s = subprocess.run(sys.argv[1:]).returncode; " \
       "print('peak', resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(s)"


class Bench:
    def __init__(self, directory, repeat):
        self.directory, self.repeat = directory, repeat
        directory.mkdir(parents=True, exist_ok=True)

    def case(self, size, cells, contact, scheme="newmark"):
        """Case of a ball that lies nearly on the floor and slides over it, or flies and vibrates."""
        step = CROSSING * size * cells
        rule = "textbook-half" if contact else "trapezoidal"
        preset = f'preset = "{rule}"\n' if scheme == "newmark" else ""
        time = f'scheme = "{scheme}"\n{preset}step = {step}\nend = {step * STEPS}\n'
        path = bodies.case(self.directory, ("ball", 3, size), "equivalent" if contact else "consistent", 0.3 if contact else 0.0, "iterative",
                           time, down=0.1 - 0.2 * step if contact else 0.0)
        named = path.with_name(f"{path.stem}-{scheme}-{cells}.toml")
        path = path.rename(named)
        if not contact:
            text = re.sub(r"\[obstacle.*?\[load\]", "[load]", path.read_text(), flags=re.S)
            text = re.sub(r"displacement = .*\n", "", text)
            text = re.sub(r"velocity = .*\n", 'velocity = ["sin(9*x)", "0", "cos(7*y)"]\n', text)
            path = path.with_name(path.stem + "-free.toml")
            path.write_text(text)
        return path, step

    def two_at_once(self, case):
        """Returns the slower of two independent runs that share the machine: no division of a body can be faster."""
        with concurrent.futures.ThreadPoolExecutor() as pool:
            runs = list(pool.map(lambda name: self.run(case, 1, name=name), ("first", "second")))
        return max(runs, key=lambda run: run["ms"])

    def run(self, case, processes, *more, name="out"):
        """Returns the summary of a run, with the peak memory of a process."""
        out = self.directory / name
        command = [sys.executable, "-c", PEAK, str(BUILD / "ricochet-mpi"), "run", str(case), "-o", str(out), "--force", "--quiet", *more]
        # Two runs of one process each would be bound to the same core.
        binding = ["--bind-to", "none"] if processes == 1 else []
        printed = output_of(["mpirun", *binding, "-n", processes, *command], env=ENVIRONMENT)
        found = summary(out)
        found["memory_mb"] = max(int(line.split()[1]) for line in printed.splitlines() if line.startswith("peak")) / 1024
        found["ms"] = 1e3 * found["timings_seconds"]["steps"] / found["steps"]
        return found

    def timed(self, variants):
        """Returns the median run of each of several calls, which take turns."""
        runs = [[] for _ in variants]
        for _ in range(self.repeat):
            for made, variant in zip(runs, variants):
                made.append(variant())
        return [sorted(made, key=lambda run: run["ms"])[len(made) // 2] for made in runs]


def scaling(bench, sizes, small):
    """Strong scaling of the larger of two bodies, and weak scaling from the smaller one, of half as many dofs, to
    it."""
    rows, measured, shared = [], {}, []
    for scheme, cells in (("newmark", 1), ("newmark", 5), ("reduced-kane", 1)):
        whole, half = bench.case(sizes, cells, True, scheme)[0], bench.case(small, cells, True, scheme)[0]
        calls = [lambda: bench.run(half, 1), lambda: bench.run(whole, 1), lambda: bench.run(whole, 2), lambda: bench.two_at_once(half)]
        of_half, one, two, at_once = bench.timed(calls)
        shared.append(f"{at_once['ms'] / of_half['ms']:.2f}")
        for run, beside in ((of_half, None), (one, None), (two, one)):
            count = run["iterations"]
            ratio = f"{run['ms'] / beside['ms']:.2f}" if beside else ""
            memory = f"{run['memory_mb'] / beside['memory_mb']:.2f}" if beside else ""
            rows.append([f"`{scheme}`", cells, f"{run['dofs']:,}", 2 if run is two else 1, f"{run['ms']:.0f}", ratio, f"{run['memory_mb']:.0f} MB", memory,
                         f"{count['rounds_per_step']:.1f}", f"{count['gradients_per_step']:.0f}"])
        measured[scheme, cells] = {"half": of_half, "one": one, "two": two}
    weak = ", ".join(f"{m['two']['ms'] / m['half']['ms']:.2f}" for m in measured.values())
    text = table(["scheme", "cells crossed", "dofs", "processes", "ms per step", "relative to one process", "memory per process", "relative to one",
                  "contact iterations", "CG iterations"], rows)
    return (f"{text}\n\nWeak scaling, two processes on the larger body relative to one on the smaller, in this order: {weak}. "
            f"Two separate runs of the smaller body at the same time, relative to one alone: {', '.join(shared)}."), measured


def traffic(bench, size):
    """Messages on 2 to 8 processes, compared with the formula of 3 n^(2/3) nodes on the boundary of a part."""
    rows = []
    case = bench.case(size, 1, True)[0]
    for processes in (1, 2, 4, 8):
        run = bench.run(case, processes)
        count, sent = run["iterations"], run["processes"]
        if sent is None:
            rows.append([1, f"{run['dofs']:,}", f"{count['rounds_per_step']:.1f}", f"{count['gradients_per_step']:.0f}", "", "", "", ""])
            continue
        # An iteration exchanges single-precision numbers at shared nodes; a contact iteration exchanges doubles six
        # times.
        nodes = model.shared_nodes(sent["most_dofs"])
        expected = nodes * (12 * count["gradients_per_step"] + 6 * 24 * count["rounds_per_step"])
        rows.append([processes, f"{sent['most_dofs']:,}", f"{count['rounds_per_step']:.1f}", f"{count['gradients_per_step']:.0f}",
                     f"{sent['messages_per_step']:.0f}", f"{sent['reductions_per_step']:.0f}", f"{1e-6 * sent['bytes_per_step']:.1f}", f"{1e-6 * expected:.1f}"])
    return table(["processes", "dofs per process", "contact iterations", "CG iterations", "messages per step, at most", "sums", "MB per step, at most",
                  "by the formula"], rows)


def peers(bench, size):
    """Compares the step without contact."""
    case, step = bench.case(size, 1, False)
    mesh = bodies.mesh(bench.directory, "ball", 3, size)

    def peer(processes, solver):
        printed = output_of(["mpirun", "-n", processes, "/usr/bin/python3", HERE / "dolfinx_steps.py", mesh, "--step", repr(step), "--steps", STEPS,
                             "--solver", solver, "--tolerance", "1e-10"], env=ENVIRONMENT)
        found = json.loads(printed.splitlines()[-1])
        return found | {"ms": found["ms_per_step"]}

    rows = []
    for processes in (1, 2):
        ours, gamg, jacobi = bench.timed([lambda: bench.run(case, processes), lambda: peer(processes, "gamg"), lambda: peer(processes, "jacobi")])
        setup = ours["timings_seconds"]["total"] - ours["timings_seconds"]["steps"]
        energy = float((bench.directory / "out" / "history.csv").read_text().splitlines()[-1].split(",")[6])
        rows.append(["Ricochet, diagonal blocks", processes, f"{ours['ms']:.0f}", "", f"{ours['iterations']['gradients_per_step']:.0f}",
                     f"{setup:.1f} s", f"{ours['memory_mb']:.0f} MB", f"{energy:.12g}"])
        for name, run in (("dolfinx, diagonal blocks", jacobi), ("dolfinx, GAMG", gamg)):
            rows.append([name, processes, f"{run['ms']:.0f}", f"{run['ms'] / ours['ms']:.1f}", f"{run['iterations']:.0f}", f"{run['setup']:.1f} s",
                         f"{run['memory_mb']:.0f} MB", f"{run['energy']:.12g}"])
    return f"{ours['dofs']:,} dofs:\n\n" + table(
        ["", "processes", "ms per step", "time / ours", "CG iterations", "until the first step", "memory per process", "energy at the end"], rows)


def beyond(measured):
    """Extrapolates by the model, from measurements on one process."""
    steps = []
    for (scheme, cells), runs in measured.items():
        if scheme != "newmark":
            continue
        one, count = runs["one"], runs["one"]["iterations"]
        seconds = 1e-3 * one["ms"]  # its subdomain has few points and takes little of this time
        steps.append((f"{cells} cell" + ("s" if cells > 1 else ""), model.Step({
            "seconds": seconds / count["gradients_per_step"] / one["dofs"], "bytes": 150.0,
            "iterations": count["gradients_per_step"], "rounds": count["rounds_per_step"], "zone": 0.030 if cells == 1 else 0.048})))
    per_dof = max(runs["two"]["memory_mb"] * 2**20 * 2 / runs["two"]["dofs"] for runs in measured.values())
    return model.extrapolation(steps, per_dof)


def main():
    parser = Arguments("distributed", __doc__, repeat=3, directory=True, build="")
    parser.add_argument("--quick", action="store_true", help="use small bodies, and write no tables")
    arguments = parser.parse()
    bench = Bench(arguments.directory, arguments.repeat)
    large, small = (0.0325, 0.041) if not arguments.quick else (0.09, 0.11)

    def show(part, text):
        print(text, flush=True)
        if not arguments.quick:
            write_parts("distributed.md", {part: text})

    text, measured = scaling(bench, large, small)
    show("scaling", text)
    show("beyond", beyond(measured))
    show("traffic", traffic(bench, small))
    show("peers", peers(bench, small))


main()
