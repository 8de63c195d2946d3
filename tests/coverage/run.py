"""Measures the lines of C++ that the tests execute: of ./dev test, of the tests with the label "sanitize", and of all.

    ./dev coverage [--jobs N] [--choose] [--keep]

Builds the preset "coverage" (clang, counters in every function) in build-coverage/, runs every entry of ctest with counters
of its own, and prints the share of lines by folder and tier. The status is 1 if ./dev test covers more than 3 points less
than all tests. Tests that fail are named: their lines count. --choose prints the tests without the label "long" in the order
in which they add most lines per second, which is how those with the label "sanitize" are chosen: a sanitizer finds errors
only in lines that are executed. --keep takes the counters of the last run. Tests with the label "timed" do not run.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build-coverage"
PROFILES = BUILD / "profiles"
RUNS = PROFILES / "runs.json"
LIMIT = 3.0
OBJECTS = ("lib/*.so*", "ricochet", "test_unit", "test_verification", "test_allocations", "python/ricochet/*.so")
FOLDERS = ("src/", "apps/", "python/")
FEWEST_SOURCES = 400  # of the library; fewer are measured if its objects are not found


def entries():
    """Returns the labels of each entry of ctest."""
    listing = subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1"], check=True, stdout=subprocess.PIPE).stdout
    result = {}
    for test in json.loads(listing)["tests"]:
        properties = {each["name"]: each["value"] for each in test.get("properties", [])}
        result[test["name"]] = set(properties.get("LABELS", []))
    return {name: labels for name, labels in result.items() if "timed" not in labels}


def run(name):
    """Runs one entry with counters of its own. Returns whether it passed, and its seconds."""
    folder = PROFILES / name
    folder.mkdir(parents=True)
    begun = time.monotonic()
    # %m: one file per program and library, into which processes merge their counters.
    done = subprocess.run(["ctest", "--test-dir", BUILD, "-R", f"^{re.escape(name)}$", "--no-tests=error"], check=False,
                          env={**os.environ, "LLVM_PROFILE_FILE": f"{folder}/%m.profraw"}, stdout=subprocess.DEVNULL,
                          stderr=subprocess.STDOUT)
    return done.returncode == 0, time.monotonic() - begun


def measure(names, jobs):
    """Runs all entries, and keeps what is known of each beside the counters."""
    shutil.rmtree(PROFILES, ignore_errors=True)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        results = dict(zip(names, pool.map(run, names)))
    failed = [name for name, (passed, _) in results.items() if not passed]
    RUNS.write_text(json.dumps({"seconds": {n: s for n, (_, s) in results.items()}, "failed": failed}))


def objects():
    """Returns all programs and libraries, each once."""
    return dict.fromkeys(path.resolve() for pattern in OBJECTS for path in sorted(BUILD.glob(pattern)))


def lines_of(names, label):
    """Returns for each source file the lines with code, and those that some of these entries executed."""
    present, executed, current = collections.defaultdict(set), collections.defaultdict(set), None
    raw = [str(path) for name in names for path in sorted((PROFILES / name).glob("*.profraw")) if path.stat().st_size > 0]
    if not raw:
        return present, executed
    merged, inputs = PROFILES / f"{label}.profdata", PROFILES / f"{label}.txt"
    inputs.write_text("\n".join(raw) + "\n")
    # Profiles that killed processes left incomplete are named on stderr, and left out.
    if subprocess.run(["llvm-profdata", "merge", "-sparse", "-failure-mode=all", "-f", inputs, "-o", merged], check=False).returncode:
        return present, executed
    arguments = [argument for path in objects() for argument in ("-object", str(path))][1:]
    export = subprocess.run(["llvm-cov", "export", "-format=lcov", f"-instr-profile={merged}", *arguments], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    for line in export.splitlines():
        if line.startswith("SF:"):
            path = os.path.relpath(line[3:], ROOT)
            current = path if path.startswith(FOLDERS) else None
        elif current is not None and line.startswith("DA:"):
            number, count = line[3:].split(",")[:2]
            present[current].add(int(number))
            if count != "0":
                executed[current].add(int(number))
    return present, executed


def folder_of(path):
    """Returns the folder of a source file as the table names it: for the library that below src/ricochet."""
    parts = pathlib.Path(path).parent.parts
    return parts[2] if parts[:2] == ("src", "ricochet") and len(parts) > 2 else "/".join(parts[:2])


def count(lines, folder):
    return sum(len(numbers) for path, numbers in lines.items() if folder in (None, folder_of(path)))


def print_table(tiers, present):
    """Prints the share of lines that each tier executes, by folder, and returns those of all folders."""
    print(f"| folder | lines | {' | '.join(tiers)} |\n|{'---|' * (len(tiers) + 2)}")
    for folder in [*sorted({folder_of(path) for path in present}), None]:
        lines = count(present, folder)
        shares = [100.0 * count(executed, folder) / lines for executed in tiers.values()]
        print(f"| {f'`{folder}`' if folder else 'all'} | {lines} | {' | '.join(f'{share:.1f} %' for share in shares)} |")
    return dict(zip(tiers, shares))


def choose(names, seconds):
    """Prints entries in the order in which they add most lines per second, with the share that all so far execute."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        executed = [lines for _, lines in pool.map(lambda name: lines_of([name], name), names)]
    left = {name: {(path, line) for path, numbers in lines.items() for line in numbers} for name, lines in zip(names, executed)}
    everything, covered, spent = len(set().union(*left.values())), 0, 0.0
    while left:
        best = max(left, key=lambda name: len(left[name]) / seconds[name])
        added = left.pop(best)
        if not added:
            break
        covered, spent = covered + len(added), spent + seconds[best]
        print(f"{100.0 * covered / everything:6.2f} % {spent:7.1f} s {len(added):6} lines  {best}")
        for lines in left.values():
            lines -= added


