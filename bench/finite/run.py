#!/usr/bin/python3
"""Finite strain compared with GetFEM, and the cost of a step: forces on the same mesh with the same law, times, triangular solves.

    ./dev bench finite [--only statics dynamics times costs where] [--program PATH] [--report]

Makes the meshes (gmsh), runs Ricochet and getfem_finite.py, writes DIRECTORY/results.json and the tables of docs/peers.md and
docs/performance.md. The programs take turns, so that the load of the machine affects both.
"""

import datetime
import json
import os
import pathlib
import statistics
import subprocess
import sys

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"
BENCH = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(BENCH), str(BENCH / "step"), str(BENCH / "peers")]
import measurement
import ours
import peer
import problems
import where

# (name, dimension, size of cells), pressed by this fraction of the height.
PRESSED = [(("block", 2, 0.03), 0.1), (("block", 3, 0.1), 0.1), (("half", 2, 0.03), 0.1), (("half", 2, 0.03), 0.3), (("half", 3, 0.1), 0.1)]
FRICTIONS = (0.0, 0.1, 0.3)
# Falling: body, speed, friction, scheme, steps. From 0.2 to 10 % of strain.
DISC, BALL = ("disc", 2, 0.04), ("ball", 3, 0.2)
FALLING = [(DISC, 0.1, 0.0, "newmark", 80), (DISC, 1.0, 0.0, "newmark", 70), (DISC, 5.0, 0.0, "newmark", 60), (DISC, 5.0, 0.3, "newmark", 60),
           (BALL, 5.0, 0.0, "newmark", 60), (BALL, 5.0, 0.3, "newmark", 60), (DISC, 1.0, 0.0, "trapezoidal", 30), (BALL, 1.0, 0.3, "trapezoidal", 30),
           (DISC, 1.0, 0.0, "midpoint", 30), (BALL, 1.0, 0.3, "midpoint", 30)]
SPEEDS = (0.1, 1.0, 5.0)
# Body, friction, speeds, steps.
TIMED = [(("ball", 3, 0.101), 0.0, (0.1, 1.0, 5.0), 8), (("ball", 3, 0.101), 0.3, (1.0,), 8), (DISC, 0.0, (0.1, 1.0, 5.0), 30),
         (("disc", 2, 0.0202), 0.0, (0.1, 1.0, 5.0), 12), (("disc", 2, 0.0202), 0.3, (1.0,), 12), (("disc", 2, 0.0101), 0.0, (1.0,), 8)]
COSTS = [(("disc", 2, 0.0202), "reduced-kane", SPEEDS, 30), (("disc", 2, 0.0101), "reduced-kane", SPEEDS, 20),
         (("ball", 3, 0.101), "reduced-kane", SPEEDS, 20), (("ball", 3, 0.101), "newmark", SPEEDS, 20), (("ball", 3, 0.0475), "newmark", SPEEDS, 10)]
LIMIT = 600  # seconds, for runs that may hang
# For sampling profiles.
WHERE = [(("disc", 2, 0.0202), "newmark", 12), (("disc", 2, 0.0202), "reduced-kane", 12), (("ball", 3, 0.101), "newmark", 8)]


def measure_statics(arguments, directory):
    for body, press in PRESSED:
        for friction in FRICTIONS:
            case = problems.pressed(directory, body, press, friction)
            mine = peer.arrays(case, directory / "run", body[1])
            file = directory / "getfem.npz"
            record = peer.getfem("static", problems.pressed_mesh(directory, *body), body[1], friction, file, arguments.kernels, press=press)
            record |= {"body": body, "press": press, "friction_coefficient": friction, "strain": peer.largest_stretch(*mine[:2], mine[2][:1])}
            if "failed" not in record:
                record |= peer.differences(mine, file, 0, friction)
            yield record


def measure_dynamics(arguments, directory):
    for body, speed, friction, scheme, steps in FALLING:
        case = problems.falling(directory, body, speed, friction, scheme, steps)
        mine = peer.arrays(case, directory / "run", body[1])
        file = directory / "getfem.npz"
        record = peer.getfem(scheme, problems.falling_mesh(directory, body), body[1], friction, file, arguments.kernels, speed=speed, steps=steps,
                             step=problems.STEP)
        record |= {"body": body, "speed": speed, "friction_coefficient": friction, "scheme": scheme, "steps": steps, "strain": peer.largest_stretch(*mine[:3])}
        if "failed" not in record:
            record |= peer.differences(mine, file, 1, friction)
        yield record


def measure_times(arguments, directory):
    """Measures Newmark's scheme in both programs, which compute the same steps; also our default scheme from the same
    start."""
    for body, friction, speeds, steps in TIMED:
        for speed in speeds:
            yield time_of_steps(arguments, directory, body, friction, speed, steps)


