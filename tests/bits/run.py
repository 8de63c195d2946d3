#!/usr/bin/env python3
"""Runs the cases of two revisions and compares the bits of their results.

    ./dev bits [REVISION] [--quick] [--only TEXT...]

Compares the working tree with REVISION (by default HEAD, or HEAD~ if nothing has changed since HEAD): every case under
every scheme that accepts it, with one and two threads, resumed and, where PETSc is installed, on two ranks: checksums of
history.csv and of the last frame after 200 steps that cover the time of the case. A run that fails must fail with the same
status, and one that crashes or does not end is a difference. Prints one line for each difference; the exit status is 1 if
there is one. --quick: one thread alone, 50 steps. --only: runs whose names have one of these texts. Results of a commit are
kept in build-bits/ for later comparisons.
"""

import argparse
import hashlib
import json
import pathlib
import platform
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import revisions
from runs import ENDS, Side, all_runs, cases

KINDS = ("1 thread", "2 threads", "resumed", "2 ranks")
QUICK_STEPS, STEPS = 50, 200


def has_petsc():
    return subprocess.run(["pkg-config", "--exists", "PETSc"], check=False).returncode == 0


def machine(program):
    """Returns what results depend on beside sources and runs: processor, libraries, compiler and its options."""
    processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8")
                      if line.startswith("model name")), platform.processor())
    libraries = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.splitlines()[1:]
    cache = (pathlib.Path(program).parent / "CMakeCache.txt").read_text(encoding="utf-8")
    options = [line for line in cache.splitlines() if line.startswith(("CMAKE_CXX_FLAGS", "CMAKE_BUILD_TYPE"))]
    return "\n".join([processor, *libraries, *options])


def kept(revision, name, program):
    """Returns the file of the results of a commit: they are valid for this machine and these runs."""
    files = [HERE / "runs.py", *sorted(path for path in (HERE / "cases").iterdir() if path.is_file())]
    definition = hashlib.sha256(b"".join(path.read_bytes() for path in files) + machine(program).encode()).hexdigest()[:16]
    return revisions.FOLDER / "results" / f"{revision}-{name}-{definition}.json"


def working_tree():
    revisions.compile_programs(revisions.ROOT, has_petsc())
    return Side(revisions.ROOT)


def earlier(revision):
    root = revisions.check_out(revision)
    revisions.compile_programs(root, has_petsc())
    return Side(root)


def results(side, path, runs):
    """Returns the results of the runs of a side, which is built if the file of this path, if given, lacks some."""
    found = json.loads(path.read_text()) if path and path.exists() else {}
    if missing := [run for run in runs if str(run) not in found]:
        found.update(side().results(missing))
    return {str(run): found[str(run)] for run in runs}


def keep(path, found):
    """Adds results to the file of this path, except those of runs that did not end by themselves."""
    before = json.loads(path.read_text()) if path.exists() else {}
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(before | {name: run for name, run in found.items() if run["status"] in ENDS}, indent=0))


def chosen(runs, texts):
    """Returns the runs whose names contain one of these texts, at least one for each."""
    for text in texts:
        if not any(text in str(run) for run in runs):
            raise SystemExit(f"./dev bits: there is no run to compare whose name contains \"{text}\" (REVISION precedes --only)")
    return [run for run in runs if any(text in str(run) for text in texts)]


def differences(runs, old, new):
    """Returns a line for each run that differs."""
    def shown(value):
        return "-" if value in ("", None) else value

    texts = {"plan": "run as", "status": "status", "history": "history.csv", "frame": "last frame"}
    lines = []
    for name in map(str, runs):
        parts = [f"{text} {shown(old[name][key])} -> {shown(new[name][key])}" for key, text in texts.items()
                 if old[name][key] != new[name][key]]
        if parts:
            lines.append(f"{name}: {', '.join(parts)}")
    return lines


def faults(found):
    """Returns a line for each run that neither ended nor was refused, be it on both sides."""
    return [f"{name}: ended with status {run['status']}" for name, run in found.items()
            if run["status"] not in (*ENDS, None)]


def main():
    parser = argparse.ArgumentParser(prog="./dev bits", description=__doc__.split("\n\n")[2].replace("\n", " "))
    parser.add_argument("revision", nargs="?")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", default=[""], metavar="TEXT")
    arguments = parser.parse_args()
    begun = time.monotonic()
    revisions.lock()
    state = revisions.state()
    is_clean = not state[1]
    revision = revisions.commit(arguments.revision)
    if is_clean and revision == state[0]:
        raise SystemExit(f"./dev bits: {revision[:8]} is the working tree itself; name an earlier revision, or none for HEAD~")
    tree = working_tree()
    name, steps, kinds = ("quick", QUICK_STEPS, KINDS[:1]) if arguments.quick else ("whole", STEPS, KINDS)
    if not has_petsc():
        kinds = [kind for kind in kinds if kind != "2 ranks"]
        print("./dev bits: no runs on two ranks: PETSc is not installed", file=sys.stderr)
    runs = chosen(all_runs(cases(tree.root) | revisions.cases(revision), tree.program, kinds, steps), arguments.only)
    own = kept(state[0], name, tree.program)
    new = results(lambda: tree, own if is_clean else None, runs)
    if revisions.state() != state:
        raise SystemExit("./dev bits: the sources changed between the compilation and the end of the runs: start it again")
    if is_clean:
        keep(own, new)
    old = results(lambda: earlier(revision), kept(revision, name, tree.program), runs)
    keep(kept(revision, name, tree.program), old)
    found = differences(runs, old, new) + faults(new)
    print("\n".join(found), end="\n" if found else "")
    done = [run for run in new.values() if run["status"] in (0, 5)]
    if not done:
        raise SystemExit("./dev bits: no run reached its end, so that nothing was compared")
    print(f"{len(runs)} runs compared with {revision[:8]} ({len(done)} of them to their end, "
          f"{sum(run['touches'] for run in done)} with contact), {len(found)} differ, "
          f"{time.monotonic() - begun:.0f} s")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
