#!/usr/bin/python3
"""Writes tables and plots of the results of run.py into docs/contact-solvers.md (between its markers) and docs/figures.

    report.py [--directory build/bench-contact] [--print]
"""

import argparse
import datetime
import json
import pathlib
import statistics
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from measurement import BUILD, ROOT, blas_kernels, processor, table, write_parts

DEFAULT = ("ricochet", "automatic", False)
INFINITE = float("inf")


def is_rescaled(name):
    return "-in-" in name


def label(key):
    by, solver, raw = key
    return f"{'Ricochet' if by == 'ricochet' else 'Siconos'} {solver}{', unscaled' if raw else ''}"


class Results:
    def __init__(self, path):
        data = json.loads(path.read_text())
        self.libraries = data.get("libraries", "")
        self.problems = {entry["problem"]: entry for entry in data["problems"]}
        self.cells = {}
        for record in data["records"]:
            key = record["by"], record["solver"], record["raw"]
            self.cells[record["problem"], key, record["tolerance"]] = record
        self.tolerances = sorted({key[2] for key in self.cells}, reverse=True)

    def names(self, dimension, rescaled=False):
        return [name for name, entry in self.problems.items() if entry["dimension"] == dimension and is_rescaled(name) == rescaled]

    def solvers(self, dimension):
        names = set(self.names(dimension))
        return sorted({key for name, key, _ in self.cells if name in names}, key=lambda key: (key[0], key[2], key[1]))

    def seconds(self, name, key, tolerance):
        record = self.cells.get((name, key, tolerance))
        return record["seconds"] if record and record["solved"] else INFINITE

    def run(self, names, key, tolerance):
        """Returns the problems on which this solver was run."""
        return [name for name in names if (name, key, tolerance) in self.cells]

    def best_of_theirs(self, name, tolerance):
        return min((self.seconds(n, key, t) for n, key, t in self.cells if n == name and t == tolerance and key[0] == "siconos"),
                   default=INFINITE)


def milliseconds(seconds):
    return "–" if seconds == INFINITE else f"{seconds * 1e3:.3g}"


def number(value, form="{:.1e}"):
    return "–" if value in (None, INFINITE) or value != value else form.format(value)


def solver_table(results, dimension, tolerance):
    names = results.names(dimension)
    fastest = {}
    for name in names:
        times = {key: results.seconds(name, key, tolerance) for key in results.solvers(dimension)}
        winner = min(times, key=times.get)
        fastest[winner] = fastest.get(winner, 0) + 1
    rows = []
    for key in results.solvers(dimension):
        records = [results.cells[name, key, tolerance] for name in names if (name, key, tolerance) in results.cells]
        if not records:
            continue
        run = results.run(names, key, tolerance)
        times = [results.seconds(name, key, tolerance) for name in run]
        ratios = [results.seconds(name, key, tolerance) / results.seconds(name, DEFAULT, tolerance)
                  for name in run if results.seconds(name, DEFAULT, tolerance) < INFINITE]
        good = [record for record in records if record["solved"]]
        rows.append((statistics.median(times), key, [
            label(key), f"{sum(not r['solved'] for r in records)} of {len(records)}", milliseconds(statistics.median(times)),
            number(statistics.median(ratios) if ratios else None, "{:.2f}"), str(fastest.get(key, 0)),
            number(max((r["residual"] for r in good), default=None)), number(max((r["distance_r"] for r in good), default=None))]))
    return table(["solver", "failures", "median time, ms", "time / ours, median", "fastest in", "largest residual", "largest distance"],
                 [[f"**{cell}**" for cell in cells] if key == DEFAULT else cells for _, key, cells in sorted(rows, key=lambda row: (row[0], row[1]))])


