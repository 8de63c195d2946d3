#!/usr/bin/python3
"""Cost of a time step: relative to the plain triangular solve, the memory bandwidth and GetFEM, by size and by number of threads.

    run.py --help

Makes the meshes (gmsh), runs ricochet_step_bench and getfem_steps.py, writes DIRECTORY/results.json, and the tables and plots of
docs/performance.md.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys

from bodies import STEP, STEPS, case, mesh, pair_case

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from page import blas_kernels, with_kernels

# (name, dimension, size of cells): about 18,000, 74,000 and 200,000 dofs in 2D, 12,000 and 100,000 in 3D.
RATIO_BODIES = [("disc", 2, 0.0202), ("disc", 2, 0.0101), ("disc", 2, 0.00605), ("ball", 3, 0.101), ("ball", 3, 0.0475)]
# (name, dimension, sizes of the cells of both): about 36,000 dofs each in 2D, 6,000 and 50,000 each in 3D.
PAIRS = [("disc", 2, 0.0141, 0.0145), ("ball", 3, 0.126, 0.13), ("ball", 3, 0.0588, 0.0602)]
# Bodies against bodies, under cases/, and the pair of balls above.
PAIRING_CASES = ["balls/balls", "balls/unequal", "ball-block/ball-block", "stack/stack", "bars-pair/pair", "tied/tied"]
PEER_BODIES = [("disc", 2, 0.0202), ("disc", 2, 0.0101), ("ball", 3, 0.101)]
SCALING_BODIES = ([("disc", 2, size) for size in (0.09, 0.05, 0.0275, 0.0155, 0.0086, 0.0048, 0.0027)]
                  + [("ball", 3, size) for size in (0.25, 0.165, 0.107, 0.072, 0.0475, 0.032, 0.0212)])
SCALING_STEPS = 112
# About 287,000 and 976,000 dofs.
ITERATIVE_BODIES = [("ball", 3, 0.0325), ("ball", 3, 0.0213)]
ITERATIVE_STEPS = 70  # from just above the floor to past the largest force
FACTOR_BODIES = RATIO_BODIES[:4] + [("ball", 3, 0.0648), ("ball", 3, 0.0475)]  # also the ball of 41,000 dofs


def output_of(command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}: {result.stderr.strip()}")
    return json.loads(result.stdout)


def ours(arguments, path, *options):
    record = output_of([str(arguments.build / "ricochet_step_bench"), str(path), "--steps", str(STEPS), *map(str, options)])
    print(f"{path.stem:32s} {record['dofs']:8d} dofs {json.dumps(record.get('closed', {}))[:110]}", file=sys.stderr, flush=True)
    return record


def theirs(kernels, directory, body, steps, friction, *options):
    """Runs GetFEM with OpenBLAS on the same kernels as ours, as required for a comparison."""
    command = [sys.executable, str(HERE / "getfem_steps.py"), str(mesh(directory, *body)), str(body[1]), repr(STEP), str(steps),
               "--friction", repr(friction), *options]
    result = subprocess.run(command, capture_output=True, text=True, env=with_kernels(kernels))
    if result.returncode != 0:
        return {"failed": result.stderr.strip().splitlines()[-1] if result.stderr else f"exit status {result.returncode}"}
    record = json.loads(result.stdout)
    if record["kernels"] != kernels:
        return {"failed": f"OpenBLAS uses the kernels for {record['kernels']}, ours those for {kernels}"}
    return record


def measure_ratios(arguments, directory):
    records = []
    for body in RATIO_BODIES:
        for friction in (0.0, 0.3):
            path = case(directory, body, friction=friction)
            record = ours(arguments, path)
            record["memory"] = ours(arguments, path, "--alone", "--steps", 3)["peak_mb"]
            records.append(dict(record, body=body, friction=friction))
    return records


def measure_pairs(arguments, directory):
    return [dict(ours(arguments, pair_case(directory, pair, friction)), body=(f"two {pair[0]}s", pair[1], pair[2]), friction=friction)
            for pair in PAIRS for friction in (0.0, 0.3)]


def measure_pairing(arguments, directory):
    """Measures the pairing of surfaces and the whole run: both in processor time, medians of three."""
    root, records = HERE.parents[1], []
    paths = [(name, root / "cases" / f"{name}.toml") for name in PAIRING_CASES]
    paths += [(f"two {pair[0]}s", pair_case(directory, pair)) for pair in PAIRS]
    out = directory / "pairing-run"
    for name, path in paths:
        seconds, pairing = [], []
        for _ in range(3):
            record = ours(arguments, path, "--alone", "--steps", 2)
            pairing.append(record["pairing_s"])
            result = subprocess.run([str(arguments.build / "ricochet"), "run", str(path), "-o", str(out), "--force", "--quiet", "--threads", "1"],
                                    capture_output=True, text=True)
            summary = json.loads((out / "summary.json").read_text())
            if "processor_seconds" not in summary:
                sys.exit(f"{path}: {result.stderr.strip()}")
            seconds.append(summary["processor_seconds"])
        records.append({"case": name, "libraries": record["libraries"], "dofs": record["dofs"], "contact_points": record["contact_points"],
                        "steps": summary["steps"], "pairing_s": statistics.median(pairing), "run_s": statistics.median(seconds)})
    return records


def measure_peer(arguments, directory):
    """Measures the same steps in both programs: forces are compared before times."""
    records = []
    for body in PEER_BODIES:
        for friction in (0.0, 0.3):
            record = ours(arguments, case(directory, body, mass="consistent", friction=friction), "--alone", "--forces")
            kernels = blas_kernels(record["libraries"])
            entry = {"body": body, "friction": friction, "ours": record, "users": theirs(kernels, directory, body, STEPS, friction)}
            if friction == 0.0:
                entry["expert"] = theirs(kernels, directory, body, STEPS, friction, "--expert")
            records.append(entry)
    return records


def measure_scaling(arguments, directory):
    records = []
    for body in SCALING_BODIES:
        methods = ("direct", "iterative") if body[1] == 3 else ("direct",)
        for method in methods:
            if method == "direct" and body[1] == 3 and body[2] < 0.03:
                continue  # a factor of 10 GB
            path = case(directory, body, method=method)
            records.append(dict(ours(arguments, path, "--alone", "--steps", SCALING_STEPS), body=body, method=method))
    return records


def measure_threads(arguments, directory):
    """Measures by threads; the iterative path in 3D, where it is chosen."""
    return [dict(ours(arguments, case(directory, body, method=method), "--alone", "--steps", SCALING_STEPS, "--threads", threads),
                 body=body, method=method)
            for body in RATIO_BODIES for method in ("direct", "iterative") if method == "direct" or body[1] == 3 for threads in (1, 2)]


def measure_iterative(arguments, directory):
    return [dict(ours(arguments, case(directory, body, friction=0.3, method="iterative", down=0.098), "--alone", "--forces",
                      "--steps", ITERATIVE_STEPS, "--threads", threads), body=body)
            for body in ITERATIVE_BODIES for threads in (1, 2)]


def measure_factor(arguments, directory):
    """Measures factorization and solves: ours on one and two threads, CHOLMOD's."""
    return [dict(output_of([str(arguments.build / "ricochet_factor_bench"), str(case(directory, body)), "2"]), body=body) for body in FACTOR_BODIES]


