"""Prints the slowest thirty entries of the last run of CTest, and the tests that were skipped.

    after_run.py BUILD_DIRECTORY
"""

import pathlib
import re
import sys

ENTRY = re.compile(r"^\d+/\d+ Testing: (?P<name>.*?)$(?P<output>.*?)^Test time = +(?P<seconds>[0-9.]+) sec$(?P<end>.*?)^\"",
                   re.MULTILINE | re.DOTALL)
# GoogleTest names each skipped test (twice), unittest and pytest count them.
SKIPPED = re.compile(r"^\[  SKIPPED \] (\S+) \(\d+ ms\)$|\b(skipped=\d+)\b|\b(\d+ skipped)\b", re.MULTILINE)
ALL_SKIPPED = "Skip regular expression found in output"


def entries(build):
    """Returns name, seconds and output of each entry."""
    log = build / "Testing" / "Temporary" / "LastTest.log"
    text = log.read_text(errors="replace") if log.exists() else ""
    return [(each["name"], float(each["seconds"]), each["output"] + each["end"]) for each in ENTRY.finditer(text)]


def skipped(output):
    """Returns the names of the tests that an entry skipped, or their number."""
    return ["".join(groups) for groups in SKIPPED.findall(output)] + ["all of it"] * (ALL_SKIPPED in output)


def main():
    ran = entries(pathlib.Path(sys.argv[1]))
    if not ran:
        return
    print("\nThe slowest entries, in seconds:")
    for name, seconds, _ in sorted(ran, key=lambda each: -each[1])[:30]:
        print(f"{seconds:9.1f}  {name}")
    found = [(name, what) for name, _, output in ran for what in skipped(output)]
    if found:
        print("\nSkipped:")
    for name, what in found:
        print(f"  {name}: {what}")


if __name__ == "__main__":
    main()
