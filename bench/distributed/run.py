#!/usr/bin/python3
"""Cost and gain of several processes: `./dev bench distributed`. Writes tables of docs/distributed.md.

Timed processes have one core each; times are medians of --repeat runs, in which the kinds of run take turns. Runs with more
processes than cores share cores; only their messages are counted. The peer is dolfinx (dolfinx_steps.py): the same mesh, rule,
material, load and tolerance.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parent), str(HERE.parent / "step")]

import bodies
import model
import page

ROOT = HERE.parent.parent
BUILD = ROOT / "build"
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
        done = subprocess.run(["mpirun", *binding, "-n", str(processes), *command], capture_output=True, text=True, env=ENVIRONMENT)
        if done.returncode != 0:
            sys.exit(done.stderr)
        summary = json.loads((out / "summary.json").read_text())
        summary["memory_mb"] = max(int(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("peak")) / 1024
        summary["ms"] = 1e3 * summary["timings_seconds"]["steps"] / summary["steps"]
        return summary

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
    lines = ["| scheme | cells crossed | dofs | processes | ms per step | relative to one process | memory per process | relative to one | contact iterations | CG iterations |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    measured, shared = {}, []
    for scheme, cells in (("newmark", 1), ("newmark", 5), ("reduced-kane", 1)):
        whole, half = bench.case(sizes, cells, True, scheme)[0], bench.case(small, cells, True, scheme)[0]
        calls = [lambda: bench.run(half, 1), lambda: bench.run(whole, 1), lambda: bench.run(whole, 2), lambda: bench.two_at_once(half)]
        of_half, one, two, at_once = bench.timed(calls)
        shared.append(f"{at_once['ms'] / of_half['ms']:.2f}")
        for run, beside in ((of_half, None), (one, None), (two, one)):
            count = run["iterations"]
            ratio = f"{run['ms'] / beside['ms']:.2f}" if beside else ""
            memory = f"{run['memory_mb'] / beside['memory_mb']:.2f}" if beside else ""
            processes = 2 if run is two else 1
            lines.append(f"| `{scheme}` | {cells} | {run['dofs']:,} | {processes} | {run['ms']:.0f} | {ratio} | {run['memory_mb']:.0f} MB | {memory} | "
                         f"{count['rounds_per_step']:.1f} | {count['gradients_per_step']:.0f} |")
        measured[scheme, cells] = {"half": of_half, "one": one, "two": two}
    weak = ", ".join(f"{m['two']['ms'] / m['half']['ms']:.2f}" for m in measured.values())
    lines.append(f"\nWeak scaling, two processes on the larger body relative to one on the smaller, in this order: {weak}. "
                 f"Two separate runs of the smaller body at the same time, relative to one alone: {', '.join(shared)}.")
    return "\n".join(lines), measured


def traffic(bench, size):
    """Messages on 2 to 8 processes, compared with the formula of 3 n^(2/3) nodes on the boundary of a part."""
    lines = ["| processes | dofs per process | contact iterations | CG iterations | messages per step, at most | sums | MB per step, at most | by the formula |",
             "|---|---|---|---|---|---|---|---|"]
    case = bench.case(size, 1, True)[0]
    for processes in (1, 2, 4, 8):
        run = bench.run(case, processes)
        count, sent = run["iterations"], run["processes"]
        if sent is None:
            lines.append(f"| 1 | {run['dofs']:,} | {count['rounds_per_step']:.1f} | {count['gradients_per_step']:.0f} | | | | |")
            continue
        # An iteration exchanges single-precision numbers at shared nodes; a contact iteration exchanges doubles six
        # times.
        nodes = model.shared_nodes(sent["most_dofs"])
        expected = nodes * (12 * count["gradients_per_step"] + 6 * 24 * count["rounds_per_step"])
        lines.append(f"| {processes} | {sent['most_dofs']:,} | {count['rounds_per_step']:.1f} | {count['gradients_per_step']:.0f} | "
                     f"{sent['messages_per_step']:.0f} | {sent['reductions_per_step']:.0f} | {1e-6 * sent['bytes_per_step']:.1f} | "
                     f"{1e-6 * expected:.1f} |")
    return "\n".join(lines)


def peers(bench, size):
    """Compares the step without contact."""
    case, step = bench.case(size, 1, False)
    mesh = bodies.mesh(bench.directory, "ball", 3, size)

    def peer(processes, solver):
        command = ["mpirun", "-n", str(processes), "/usr/bin/python3", str(HERE / "dolfinx_steps.py"), str(mesh), "--step", repr(step), "--steps",
                   str(STEPS), "--solver", solver, "--tolerance", "1e-10"]
        done = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT)
        if done.returncode != 0:
            sys.exit(done.stderr)
        found = json.loads(done.stdout.splitlines()[-1])
        return found | {"ms": found["ms_per_step"]}

    lines = ["| | processes | ms per step | time / ours | CG iterations | until the first step | memory per process | energy at the end |",
             "|---|---|---|---|---|---|---|---|"]
    for processes in (1, 2):
        ours, gamg, jacobi = bench.timed([lambda: bench.run(case, processes), lambda: peer(processes, "gamg"), lambda: peer(processes, "jacobi")])
        setup = ours["timings_seconds"]["total"] - ours["timings_seconds"]["steps"]
        energy = float((bench.directory / "out" / "history.csv").read_text().splitlines()[-1].split(",")[6])
        lines.append(f"| Ricochet, diagonal blocks | {processes} | {ours['ms']:.0f} | | {ours['iterations']['gradients_per_step']:.0f} | "
                     f"{setup:.1f} s | {ours['memory_mb']:.0f} MB | {energy:.12g} |")
        for name, run in (("dolfinx, diagonal blocks", jacobi), ("dolfinx, GAMG", gamg)):
            lines.append(f"| {name} | {processes} | {run['ms']:.0f} | {run['ms'] / ours['ms']:.1f} | {run['iterations']:.0f} | "
                         f"{run['setup']:.1f} s | {run['memory_mb']:.0f} MB | {run['energy']:.12g} |")
    return f"{ours['dofs']:,} dofs:\n\n" + "\n".join(lines)


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
    return model.table(steps, per_dof)


def main():
    parser = argparse.ArgumentParser(prog="./dev bench distributed", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3, help="number of timed runs of each kind (default: 3)")
    parser.add_argument("--directory", type=pathlib.Path, default=BUILD / "bench-distributed", help="directory of meshes and runs")
    parser.add_argument("--quick", action="store_true", help="use small bodies, and write no tables")
    parser.add_argument("--check", action="store_true", help="only check the arguments")
    arguments = parser.parse_args()
    if arguments.check:
        return
    bench = Bench(arguments.directory, arguments.repeat)
    large, small = (0.0325, 0.041) if not arguments.quick else (0.09, 0.11)

    def show(part, text):
        print(text, flush=True)
        if not arguments.quick:
            page.write_parts(ROOT / "docs" / "distributed.md", {part: text})

    text, measured = scaling(bench, large, small)
    show("scaling", text)
    show("beyond", beyond(measured))
    show("traffic", traffic(bench, small))
    show("peers", peers(bench, small))


main()
