#!/usr/bin/python3
"""Runs Ricochet's and Siconos' solvers on the set of problems and judges their results.

    run.py --help

Writes DIRECTORY/results.json, one record for each problem, solver and tolerance, and sequences.json; report.py makes
tables and plots of them. Siconos' results are kept from run to run (theirs.json) until the file of a problem changes.
"""

import json
import os
import pathlib
import queue
import subprocess
import sys
import threading
import time

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import describe
import fclib
import make_set
import measure
import reference
import report
from case_table import CASES
from siconos_solvers import RAW, SOLVERS

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from measurement import Arguments, blas_kernels, libraries, output_of, with_kernels

TOLERANCES = (1e-4, 1e-8, 1e-12)
LIMIT = 20.0  # seconds for one call
SMALL, SMALL_LIMIT = 450, 5.0  # points, and seconds for these: hundreds of times the time of good solvers
MANY = 1500  # points above which only these of Siconos' solvers are run: the others would take minutes each
FOR_MANY = ("NSGS-newton-blocks", "NSGS-newton-freeze", "NSGS-projection-blocks", "VI_EG")
SLACK = 10.0  # a true residual of so many tolerances still counts as solved
REPEAT = 5


class Siconos:
    """The serving process; killed if a call takes too long, and restarted after a crash."""

    def __init__(self, directory, kernels):
        self.process, self.kernels = None, kernels
        self.reaction = str(directory / "theirs-reaction.npy")

    def stop(self):
        if self.process is not None:
            self.process.kill()
            self.process.wait()
        self.process = None

    def ask(self, request, limit):
        if self.process is None:
            self.process = subprocess.Popen(
                [sys.executable, str(HERE / "siconos_solvers.py"), "--serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL, text=True, env=with_kernels(self.kernels))
            self.lines = queue.Queue()
            threading.Thread(target=self._read, args=(self.process, self.lines), daemon=True).start()
        try:
            self.process.stdin.write(json.dumps({**request, "reaction": self.reaction}) + "\n")
            self.process.stdin.flush()
            line = self.lines.get(timeout=limit)
        except queue.Empty:
            self.stop()
            return {"failure": "time limit"}, None
        except OSError:
            line = None
        if line is None:
            self.stop()
            return {"failure": "crash"}, None
        return json.loads(line), np.load(self.reaction)

    @staticmethod
    def _read(process, lines):
        for line in process.stdout:
            lines.put(line)
        lines.put(None)


class Judge:
    """Reference solution of one problem, and the assessment of answers."""

    def __init__(self, problem):
        self.measure = measure.Measure(problem)
        self.problem, self.reference, self.motion, self.floor = problem, None, None, 0.0

    def set_reference(self, start):
        self.reference, self.reference_residual = reference.solve(self.problem, start)
        self.motion = self.measure.motion(self.reference)
        self.floor = self.measure.rounding_floor(self.reference.astype(float))

    def assess(self, answer, reaction, tolerance):
        if reaction is None:
            return {**answer, "solved": False}
        residual = self.measure.residual(reaction)
        of_reaction, of_motion = self.measure.distance(reaction, self.reference, self.motion)
        solved = residual <= max(SLACK * tolerance, 10 * self.floor)
        answer = {**answer, "residual": residual, "distance_r": of_reaction, "distance_u": of_motion, "solved": bool(solved)}
        if not solved:
            # Claimed: the program itself reports success.
            claims = answer.get("outcome") == "solved" or answer.get("status") == 0
            answer["failure"] = "claimed, but not solved" if claims else "says so"
        return answer


def expand(problem, reaction):
    """Returns r of all rows if the solver was given only the normal rows of points without friction."""
    if reaction.size == problem.offset.size:
        return reaction
    full = np.zeros(problem.offset.size)
    with_tangents = np.repeat(problem.coefficient > 0, problem.dimension)
    with_tangents[:: problem.dimension] = True
    full[with_tangents] = reaction
    return full


def limit_of(problem):
    """Returns the time limit of one call in seconds."""
    return SMALL_LIMIT if problem.points <= SMALL else LIMIT


def run_ours(bench, directory, path, problem, solver, tolerance, repeat, more=()):
    """Returns (answer, reaction) for one problem; for a sequence, `path` and the answer are lists."""
    paths = [path] if isinstance(path, pathlib.Path) else path
    reactions = directory / "ours"
    reactions.mkdir(exist_ok=True)
    command = [bench, *map(str, paths), "--solver", solver, "--tolerance", repr(tolerance), "--repeat", str(repeat),
               "--reactions", str(reactions), "--json", *more]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=2 * limit_of(problem) * max(repeat, len(paths)))
    except subprocess.TimeoutExpired:
        return {"failure": "time limit"}, None
    lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    if len(lines) != len(paths):
        return {"failure": "crash"}, None
    results = []
    for file, answer in zip(paths, lines):
        reaction = expand(problem, np.loadtxt(reactions / f"{file.name}.txt", ndmin=1))
        results.append((answer, reaction))
    return results[0] if isinstance(path, pathlib.Path) else results


def their_solvers(problem):
    if problem.points > MANY:
        return [(name, False) for name in FOR_MANY]
    return [(name, False) for name in SOLVERS[problem.dimension]] + [(name, True) for name in RAW[problem.dimension]]


def solve_theirs(siconos, path, judge, solver, raw, tolerance):
    """Returns the loosest of three settings of their tolerance with which the answer is accurate enough."""
    answer = {}
    for tighten in (1.0, 0.1, 0.01) if not raw else (1.0,):
        request = {"problem": str(path), "solver": solver, "raw": raw, "tolerance": tolerance, "tighten": tighten, "repeat": REPEAT}
        reply, reaction = siconos.ask(request, limit_of(judge.problem))
        answer = judge.assess({**reply, "tighten": tighten}, reaction, tolerance)
        if answer["solved"] or answer.get("status") != 0:  # a smaller tolerance would fail as well
            break
    return answer


def forget_fastest(cache, count, solvers):
    """Removes their `count` fastest answers of each problem and tolerance, and all of `solvers`, from the cache."""
    answers = {}
    for key, answer in cache.items():
        stamp, solver, _, tolerance = key.split("|")
        if answer["solved"]:
            answers.setdefault((stamp, tolerance), []).append((answer["seconds"], key))
            if solver in solvers:
                answers[stamp, tolerance][-1] = (0.0, key)
    for entries in answers.values():
        for place, (seconds, key) in enumerate(sorted(entries)):
            if place < count or seconds == 0.0:
                del cache[key]


def run_problems(arguments, directory, our_solvers):
    cache_file = directory / "theirs.json"
    cache = json.loads(cache_file.read_text()) if cache_file.exists() else {}
    if arguments.again:
        forget_fastest(cache, arguments.again, arguments.again_solvers)
    siconos = Siconos(directory, blas_kernels(arguments.libraries))
    records, table = [], []
    paths = [path for path in (directory / "problems").glob("*.hdf5") if arguments.only in path.name]
    paths.sort(key=lambda path: (path.stat().st_size // 100000, path.name))  # small ones first
    for number, path in enumerate(paths):
        problem = fclib.read(path)
        judge = Judge(problem)
        stamp = f"{siconos.kernels}:{path.name}:{path.stat().st_size}:{np.abs(problem.operator).sum():.17g}:{problem.offset @ problem.offset:.17g}"
        _, start = run_ours(arguments.bench, directory, path, problem, "automatic", 1e-12, 1)
        if start is None or judge.measure.residual(start) > 1e-6:
            _, start = siconos.ask({"problem": str(path), "solver": "NSGS", "tolerance": 1e-8}, 100.0)
        judge.set_reference(start)
        entry = describe.describe(path, judge.reference.astype(float), with_condition=problem.points < 1200)
        table.append({"problem": path.stem, **entry, "reference_residual": judge.reference_residual, "floor": judge.floor})
        begin = len(records)
        for solver in our_solvers:
            hopeless = False
            for tolerance in arguments.tolerances:
                repeat = REPEAT if problem.points < 1000 else 3
                if solver != "automatic" and problem.points >= 300:
                    repeat = 1
                answer, reaction = ({"failure": "failed at a larger tolerance"}, None) if hopeless else run_ours(
                    arguments.bench, directory, path, problem, solver, tolerance, repeat)
                if answer.get("outcome") == "not_applicable":
                    break
                answer = judge.assess(answer, reaction, tolerance)
                hopeless = solver != "automatic" and not answer["solved"]
                records.append({"problem": path.stem, "by": "ricochet", "solver": solver, "raw": False, "tolerance": tolerance,
                                **{key: answer[key] for key in answer if key not in ("problem", "solver", "tolerance")}})
        if not arguments.ours_only:
            for solver, raw in their_solvers(problem):
                if not raw and "-in-" in path.stem:  # identical to the problem scaled to unit size
                    continue
                hopeless = False
                for tolerance in arguments.tolerances:
                    key = f"{stamp}|{solver}|{raw}|{tolerance}"
                    if key not in cache:
                        cache[key] = ({"failure": "failed at a larger tolerance", "solved": False} if hopeless
                                      else solve_theirs(siconos, path, judge, solver, raw, tolerance))
                    hopeless = hopeless or not cache[key]["solved"]
                    records.append({"problem": path.stem, "by": "siconos", "solver": solver, "raw": raw, "tolerance": tolerance,
                                    **cache[key]})
            cache_file.write_text(json.dumps(cache))
        progress(number + 1, len(paths), path.stem, records[begin:])
        (directory / arguments.results).write_text(json.dumps({"libraries": arguments.libraries, "problems": table, "records": records}, indent=1))
    siconos.stop()


def progress(number, count, name, records):
    at = [record for record in records if record["tolerance"] == 1e-8 and record["solved"]]
    ours = [record["seconds"] for record in at if record["by"] == "ricochet" and record["solver"] == "automatic"]
    theirs = min(((r["seconds"], r["solver"]) for r in at if r["by"] == "siconos"), default=(float("nan"), "none"))
    own = f"{ours[0] * 1e3:9.3f}" if ours else "   failed"
    print(f"{number:3d}/{count} {name:52s} ours {own} ms   theirs {theirs[0] * 1e3:9.3f} ms {theirs[1]}", file=sys.stderr, flush=True)


WARM = {2: ("NSGS", "NSGS-shuffle", "CPG"), 3: ("NSGS-newton-blocks", "NSGS-projection-blocks", "NSGS-newton-freeze",
        "NSN_AC", "NSN_AC-extragradient", "VI_EG", "ADMM")}


def run_sequences(arguments, directory):
    """Runs consecutive steps: each program starts from its own last reactions."""
    siconos = Siconos(directory, blas_kernels(arguments.libraries))
    results = []
    for folder in sorted((directory / "sequences").iterdir()):
        if arguments.only not in folder.name:
            continue
        paths = sorted(folder.glob("*.hdf5"))
        problems = [fclib.read(path) for path in paths]
        judges = [Judge(problem) for problem in problems]
        for tolerance in (1e-8,):
            answers = run_ours(arguments.bench, directory, paths, problems[0], "automatic", tolerance, 3, ["--sequence"])
            for judge, (_, reaction) in zip(judges, answers):
                judge.set_reference(reaction)
            ours = [judge.assess(answer, reaction, tolerance) for judge, (answer, reaction) in zip(judges, answers)]
            results.append(sequence_record(folder.name, problems[0], "ricochet", "automatic", tolerance, ours))
            if arguments.ours_only:
                continue
            for solver in WARM[problems[0].dimension]:
                theirs, last = [], None
                for path, judge in zip(paths, judges):
                    best, best_reaction = None, None
                    for tighten in (1.0, 0.1, 0.01):
                        request = {"problem": str(path), "solver": solver, "tolerance": tolerance, "tighten": tighten, "repeat": 3}
                        if last is not None:
                            request["start"] = last
                        reply, reaction = siconos.ask(request, SMALL_LIMIT)
                        best, best_reaction = judge.assess(reply, reaction, tolerance), reaction
                        if best["solved"] or reaction is None:
                            break
                    theirs.append(best)
                    if best_reaction is not None and np.isfinite(best_reaction).all():
                        last = str(directory / "theirs-start.npy")
                        np.save(last, best_reaction)
                results.append(sequence_record(folder.name, problems[0], "siconos", solver, tolerance, theirs))
        for record in results:
            if record["sequence"] == folder.name:
                print(f"{folder.name:40s} {record['by']:9s} {record['solver']:24s} median {record['median'] * 1e3:9.3f} ms, "
                      f"{record['failures']} failures", file=sys.stderr, flush=True)
        (directory / arguments.sequences).write_text(json.dumps(results, indent=1))
    siconos.stop()


def product_seconds(problem):
    """Returns the seconds of one product W r with all rows, W dense and in double precision, which any solver needs to
    verify its result."""
    matrix, vector = problem.operator, np.ones(problem.offset.size)
    others = np.zeros(4_000_000)  # as after the linear algebra of a step: W is in no cache
    seconds = []
    for _ in range(15):
        others += 1.0
        begin = time.process_time()
        matrix @ vector
        seconds.append(time.process_time() - begin)
    return float(np.median(seconds))


def sequence_record(name, problem, by, solver, tolerance, answers):
    seconds = [answer.get("seconds", LIMIT) for answer in answers]
    return {"sequence": name, "dimension": problem.dimension, "points": problem.points, "by": by, "solver": solver,
            "product": product_seconds(problem) if by == "ricochet" else None,
            "tolerance": tolerance, "median": float(np.median(seconds[1:])), "total": float(sum(seconds)), "first": seconds[0],
            "failures": sum(not answer["solved"] for answer in answers),
            "distance": max((answer.get("distance_r", float("inf")) for answer in answers))}


def parse():
    parser = Arguments("contact", "Ricochet's contact solvers against Siconos': makes the set of problems, runs everything, and writes the tables\n"
                       "and the plot of docs/contact-solvers.md. With any option that omits a part, the tables are only printed.",
                       directory=True, build="ricochet and of its benchmark programs")
    parser.add_argument("--only", default="", metavar="NAME", help="only the cases whose name contains this text (case_table.py)")
    parser.add_argument("--default-only", action="store_true", help="of Ricochet's solvers only the default one")
    parser.add_argument("--ours-only", action="store_true", help="without Siconos' solvers")
    parser.add_argument("--no-problems", action="store_true", help="only the time sequences")
    parser.add_argument("--no-sequences", action="store_true", help="only the single problems")
    parser.add_argument("--no-hard", action="store_true", help="without the random hard problems")
    parser.add_argument("--tolerances", type=float, nargs="+", default=TOLERANCES, metavar="T", help="instead of 1e-4 1e-8 1e-12")
    parser.add_argument("--again", type=int, default=0, metavar="N",
                        help="time the N fastest of Siconos' results for each problem again (after a run on a busy machine)")
    parser.add_argument("--again-solvers", nargs="*", default=[], metavar="SOLVER",
                        help="also time all results of these solvers again")
    parser.add_argument("--write", action="store_true", help="write the page even if parts are omitted, with the cached results")
    arguments = parser.parse()
    if not any(arguments.only in case.name for case in CASES):
        parser.error(f"--only {arguments.only}: no case has a name that contains this; available: "
                     f"{', '.join(case.name for case in CASES)}")
    arguments.bench, arguments.program = str(arguments.build / "ricochet_contact_bench"), str(arguments.build / "ricochet")
    # A partial run must not overwrite the complete results.
    arguments.results, arguments.sequences = (("part.json", "part-sequences.json") if arguments.only
                                              else ("results.json", "sequences.json"))
    return arguments


def main():
    arguments = parse()
    directory = arguments.directory.resolve()
    arguments.libraries = libraries(arguments.program)
    make_set.make(arguments.program, directory, arguments.only)
    listing = output_of([arguments.program, "contact", "--list"])
    our_solvers = ["automatic"] if arguments.default_only else [line.split()[0] for line in listing.splitlines() if line.strip()]
    in_part = bool(arguments.only or arguments.default_only or arguments.ours_only or tuple(arguments.tolerances) != TOLERANCES)
    if not arguments.no_problems:
        run_problems(arguments, directory, our_solvers)
    if not arguments.no_sequences:
        run_sequences(arguments, directory)
    if not (arguments.no_hard or in_part):
        with open(directory / "hard.md", "w") as file:
            subprocess.run([str(arguments.build / "ricochet_hard_contact_bench")], stdout=file, check=True)
    left_out = in_part or arguments.no_problems or arguments.no_sequences or arguments.no_hard
    report.report(directory, arguments.results, arguments.sequences, only_print=left_out and not arguments.write)


if __name__ == "__main__":
    main()