def time_of_steps(arguments, directory, body, friction, speed, steps):
    cases = {scheme: problems.falling(directory, body, speed, friction, scheme, steps) for scheme in ("newmark", "reduced-kane")}
    mine = peer.arrays(cases["newmark"], directory / "run", body[1])
    record = {"body": body, "speed": speed, "friction": friction, "steps": steps - problems.FLIGHT, "strain": peer.largest_stretch(*mine[:3]),
              "rounds": {}, "ours": {}, "theirs": [], "stopped": {}}
    for scheme, case in list(cases.items()):
        try:
            ours.run(case, directory / "run", {}, fields=False, limit=LIMIT)
        except SystemExit as failure:
            record["stopped"][scheme] = str(failure).splitlines()[-1]
            del cases[scheme]
            continue
        record["rounds"][scheme], record["ours"][scheme] = peer.newton_rounds(directory / "run"), []
    file = directory / "getfem.npz"
    for turn in range(arguments.repeat + 1):  # ours, theirs, ours, …, ours
        for scheme, case in cases.items():
            record["ours"][scheme].append(peer.step_seconds(case, directory / "run", steps))
        if turn == arguments.repeat:
            continue
        theirs = peer.getfem("newmark", problems.falling_mesh(directory, body), body[1], friction, file, arguments.kernels, speed=speed, steps=steps,
                             step=problems.STEP)
        if "failed" in theirs or "stopped" in theirs:
            return record | {"failed": theirs.get("failed", "GetFEM's Newton method did not converge")}
        record["theirs"].append(statistics.mean(theirs["seconds"][problems.FLIGHT:]))
        record["iterations"] = theirs["iterations"][problems.FLIGHT:]
    return record | {"dofs": theirs["dofs"], "contact_points": theirs["contact_points"], "differences": peer.differences(mine, file, 1, friction)}


def step_bench(arguments, case, steps):
    command = [str(arguments.build / "ricochet_step_bench"), str(case), "--steps", str(steps)]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return {"failed": f"not finished after {LIMIT} s"}
    return json.loads(result.stdout) if result.returncode == 0 else {"failed": result.stderr.strip()}


def measure_costs(arguments, directory):
    """Measures steps with the equivalent mass relative to plain triangular solves of their operator, and the law of
    small strain for comparison."""
    for body, scheme, speeds, steps in COSTS:
        for law, speed in [("linear", 1.0)] + [("neo-hookean", speed) for speed in speeds]:
            yield cost_of_steps(arguments, directory, body, scheme, law, speed, steps)


def cost_of_steps(arguments, directory, body, scheme, law, speed, steps):
    case = problems.falling(directory, body, speed, 0.0, scheme, steps, mass="equivalent", law=law)
    runs = [step_bench(arguments, case, steps) for _ in range(arguments.repeat)]
    record = {"body": body, "scheme": scheme, "law": law, "speed": speed, "runs": runs}
    if law != "linear" and any("failed" not in run for run in runs):
        ours.run(case, directory / "run", {"output.fields_every": 5, "output.fields": '["displacement"]'}, fields=False)
        record |= {"rounds_by_phase": peer.rounds_by_phase(directory / "run"), "strain": stretch_of(directory / "run", body[1])}
    return record


def measure_where(arguments, directory):
    """Needs perf (Debian's linux-perf)."""
    for body, scheme, steps in WHERE:
        case = problems.falling(directory, body, 1.0, 0.0, scheme, steps)
        samples = where.of_steps(ours.PROGRAM, case, directory, steps)
        if samples:
            yield {"body": body, "scheme": scheme, "samples": samples}


def stretch_of(directory, dimension):
    import h5py

    with h5py.File(directory / "results.h5") as file:
        displacement = [frame["displacement"][:, :dimension] for frame in file["frames"].values()]
        return peer.largest_stretch(file["mesh/nodes"][:, :dimension], file["mesh/cells"][:], displacement)


PARTS = {"statics": measure_statics, "dynamics": measure_dynamics, "times": measure_times, "costs": measure_costs, "where": measure_where}


def main():
    parser = measurement.Arguments("finite", __doc__, repeat=3, directory=True, build="ricochet and ricochet_step_bench")
    measurement.add_parts(parser, PARTS)
    parser.add_argument("--program", type=pathlib.Path, help="path of ricochet, if it is elsewhere")
    arguments = parser.parse()
    ours.PROGRAM = arguments.program or arguments.build / "ricochet"
    libraries = measurement.libraries(ours.PROGRAM)
    arguments.kernels = measurement.blas_kernels(libraries)
    everything = measurement.measure_parts(
        arguments, PARTS, lambda records: {"date": str(datetime.date.today()), "libraries": libraries, "records": records})
    import tables

    sys.exit(0 if tables.report(everything) else 1)


if __name__ == "__main__":
    main()
