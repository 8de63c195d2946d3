"""Plants faults in the sources, one at a time, and reports which test finds each: a measure of the tests.

    ./dev faults [NAME...] [--all] [--jobs N]
    ./dev faults --list

Builds HEAD in a worktree below build-faults/, with one fault of faults.toml at a time, and runs the tests until one fails:
first those that the fault names, then the others of ./dev test, with --all also those with the label "long". A test that
fails is repeated alone, and counts only if it fails again, and passes at the end without any fault. Tests with the label
"timed" do not run. The status is 1 unless at least 27 of the 30 faults are found by
./dev test and, with --all, every fault is found. NAME: only these faults, of which all must be found. --list prints the
table of docs/developers/testing.md.
"""

import argparse
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from worktree import Worktree

WORKTREE = Worktree("faults")
FOLDER, SOURCE = WORKTREE.folder, WORKTREE.source
COUNT, REQUIRED = 30, 27
LONG = "^long$"
TIMED = "^timed$"
RESULT = re.compile(r"^ *\d+/\d+ Test +#\d+: (\S+) \.*[ *]*(\w+)", re.MULTILINE)
PASSED = {"Passed", "Skipped"}


class ListError(Exception):
    """An error of faults.toml: a fault that is not where it says, does not compile, or names no test."""


def stop(message):
    raise SystemExit(f"./dev faults: {message}")


def read_faults():
    """Returns the faults of the list after a check of its form."""
    faults = tomllib.loads((HERE / "faults.toml").read_text(encoding="utf-8"))["fault"]
    for key in ("name", "room"):
        values = [fault[key] for fault in faults]
        repeated = {value for value in values if values.count(value) > 1}
        if len(values) != COUNT or repeated:
            stop(f"faults.toml must have {COUNT} faults with different {key}s; it has {len(values)}; more than once: {repeated}")
    return faults