def measure_explicit(arguments, directory):
    """Measures from just above the floor, in steps of about a tenth of the stable one."""
    records = []
    for body in RATIO_BODIES:
        step = 0.05 * body[2] / 141.0  # by the speed of pressure waves
        path = case(directory, body, mass="equivalent-lumped", down=0.1 - 40.0 * step,
                    time=f'scheme = "semi-explicit"\nstep = {step}\nend = {step * STEPS}\n')
        records.append(dict(ours(arguments, path), body=body))
    return records


PARTS = {"ratios": measure_ratios, "pairs": measure_pairs, "pairing": measure_pairing, "explicit": measure_explicit, "peer": measure_peer, "scaling": measure_scaling, "threads": measure_threads, "iterative": measure_iterative, "factor": measure_factor}


def main():
    root = HERE.parents[1]
    parser = argparse.ArgumentParser(prog="./dev bench", description=__doc__.split("\n\n")[0])
    parser.add_argument("--only", choices=PARTS, nargs="+", default=list(PARTS), help="only these parts; the others are kept")
    parser.add_argument("--report", action="store_true", help="only rewrite the page from the stored measurements")
    parser.add_argument("--directory", type=pathlib.Path, default=root / "build/bench-step", help="directory of meshes and results")
    parser.add_argument("--build", type=pathlib.Path, default=root / "build", help="folder of ricochet_step_bench")
    parser.add_argument("--check", action="store_true", help="only check the arguments")
    arguments = parser.parse_args()
    if arguments.check:
        return
    directory = arguments.directory.resolve()
    directory.mkdir(parents=True, exist_ok=True)
    results = directory / "results.json"
    everything = json.loads(results.read_text()) if results.exists() else {}
    for part in [] if arguments.report else arguments.only:
        everything[part] = PARTS[part](arguments, directory)
        results.write_text(json.dumps(everything, indent=1))
    if not everything:
        sys.exit(f"{results}: nothing has been measured yet; run without --report")
    import report  # needs matplotlib

    report.report(everything, root / "docs")


if __name__ == "__main__":
    main()