def ratio_table(results):
    rows = []
    for dimension in (2, 3):
        names = results.names(dimension)
        for tolerance in results.tolerances:
            ours = {name: results.seconds(name, DEFAULT, tolerance) for name in names}
            ratios = [results.best_of_theirs(name, tolerance) / ours[name] for name in names if ours[name] < INFINITE]
            if not ratios:
                continue
            quartiles = ", ".join(number(value, "{:.2f}") for value in np.quantile(ratios, (0.25, 0.5, 0.75)))
            single = [(statistics.median(results.seconds(name, key, tolerance) for name in run), key)
                      for key in results.solvers(dimension) if key[0] == "siconos" and (run := results.run(names, key, tolerance))]
            best = min(single, default=(INFINITE, ("siconos", "none", False)))
            median = statistics.median(ours.values())
            failures = sum(value == INFINITE for value in ours.values())
            rows.append([f"{dimension}D", len(names), f"{tolerance:g}", failures, quartiles,
                         f"{milliseconds(best[0])} ms ({best[1][1]}) / {milliseconds(median)} ms = {best[0] / median:.2f}"])
    return table(["", "problems", "tolerance", "failures of the default solver", "Siconos' best solver for each problem / ours: quartiles",
                  "Siconos' best single solver / ours, medians"], rows)


GROUPS = ["below 30", "30 to 2000", "above 2000", "not computed"]


def group_of(entry):
    condition = entry["condition"]
    return GROUPS[3 if condition is None else 0 if condition < 30 else 1 if condition < 2000 else 2]


def group_table(results, tolerance=1e-8):
    rows = []
    for dimension in (2, 3):
        groups = {}
        for name in results.names(dimension):
            groups.setdefault(group_of(results.problems[name]), []).append(name)
        for group, names in sorted(groups.items(), key=lambda item: GROUPS.index(item[0])):
            ratios, winners = [], {}
            for name in names:
                times = {key: results.seconds(name, key, tolerance) for key in results.solvers(dimension) if key[0] == "siconos"}
                if not times:
                    continue
                winner = min(times, key=times.get)
                winners[winner[1]] = winners.get(winner[1], 0) + 1
                ours = results.seconds(name, DEFAULT, tolerance)
                ratios.append(times[winner] / ours if ours < INFINITE else 0.0)
            points = sorted(results.problems[name]["points"] for name in names)
            often = ", ".join(f"{name} {count}" for name, count in sorted(winners.items(), key=lambda item: -item[1])[:4])
            if ratios:
                rows.append([f"{dimension}D", group, len(names), f"{points[0]} to {points[-1]}", f"{statistics.median(ratios):.2f}", often])
    return table(["", "cond W", "problems", "points", "Siconos' best / ours, median", "Siconos' fastest solvers, number of problems"], rows)


def claims_table(results):
    """Table of the claims of solvers without scaling, which use the tolerance unchanged."""
    rows = []
    for dimension in (2, 3):
        names = results.names(dimension) + results.names(dimension, rescaled=True)
        for key in results.solvers(dimension):
            if not key[2]:
                continue
            for tolerance in results.tolerances:
                claimed = [r for name in names if (r := results.cells.get((name, key, tolerance))) and r.get("status") == 0]
                wrong = [r for r in claimed if not r["solved"]]
                rows.append([f"{dimension}D {key[1]}", f"{tolerance:g}", f"{len(claimed)} of {len(names)}", len(wrong),
                             *(number(max((r[size] for r in claimed), default=None)) for size in ("residual", "distance_r"))])
    return table(["solver, W and q unscaled", "tolerance", "reported as solved", "of these not solved", "largest true residual", "largest distance"], rows)


def sequence_table(path):
    if not path.exists():
        return ""
    records, rows, ratios = json.loads(path.read_text()), [], []
    for name in sorted({record["sequence"] for record in records}):
        ours = next(r for r in records if r["sequence"] == name and r["by"] == "ricochet")
        theirs = [r for r in records if r["sequence"] == name and r["by"] == "siconos"]
        best = min(theirs, key=lambda r: (r["failures"], r["median"]), default=None)
        if best is None:
            continue
        ratios.append(best["median"] / ours["median"])
        rows.append([name, ours["points"], f"{ours['product'] * 1e3:.2g}", f"{ours['median'] * 1e3:.3g}", f"{best['median'] * 1e3:.3g} ({best['solver']})",
                     f"{ratios[-1]:.2f}", f"{ours['failures']}, {best['failures']}"])
    if ratios:
        rows.append(["median", "", "", "", "", f"{statistics.median(ratios):.2f}", ""])
    return table(["50 steps of", "points", "one product W r, ms", "Ricochet, ms per step", "Siconos' fastest, ms per step", "ratio",
                  "failures, ours and theirs"], rows)