def run(*command):
    """Runs a command in the worktree and returns its status and output."""
    done = subprocess.run(command, cwd=SOURCE, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout.decode("utf-8", "replace")


def succeeds(*command):
    """Runs a command in the worktree. Prints its output and returns False if it fails."""
    status, output = run(*command)
    if status != 0:
        sys.stderr.write(output[-8000:])
    return status == 0


def compiles(jobs):
    return succeeds("cmake", "--build", "--preset", "release", "--parallel", str(jobs))


def run_tests(jobs, *selection, stop_on_failure=True):
    """Runs the selected entries of ctest and returns the names of those that failed. Zero entries are an error."""
    options = ["--stop-on-failure"] if stop_on_failure else []
    if "-LE" in selection:  # of several -LE ctest takes the last
        at = selection.index("-LE") + 1
        selection = (*selection[:at], f"{selection[at]}|{TIMED}", *selection[at + 1:])
    else:
        options += ["-LE", TIMED]
    status, output = run("ctest", "--preset", "release", "-j", str(jobs), "--no-tests=error", *options, *selection)
    results = RESULT.findall(output)
    if not results:
        raise ListError(f"ctest {' '.join(selection)} runs no test: {' '.join(output.split())[-200:]}")
    failed = [name for name, result in results if result not in PASSED]
    if not_run := [name for name, result in results if result == "Not"]:
        raise ListError(f"ctest cannot run {', '.join(not_run)}")
    if status != 0 and not failed:
        raise ListError(f"ctest {' '.join(selection)} fails without a failed test: {' '.join(output.split())[-200:]}")
    return failed


def first_failure(jobs, *selection, stop_on_failure=True):
    """Returns the name of the first entry that fails, and fails again alone; None if there is none. Other failures, such as
    of measurements of times on a busy machine, do not count; after one of them all selected entries run."""
    failed = run_tests(jobs, *selection, stop_on_failure=stop_on_failure)
    for name in failed:
        if run_tests(1, "-R", f"^{re.escape(name)}$"):
            return name
    if not failed:
        return None
    print(f"./dev faults: failed once, not alone: {', '.join(failed)}", file=sys.stderr)
    return first_failure(jobs, *selection, stop_on_failure=False) if stop_on_failure else None


def require_passing(revision, jobs, with_long):
    """Stops unless the tests of the unchanged revision pass, as otherwise every fault would be found. A revision whose tests
    have passed is remembered."""
    for tier, label in (("test", "-LE"), *([("long", "-L")] if with_long else [])):
        mark = FOLDER / f"passed-{tier}"
        if mark.exists() and mark.read_text(encoding="utf-8") == revision:
            continue
        name = first_failure(jobs, label, LONG)
        if name is not None:
            stop(f"{name} fails in {SOURCE} without any fault")
        mark.write_text(revision, encoding="utf-8")


def require_honest(found, jobs):
    """Returns the tests that fail without any fault: the machine has changed, and they have found nothing."""
    if not found:
        return []
    if not compiles(jobs):
        stop(f"{SOURCE} does not compile without any fault")
    return run_tests(jobs, "-R", "|".join(f"^{re.escape(name)}$" for name in sorted(found)), stop_on_failure=False)


def planted(fault, text):
    """Returns a source text with the fault in it."""
    count = text.count(fault["old"])
    if count != 1:
        raise ListError(f"{fault['file']} contains the text \"{fault['old']}\" {count} times, not once")
    return text.replace(fault["old"], fault["new"])


def search(fault, jobs, with_long):
    """Returns the name of the test that finds a fault and its tier; None and None if no test does."""
    path = SOURCE / fault["file"]
    if not path.is_file():
        raise ListError(f"there is no {fault['file']}")
    original = path.read_bytes()
    try:
        path.write_bytes(planted(fault, original.decode("utf-8")).encode("utf-8"))
        if not compiles(jobs):
            raise ListError("it does not compile")
        first = [("-R", fault["tests"]), ("-E", fault["tests"])] if "tests" in fault else [()]
        stages = [("./dev test", "-LE", LONG, *part) for part in first] + [("--all", "-L", LONG)] * with_long
        for tier, *selection in stages:
            name = first_failure(jobs, *selection)
            if name is not None:
                return name, tier
        return None, None
    finally:
        path.write_bytes(original)


def table(faults):
    """Returns the list as a table in Markdown."""
    rows = [(fault["name"], f"`{fault['room']}`", fault["brief"]) for fault in faults]
    return "\n".join(["| name | room | fault |", "|---|---|---|", *(f"| {' | '.join(row)} |" for row in rows)])


def main():
    parser = argparse.ArgumentParser(prog="./dev faults", description=__doc__.split("\n\n")[2].replace("\n", " "))
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--all", action="store_true", help="also run the tests with the label \"long\"")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="processes (default: one per core)")
    parser.add_argument("--list", action="store_true", help="print the table of all faults")
    arguments = parser.parse_args()
    faults = read_faults()
    if arguments.list:
        return print(table(faults))
    unknown = set(arguments.names) - {fault["name"] for fault in faults}
    if unknown:
        parser.error(f"there is no fault {', '.join(sorted(unknown))}; see --list")
    chosen = [fault for fault in faults if not arguments.names or fault["name"] in arguments.names]
    # SIGTERM ends like Ctrl-C, and the fault is removed.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    WORKTREE.lock()
    revision = WORKTREE.git("rev-parse", "HEAD")
    WORKTREE.check_out(revision)
    configure = ["cmake", "--preset", "release", "-DRICOCHET_BUILD_TESTS=ON", "-DRICOCHET_BUILD_PYTHON=ON"]
    if not succeeds(*configure) or not compiles(arguments.jobs):
        stop(f"{SOURCE} does not compile without any fault")
    try:
        require_passing(revision, arguments.jobs, arguments.all)
    except ListError as error:
        stop(error)
    tiers, errors, finders = [], 0, set()
    for fault in chosen:
        begun = time.monotonic()
        try:
            name, tier = search(fault, arguments.jobs, arguments.all)
            outcome = f"found by {name} in {tier}" if name else "NOT FOUND"
            tiers.append(tier)
            finders |= {name} - {None}
        except ListError as error:
            outcome = f"ERROR: {error}"
            errors += 1
        print(f"{fault['name']:38} {fault['room']:22} {outcome}, {time.monotonic() - begun:.0f} s", flush=True)
    if failed := require_honest(finders, arguments.jobs):
        stop(f"{', '.join(failed)} fails in {SOURCE} without any fault, too: the faults above that it found do not count")
    by_test, by_all = tiers.count("./dev test"), len(tiers) - tiers.count(None)
    print(f"{by_test} of {len(chosen)} found by ./dev test" + (f", {by_all} by --all" if arguments.all else ""))
    required = REQUIRED if not arguments.names else 0 if arguments.all else len(chosen)
    return 0 if not errors and by_test >= required and (by_all == len(chosen) or not arguments.all) else 1


if __name__ == "__main__":
    sys.exit(main())
