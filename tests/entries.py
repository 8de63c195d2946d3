"""Writes the CTest entries of a GoogleTest program: one for each source file, whose tests share a process.

    entries.py [-x PATTERN]… [--label LABEL=NAME]… PROGRAM FOLDER OUTPUT [NAME=VALUE]…

An entry is named after its file (FOLDER unit, unit/mesh/refine_test.cpp: unit.mesh.refine). NAME=VALUE are properties of
all entries. -x leaves out tests that match a pattern of --gtest_filter; --label gives an entry one more label.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile


def tests_by_file(program, excluded):
    """Returns the names of the tests of each source file, in the format of --gtest_filter."""
    with tempfile.TemporaryDirectory() as folder:
        listing = pathlib.Path(folder) / "tests.json"
        chosen = [f"--gtest_filter=-{':'.join(excluded)}"] if excluded else []
        # A filter of the user's shell does not concern the list. Leaks inside libraries that stay loaded until the end are
        # not ours to report.
        environment = {name: value for name, value in os.environ.items() if not name.startswith("GTEST_")}
        subprocess.run([program, "--gtest_list_tests", f"--gtest_output=json:{listing}", *chosen], check=True,
                       stdout=subprocess.DEVNULL, env={**environment, "ASAN_OPTIONS": "detect_leaks=0"})
        suites = json.loads(listing.read_text())["testsuites"]
    files = {}
    for suite in suites:
        for test in suite["testsuite"]:
            files.setdefault(test["file"], {}).setdefault(suite["name"], []).append(test["name"])
    return files


def filters(files, excluded):
    """Returns a filter for each file: by suites if these are in no other file."""
    owners = {}
    for path, suites in files.items():
        for suite in suites:
            owners.setdefault(suite, set()).add(path)
    for path, suites in sorted(files.items()):
        patterns = []
        for suite, names in suites.items():
            patterns += [f"{suite}.*"] if len(owners[suite]) == 1 else [f"{suite}.{name}" for name in names]
        yield path, ":".join(patterns) + (f"-{':'.join(excluded)}" if excluded else "")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("-x", action="append", default=[], dest="excluded")
    parser.add_argument("--label", action="append", default=[], dest="labels")
    parser.add_argument("properties", nargs="*")
    arguments = parser.parse_args()
    lines, labels = [], {}
    for label, name in (each.split("=", 1) for each in arguments.labels):
        labels.setdefault(name, []).append(label)
    for path, chosen in filters(tests_by_file(arguments.program, arguments.excluded), arguments.excluded):
        parts = pathlib.Path(path).relative_to(arguments.folder).with_suffix("").parts
        name = ".".join((arguments.folder.name, *parts)).removesuffix("_test")
        lines.append(f'add_test([=[{name}]=] [=[{arguments.program}]=] [=[--gtest_filter={chosen}]=])')
        more = labels.pop(name, [])
        properties = [";".join([each, *more]) if each.startswith("LABELS=") else each for each in arguments.properties]
        values = " ".join("{} [=[{}]=]".format(*each.split("=", 1)) for each in properties)
        lines.append(f"set_tests_properties([=[{name}]=] PROPERTIES {values})")
    if unknown := [name for name in labels if name.startswith(arguments.folder.name + ".")]:
        raise SystemExit(f"entries.py: there is no entry {', '.join(sorted(unknown))}; correct the lists of long or sanitized tests")
    if not lines:
        raise SystemExit(f"entries.py: {arguments.program} has no tests")
    arguments.output.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
