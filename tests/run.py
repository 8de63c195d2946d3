"""Runs CTest on one tier of the tests, then prints the slowest entries and the skipped tests.

    run.py test|mpi|sanitize|sanitize-quick [--all] [arguments of ctest]

The status is that of ctest, or 1 if an entry skips a test without a reason in SKIPS. A selection that finds no test is an
error.
"""

import argparse
import dataclasses
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


@dataclasses.dataclass(frozen=True)
class Tier:
    command: str
    preset: str
    build: str
    label: str = ""     # of its entries
    excluded: str = ""  # label of entries that run only if they are selected
    jobs: int = os.cpu_count()


TIERS = {"test": Tier("./dev test", "release", "build", excluded="^long$"),
         # One entry at a time: each starts several processes.
         "mpi": Tier("./dev test --mpi", "release", "build", label="^distributed$", jobs=1),
         "sanitize": Tier("./dev sanitize", "debug", "build-debug"),
         "sanitize-quick": Tier("./dev sanitize --quick", "sanitize", "build-sanitize", label="^sanitize$")}
OTHERS_BEFORE = "OpenBLAS has threads of an earlier test (unit.base.blas_kernels runs these first), or the compiler fuses no product and sum"
# Entries that may skip tests, and why: each test runs in another entry, or on another machine.
SKIPS = {"unit.base.instruction_sets": "the compiler fuses no product and sum",
         "unit.base.blas_kernels": "needs a processor with more than one set of kernels, and an OpenBLAS that can change them",
         "unit.instruction_sets.x86-64": OTHERS_BEFORE,
         "unit.instruction_sets.x86-64-v3": f"{OTHERS_BEFORE}, or the processor lacks this set",
         "end_to_end.instruction_sets": "needs a processor with several instruction sets",
         "end_to_end.completion": "needs fish",
         "end_to_end.show_in_paraview": "needs ParaView: apt-get install python3-paraview paraview xvfb xauth",
         "end_to_end.command_line": "needs a terminal (/dev/pts)",
         "end_to_end.full_disk": "needs the right to mount a small disk",
         "python.wheel": "needs pip",
         "python.examples": "needs nbclient"}
ENTRY = re.compile(r"^\d+/\d+ Testing: (?P<name>.*?)$(?P<output>.*?)^Test time = +(?P<seconds>[0-9.]+) sec$(?P<end>.*?)^\"",
                   re.MULTILINE | re.DOTALL)
# GoogleTest names each skipped test (twice), unittest and pytest count them.
SKIPPED = re.compile(r"^\[  SKIPPED \] (\S+) \(\d+ ms\)$|\b(skipped=\d+)\b|\b(\d+ skipped)\b", re.MULTILINE)
ALL_SKIPPED = "Skip regular expression found in output"


def parse(words):
    tier = TIERS[next(word for word in words if word in TIERS)]
    parser = argparse.ArgumentParser(prog=tier.command, usage="%(prog)s [options]", allow_abbrev=False)
    parser.add_argument("tier", choices=TIERS, help=argparse.SUPPRESS)
    parser.add_argument("--check", action="store_true", help=argparse.SUPPRESS)
    if tier.excluded:
        parser.add_argument("--all", action="store_true", help="also the long tests")
    parser.add_argument("-R", "--tests-regex", help="entries with this in their names, long ones included")
    parser.add_argument("-L", "--label-regex", action="append", default=[], help="entries with this label, long ones included")
    parser.add_argument("-E", "--exclude-regex", help="no entries with this in their names")
    parser.add_argument("-LE", "--label-exclude", action="append", default=[], help="no entries with this label")
    parser.add_argument("-j", "--parallel", type=int, default=tier.jobs, help="entries beside each other")
    parser.add_argument("-N", "--show-only", action="store_true", help="print the entries, and run none")
    parser.add_argument("-V", "--verbose", action="store_true", help="print the output of all entries")
    parser.add_argument("--rerun-failed", action="store_true", help="the entries that failed in the last run")
    parser.add_argument("--stop-on-failure", action="store_true")
    parser.add_argument("--timeout", help="seconds for an entry without a limit of its own")
    parser.add_argument("--repeat", help="until-fail:N, until-pass:N or after-timeout:N")
    if glued := [word for word in words if re.match(r"-LE.", word)]:
        parser.error(f"put a blank after -LE in {glued[0]}")
    return tier, parser.parse_args(words)


def leaves_out(tier, given):
    """Returns whether the entries that the tier excludes do not run: they are neither selected nor requested."""
    return tier.excluded and not (given.all or given.tests_regex or given.label_regex or given.rerun_failed)


def ctest_arguments(tier, given):
    """Returns the arguments of ctest, which takes the last of several -LE."""
    result = ["--preset", tier.preset, "--no-tests=error", "-j", str(given.parallel)]
    for label in [tier.label, *given.label_regex] if tier.label else given.label_regex:
        result += ["-L", label]
    if excluded := [tier.excluded, *given.label_exclude] if leaves_out(tier, given) else given.label_exclude:
        result += ["-LE", "|".join(excluded)]
    for option, value in (("-R", given.tests_regex), ("-E", given.exclude_regex), ("--timeout", given.timeout),
                          ("--repeat", given.repeat)):
        result += [option, value] if value is not None else []
    for option, is_given in (("-N", given.show_only), ("-V", given.verbose), ("--rerun-failed", given.rerun_failed),
                             ("--stop-on-failure", given.stop_on_failure)):
        result += [option] if is_given else []
    return result


def entries(log):
    """Returns name, seconds and output of each entry in a log of ctest."""
    text = log.read_text(errors="replace") if log.exists() else ""
    return [(each["name"], float(each["seconds"]), each["output"] + each["end"]) for each in ENTRY.finditer(text)]


def skipped(output):
    """Returns the names of the tests that an entry skipped, or their number."""
    return ["".join(groups) for groups in SKIPPED.findall(output)] + ["all of it"] * (ALL_SKIPPED in output)


def report(ran):
    """Prints the slowest entries and the skipped tests. Returns whether each of these has a reason."""
    print("\nThe slowest entries, in seconds:")
    for name, seconds, _ in sorted(ran, key=lambda each: -each[1])[:30]:
        print(f"{seconds:9.1f}  {name}")
    found = [(name, what) for name, _, output in ran for what in skipped(output)]
    if found:
        print("\nSkipped:")
    for name, what in found:
        print(f"  {name}: {what}: {SKIPS.get(name, 'ERROR: tests/run.py has no reason for it')}")
    return all(name in SKIPS for name, _ in found)


def main():
    tier, given = parse(sys.argv[1:])
    if given.check:
        return 0
    log = ROOT / tier.build / "Testing" / "Temporary" / "LastTest.log"
    log.unlink(missing_ok=True)
    status = subprocess.run(["ctest", *ctest_arguments(tier, given)], cwd=ROOT, check=False).returncode
    ran = entries(log)
    has_reasons = not ran or report(ran)
    if leaves_out(tier, given):
        print("The long tests were not run (every case, benchmark and tutorial, among others): ./dev test --all runs them, too.")
    return status or (0 if has_reasons else 1)


if __name__ == "__main__":
    sys.exit(main())