def main():
    parser = argparse.ArgumentParser(prog="./dev coverage", description=__doc__.split("\n\n")[2].replace("\n", " "))
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="processes (default: one per core)")
    parser.add_argument("--choose", action="store_true", help="also print the tests by the lines that they add")
    parser.add_argument("--keep", action="store_true", help="use the counters of the last run")
    parser.add_argument("--check", action="store_true", help="only check the arguments")
    arguments = parser.parse_args()
    if arguments.check:
        return 0
    labels = entries()
    if not arguments.keep:
        measure(list(labels), arguments.jobs)
    if not RUNS.exists() or any(path.stat().st_mtime > RUNS.stat().st_mtime for path in objects()):
        raise SystemExit("./dev coverage: there are no counters of the present programs; run it without --keep")
    runs = json.loads(RUNS.read_text())
    if runs["failed"]:
        print(f"./dev coverage: these tests failed: {', '.join(runs['failed'])}", file=sys.stderr)
    tiers = {"./dev sanitize --quick": [name for name in labels if "sanitize" in labels[name]],
             "./dev test": [name for name in labels if "long" not in labels[name]], "./dev test --all": list(labels)}
    executed = {tier: lines_of(names, f"tier{i}") for i, (tier, names) in enumerate(tiers.items())}
    present = executed["./dev test --all"][0]
    sources = sum(path.startswith("src/ricochet/") and path.endswith(".cpp") for path in present)
    if sources < FEWEST_SOURCES:
        raise SystemExit(f"./dev coverage: only {sources} sources of the library were measured, not at least {FEWEST_SOURCES}")
    shares = print_table({tier: lines for tier, (_, lines) in executed.items()}, present)
    if arguments.choose:
        choose(tiers["./dev test"], runs["seconds"])
    return 0 if not runs["failed"] and shares["./dev test"] >= shares["./dev test --all"] - LIMIT else 1


if __name__ == "__main__":
    sys.exit(main())