def problem_table(results):
    rows = []
    for name in sorted(results.problems):
        entry = results.problems[name]
        rows.append([name, entry["points"], f"{entry['friction']:g}", number(entry["condition"], "{:.3g}"), entry["open"], entry["sticking"],
                     entry["slipping"], milliseconds(results.seconds(name, DEFAULT, 1e-8)), milliseconds(results.best_of_theirs(name, 1e-8))])
    return table(["problem", "points", "F", "cond W", "open", "sticking or closed", "slipping", "ours at 1e-8, ms", "Siconos' best, ms"], rows)


COLOURS = ["#2b6cb0", "#2f855a", "#b7791f", "#6b46c1", "#0f766e", "#9d174d", "#4a5568", "#c05621"]


def profile(results, path):
    figure, axes = plt.subplots(2, len(results.tolerances), figsize=(12, 7), sharey=True, squeeze=False)
    factors = np.geomspace(1, 1000, 400)
    for row, dimension in enumerate((2, 3)):
        names = results.names(dimension)
        keys = [key for key in results.solvers(dimension) if key == DEFAULT or (key[0] == "siconos" and not key[2])]

        def curve(key, tolerance):
            best = {n: min(results.seconds(n, k, tolerance) for k in keys) for n in names}
            ratio = np.array([results.seconds(n, key, tolerance) / best[n] if best[n] < INFINITE else INFINITE for n in names])
            return np.array([(ratio <= factor * (1 + 1e-12)).mean() for factor in factors])

        area = {key: sum(curve(key, t).sum() for t in results.tolerances) for key in keys if key != DEFAULT}
        shown = sorted(area, key=area.get, reverse=True)[:7]
        for column, tolerance in enumerate(results.tolerances):
            axis = axes[row][column]
            for colour, key in zip(COLOURS, shown):
                axis.step(factors, curve(key, tolerance), where="post", color=colour, linewidth=1.1, label=label(key))
            axis.step(factors, curve(DEFAULT, tolerance), where="post", color="#c53030", linewidth=2.6, label="Ricochet, default")
            axis.set_xscale("log")
            axis.set_xlim(1, 1000)
            axis.set_ylim(0, 1.02)
            axis.grid(True, color="#e2e8f0", linewidth=0.7)
            axis.set_title(f"{dimension}D, {len(names)} problems, tolerance {tolerance:.0e}".replace("e-0", "e-"), fontsize=10)
            for side in ("top", "right"):
                axis.spines[side].set_visible(False)
            if row == 1:
                axis.set_xlabel("time relative to the fastest solver")
            if column == 0:
                axis.set_ylabel("share of problems solved")
        handles, labels = axes[row][0].get_legend_handles_labels()
        axes[row][-1].legend(handles[::-1], labels[::-1], fontsize=8, loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def report(directory, results="results.json", sequences="sequences.json", only_print=False):
    results = Results(directory / results)
    parts = {
        "ratios": ratio_table(results),
        "groups": group_table(results),
        "solvers": "\n\n".join(f"**{dimension}D, {tolerance:g}**\n\n{solver_table(results, dimension, tolerance)}"
                               for dimension in (2, 3) if results.names(dimension) for tolerance in results.tolerances),
        "sequences": sequence_table(directory / sequences),
        "claims": claims_table(results),
        "problems": problem_table(results),
        "machine": machine(results.libraries),
    }
    hard = directory / "hard.md"
    if hard.exists():
        parts["hard"] = hard.read_text().strip()
    if only_print:
        print("\n\n".join(parts.values()))
        return
    write_parts("contact-solvers.md", parts)
    profile(results, ROOT / "docs/figures/contact-solvers.png")


def machine(libraries):
    """Describes the last run: programs, machine and date."""
    commit = subprocess.run(["git", "-C", str(ROOT), "log", "-1", "--format=%h"], capture_output=True, text=True).stdout.strip()
    text = (f"Measured {datetime.date.today()} with Ricochet at commit {commit or 'unknown'} on one core of a shared machine ({processor()}), "
            f"with {libraries or 'unknown libraries'}.")
    return text + (f"\nSiconos' OpenBLAS uses the kernels for {blas_kernels(libraries)}, too." if libraries else "")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="tables and plots of the contact benchmark, from the results of run.py")
    parser.add_argument("--directory", type=pathlib.Path, default=BUILD / "bench-contact")
    parser.add_argument("--print", action="store_true", help="only print the tables")
    options = parser.parse_args()
    report(options.directory, only_print=options.print)
