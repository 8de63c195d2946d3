#!/usr/bin/python3
"""Cost of a time step: relative to the plain triangular solve, the memory bandwidth and GetFEM, by size and by number of threads.

    run.py --help

Makes the meshes (gmsh), runs ricochet_step_bench and getfem_steps.py, writes DIRECTORY/results.json, and the tables and plots of
docs/performance.md.
"""

import json
import pathlib
import statistics
import subprocess
import sys

from bodies import STEP, STEPS, case, mesh, pair_case

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from measurement import ROOT, Arguments, add_parts, blas_kernels, measure_parts, output_of, record_of_peer, summary

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


def ours(arguments, path, *options):
    return json.loads(output_of([arguments.build / "ricochet_step_bench", path, "--steps", STEPS, *options]))


def theirs(kernels, directory, body, steps, friction, *options):
    return record_of_peer([HERE / "getfem_steps.py", mesh(directory, *body), body[1], repr(STEP), steps, "--friction", repr(friction), *options], kernels)


def measure_ratios(arguments, directory):
    for body in RATIO_BODIES:
        for friction in (0.0, 0.3):
            path = case(directory, body, friction=friction)
            record = ours(arguments, path)
            record["memory"] = ours(arguments, path, "--alone", "--steps", 3)["peak_mb"]
            yield dict(record, body=body, friction=friction)


def measure_pairs(arguments, directory):
    for pair in PAIRS:
        for friction in (0.0, 0.3):
            yield dict(ours(arguments, pair_case(directory, pair, friction)), body=(f"two {pair[0]}s", pair[1], pair[2]), friction=friction)


def measure_pairing(arguments, directory):
    """Measures the pairing of surfaces and the whole run: both in processor time, medians of three."""
    paths = [(name, ROOT / "cases" / f"{name}.toml") for name in PAIRING_CASES]
    paths += [(f"two {pair[0]}s", pair_case(directory, pair)) for pair in PAIRS]
    out = directory / "pairing-run"
    for name, path in paths:
        seconds, pairing = [], []
        for _ in range(3):
            record = ours(arguments, path, "--alone", "--steps", 2)
            pairing.append(record["pairing_s"])
            result = subprocess.run([str(arguments.build / "ricochet"), "run", str(path), "-o", str(out), "--force", "--quiet", "--threads", "1"],
                                    capture_output=True, text=True)
            found = summary(out)
            if "processor_seconds" not in found:
                sys.exit(f"{path}: {result.stderr.strip()}")
            seconds.append(found["processor_seconds"])
        yield {"case": name, "libraries": record["libraries"], "dofs": record["dofs"], "contact_points": record["contact_points"],
               "steps": found["steps"], "pairing_s": statistics.median(pairing), "run_s": statistics.median(seconds)}


def measure_peer(arguments, directory):
    """Measures the same steps in both programs: forces are compared before times."""
    for body in PEER_BODIES:
        for friction in (0.0, 0.3):
            record = ours(arguments, case(directory, body, mass="consistent", friction=friction), "--alone", "--forces")
            kernels = blas_kernels(record["libraries"])
            entry = {"body": body, "friction": friction, "ours": record, "users": theirs(kernels, directory, body, STEPS, friction)}
            if friction == 0.0:
                entry["expert"] = theirs(kernels, directory, body, STEPS, friction, "--expert")
            yield entry


def measure_scaling(arguments, directory):
    for body in SCALING_BODIES:
        methods = ("direct", "iterative") if body[1] == 3 else ("direct",)
        for method in methods:
            if method == "direct" and body[1] == 3 and body[2] < 0.03:
                continue  # a factor of 10 GB
            path = case(directory, body, method=method)
            yield dict(ours(arguments, path, "--alone", "--steps", SCALING_STEPS), body=body, method=method)


def measure_threads(arguments, directory):
    """Measures by threads; the iterative path in 3D, where it is chosen."""
    for body in RATIO_BODIES:
        for method in ("direct", "iterative") if body[1] == 3 else ("direct",):
            for threads in (1, 2):
                yield dict(ours(arguments, case(directory, body, method=method), "--alone", "--steps", SCALING_STEPS, "--threads", threads),
                           body=body, method=method)


def measure_iterative(arguments, directory):
    for body in ITERATIVE_BODIES:
        for threads in (1, 2):
            path = case(directory, body, friction=0.3, method="iterative", down=0.098)
            yield dict(ours(arguments, path, "--alone", "--forces", "--steps", ITERATIVE_STEPS, "--threads", threads), body=body)


def measure_factor(arguments, directory):
    """Measures factorization and solves: ours on one and two threads, CHOLMOD's."""
    for body in FACTOR_BODIES:
        yield dict(json.loads(output_of([arguments.build / "ricochet_factor_bench", case(directory, body), 2])), body=body)


def measure_explicit(arguments, directory):
    """Measures from just above the floor, in steps of about a tenth of the stable one."""
    for body in RATIO_BODIES:
        step = 0.05 * body[2] / 141.0  # by the speed of pressure waves
        path = case(directory, body, mass="equivalent-lumped", down=0.1 - 40.0 * step,
                    time=f'scheme = "semi-explicit"\nstep = {step}\nend = {step * STEPS}\n')
        yield dict(ours(arguments, path), body=body)


PARTS = {"ratios": measure_ratios, "pairs": measure_pairs, "pairing": measure_pairing, "explicit": measure_explicit, "peer": measure_peer,
         "scaling": measure_scaling, "threads": measure_threads, "iterative": measure_iterative, "factor": measure_factor}


def main():
    parser = Arguments("", __doc__.split("\n\n")[0], directory=True, build="ricochet_step_bench")
    add_parts(parser, PARTS)
    everything = measure_parts(parser.parse(), PARTS)
    import report  # needs matplotlib

    report.report(everything)


if __name__ == "__main__":
    main()
