#!/usr/bin/env python3
"""Random cases of every kind under every scheme: how well they conserve energy.

    ./dev bench schemes [--cases 2400] [--first 1]

Runs ricochet_random_cases on all processors, on planes and, a quarter as many each, on spheres and on rotating
obstacles, and writes the tables of docs/energy.md. A case is determined by its number, on every machine.
"""

import collections
import contextlib
import csv
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from measurement import Arguments, positive, table, write_parts

REFERENCE = "reduced-kane end, equivalent"
BINS = ((0.1, 1), (1, 3), (3, 10), (10, 30), (30, 1000))


def measure(program, kind, first, count):
    """Returns the rows of all cases on one kind of obstacle."""
    parts = min(os.cpu_count() or 1, count)
    begins = [first + count * k // parts for k in range(parts + 1)]
    rows = []
    with contextlib.ExitStack() as stack:
        # Files, as a process stops at a pipe that is not read yet.
        outputs = [stack.enter_context(tempfile.TemporaryFile("w+", encoding="utf-8")) for _ in range(parts)]
        processes = [subprocess.Popen([program, kind, str(a), str(b - a)], stdout=output)
                     for a, b, output in zip(begins, begins[1:], outputs)]
        for process, output in zip(processes, outputs):
            if process.wait() != 0:
                raise SystemExit(f"{program} failed")
            output.seek(0)
            rows += csv.DictReader(output)
    return rows


def is_refusal(failure):
    """Returns whether the method refused the case before the first step."""
    return failure and not failure.startswith("step ")


def number(value):
    return "0" if value == 0 else f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e+")


def part(values):
    return f"{100 * sum(values) / len(values):.0f} %" if values else "–"


def summary(rows):
    """Returns a line per method: runs, refusals, failures, and for completed runs energy, penetration, variation."""
    by_method = collections.defaultdict(list)
    for row in rows:
        by_method[row["method"]].append(row)
    reference = {row["case"]: float(row["variation"]) for row in by_method[REFERENCE] if not row["failure"]}
    lines, created_by_step = [], []
    for method, all_rows in by_method.items():
        if all(is_refusal(row["failure"]) for row in all_rows):
            continue
        refused = sum(1 for row in all_rows if is_refusal(row["failure"]))
        ended = [row for row in all_rows if not row["failure"]]
        created = [float(row["created"]) for row in ended]
        variation = sorted(float(row["variation"]) / reference[row["case"]] for row in ended if reference.get(row["case"], 0) > 0)
        lines.append([method, len(all_rows), refused, len(all_rows) - refused - len(ended), sum(value > 1e-8 for value in created), number(max(created)),
                      f"{100 * statistics.median(float(row['lost']) for row in ended):.0f} %", number(max(float(row["penetration"]) for row in ended)),
                      f"{statistics.median(variation):.2f}", f"{variation[int(0.9 * len(variation))]:.2f}"])
        created_by_step.append([method, *(part([float(row["created"]) > 0.01 for row in ended if low <= float(row["crossings"]) < high])
                                          for low, high in BINS)])
    return (table(["scheme, mass", "cases", "refused", "failed", "created > 1e-8", "max. created", "median lost", "deepest, cells", "variation, median",
                   "90 %"], lines), table(["scheme, mass", *(f"{low:g}–{high:g}" for low, high in BINS)], created_by_step))


def main():
    parser = Arguments("schemes", __doc__)
    parser.add_argument("--cases", type=positive, default=2400, help="number of cases on planes (default: %(default)s)")
    parser.add_argument("--first", type=int, default=1, help="number of the first case (default: %(default)s)")
    arguments = parser.parse()
    program = str(arguments.build / "ricochet_random_cases")
    planes, by_step = summary(measure(program, "plane", arguments.first, arguments.cases))
    spheres, _ = summary(measure(program, "sphere", arguments.first, max(1, arguments.cases // 4)))
    turning, _ = summary(measure(program, "turn", arguments.first, max(1, arguments.cases // 4)))
    print("\n\n".join((planes, by_step, spheres, turning)))
    write_parts("energy.md", {"random-cases": planes, "random-cases-by-step": by_step,
                                              "random-cases-on-spheres": spheres, "random-cases-on-turning-obstacles": turning})


if __name__ == "__main__":
    main()
