"""The tables and plots of docs/performance.md from the measurements of run.py."""

import datetime
import math
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from measurement import PHASES, ROOT, blas_kernels, processor, table, write_parts

COLOURS = {"2D": "#2b6cb0", "3D": "#c53030", "3D iterative": "#b7791f"}


def body_text(record):
    return f"{record['body'][0]}, {record['dofs']} dofs, {record['contact_points']} contact points"


def ratio_table(records):
    head = ["", "F", "contact", "pressed", "step, ms", "CHOLMOD's solve, ms", "step / solve", "our solve / CHOLMOD's", "step with CHOLMOD's solves / solve",
            "reading the factor twice, ms", "row of history, ms"]
    rows = []
    for record in records:
        for key, name in PHASES:
            phase = record.get(key)
            if not phase or "ratio" not in phase:
                continue
            rows.append([body_text(record), f"{record['friction']:g}", name, phase["active"], f"{phase['step_ms']:.3g}",
                         f"{phase['library_solve_ms']:.3g}", f"**{phase['ratio']:.2f}**",
                         f"{phase['own_solve_ms'] / phase['library_solve_ms']:.2f}",
                         f"{1.0 + (phase['step_ms'] - phase['own_solve_ms']) / phase['library_solve_ms']:.2f}",
                         f"{phase['memory_limit_ms']:.3g}", f"{phase['row_ms']:.3g}"])
    return table(head, rows)


def pairing_table(records):
    rows = [[record["case"], record["dofs"], record["contact_points"], record["steps"], f"{record['run_s']:.3g}", f"{record['pairing_s']:.2g}",
             f"**{100.0 * record['pairing_s'] / record['run_s']:.1f} %**"] for record in records]
    return table(["", "dofs", "contact points", "steps", "run, s", "pairing, s", "pairing / run"], rows)


def memory_table(records):
    rows = []
    for record in records:
        if record["friction"] > 0.0:
            continue
        needed = record["limit_mb"] + record["matrices_mb"]
        rows.append([body_text(record), f"{record['limit_mb']:.0f}", f"{record['matrices_mb']:.0f}", f"{record['memory']:.0f}",
                     f"**{record['memory'] / needed:.2f}**", f"{record['read_s']:.2f}", f"{record['assembly_s']:.2f}", f"{record['start_s']:.2f}"])
    return table(["", "factor, MB", "K and M, MB", "peak of the process, MB", "peak / (factor + matrices)", "reading, s", "assembly, s",
                  "ordering, factorization and start, s"], rows)


def explicit_table(records):
    rows = []
    for record in records:
        for key, name in PHASES:
            phase = record.get(key)
            if not phase or phase["steps"] < 10 or "memory_limit_ms" not in phase:
                continue
            rows.append([body_text(record), name, f"{phase['step_ms']:.3g}", f"{record['limit_mb']:.1f}", f"{phase['memory_limit_ms']:.3g}",
                         f"**{phase['memory_limit_ms'] / phase['step_ms']:.2f}**", f"{phase['row_ms']:.3g}"])
    return table(["", "contact", "step, ms", "memory traffic, MB", "reading as many bytes, ms", "limit / step",
                  "row of history, ms"], rows)


def in_contact(force):
    return [k for k, value in enumerate(force) if value > 0.0]


def peer_times(entry):
    """Returns milliseconds per step in contact, and the differences of the forces."""
    ours, result = entry["ours"], {}
    steps = in_contact(ours["force"])
    result["ours"] = statistics.median(ours["steps_ms"][k] for k in steps)
    for name in ("users", "expert"):
        theirs = entry.get(name)
        if not theirs or "step_ms" not in theirs:
            continue
        # Our list begins with the second step.
        result[name] = statistics.median(theirs["step_ms"][k + 1] for k in steps)
        largest = max(ours["force"])
        result[name + " difference"] = max(abs(theirs["force"][k + 1] - force) for k, force in enumerate(ours["force"])) / largest
    return result


def peer_table(entries):
    rows = []
    for entry in entries:
        times = peer_times(entry)
        cells = [body_text(dict(entry["ours"], body=entry["body"])), f"{entry['friction']:g}", f"{times['ours']:.3g}"]
        for name in ("users", "expert"):
            if name in times:
                cells += [f"{times[name]:.4g}", f"**{times[name] / times['ours']:.0f}**", f"{times[name + ' difference']:.1e}"]
            else:
                cells += [entry.get(name, {}).get("failed", "–"), "–", "–"]
        rows.append(cells)
    return table(["", "F", "ours, ms", "GetFEM as its users run it, ms", "ratio", "forces differ by", "scripted by an expert, ms", "ratio", "forces differ by"], rows)


def last_phase(record):
    return record.get("closed") or record.get("changing") or record["open"]


def scaling_groups(records):
    groups = {}
    for record in records:
        name = f"{record['dimension']}D" + (" iterative" if record["method"] == "iterative" else "")
        groups.setdefault(name, []).append(record)
    return groups


def exponent(records, value):
    """Returns the exponent of the power law between the two halves of the relevant sizes: above 5,000 dofs."""
    large = [r for r in records if r["dofs"] > 5000]
    if len(large) < 2:
        return None
    x, y = [math.log(r["dofs"]) for r in large], [math.log(value(r)) for r in large]
    mean_x, mean_y = statistics.mean(x), statistics.mean(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def scaling_table(records):
    rows = []
    for name, group in scaling_groups(records).items():
        for record in group:
            set_up = record["read_s"] + record["assembly_s"] + record["start_s"]
            rows.append([name, record["dofs"], f"{last_phase(record)['step_ms']:.3g}", f"{record['peak_mb']:.0f}", f"{set_up:.3g}"])
        powers = [exponent(group, value) for value in (lambda r: last_phase(r)["step_ms"], lambda r: r["peak_mb"],
                                                       lambda r: r["read_s"] + r["assembly_s"] + r["start_s"])]
        if None not in powers:
            rows.append([f"{name}: exponent", ""] + [f"**{power:.2f}**" for power in powers])
    return table(["", "dofs", "step in contact, ms", "peak of the process, MB", "set-up, s"], rows)


def thread_table(records):
    rows = []
    one = {(tuple(r["body"]), r["method"]): r for r in records if r["threads"] == 1}
    for record in records:
        if record["threads"] == 1:
            continue
        before, now = last_phase(one[tuple(record["body"]), record["method"]])["step_ms"], last_phase(record)["step_ms"]
        rows.append([body_text(record), record["method"], f"{before:.3g}", f"{now:.3g}", f"{before / now:.2f}"])
    return table(["", "method", "1 thread, ms per step", "2 threads, ms per step", "gain"], rows)


def iterative_table(records):
    rows = []
    one = {tuple(r["body"]): r for r in records if r["threads"] == 1}
    for record in records:
        contact = [(force, step) for force, step in zip(record["force"], record["steps_ms"]) if force > 0.0]
        deep = sorted(contact, reverse=True)[:10]
        step = statistics.median(step for _, step in contact)
        set_up = record["read_s"] + record["assembly_s"] + record["start_s"]
        before = statistics.median(step for force, step in zip(one[tuple(record["body"])]["force"], one[tuple(record["body"])]["steps_ms"])
                                   if force > 0.0)
        rows.append([record["dofs"], f"{141 * 1e-3 / record['body'][2]:.1f}", record["threads"], f"{step:.0f}",
                     f"{statistics.median(step for _, step in deep):.0f}", f"{max(step for _, step in contact):.0f}",
                     last_phase(record)["active"], f"{record['peak_mb']:.0f}", f"{set_up:.0f}", f"{before / step:.2f}"])
    return table(["dofs", "cells crossed", "threads", "step in contact, ms (median)", "deep", "slowest (subdomains are built)",
                  "closed points", "peak, MB", "set-up, s", "gain"], rows)


def factorization_table(records):
    rows = []
    for record in records:
        one, several, library = (record[name]["factorization_s"] for name in ("one", "several", "library"))
        rows.append([body_text(record), f"{record['factor_mb']:.0f}", f"{1e-9 * record['operations']:.3g}", f"{record['ordering_s']:.2g}",
                     f"{library:.3g}", f"{one:.3g}", f"{several:.3g}", f"**{library / one:.1f}**", f"**{one / several:.2f}**",
                     f"{1e-9 * record['operations'] / one:.0f}"])
    return table(["", "factor, MB", "10⁹ operations", "ordering, s", "CHOLMOD, s", "ours, s", "on 2 threads, s", "CHOLMOD / ours", "gain by threads",
                  "Gflop/s, 1 thread"], rows)


def solve_table(records):
    rows = []
    for record in records:
        cells = [body_text(record)]
        solve = {name: record[name]["forward_ms"] + record[name]["backward_ms"] for name in ("one", "several", "library")}
        reading = {name: 2.0 * record[name]["reading_ms"] for name in ("one", "several")}
        cells += [f"{value:.3g}" for value in (solve["library"], solve["one"], reading["one"], solve["several"], reading["several"])]
        rows.append(cells + [f"**{solve['one'] / solve['several']:.2f}**", f"{reading['one'] / reading['several']:.2f}"])
    return table(["", "CHOLMOD, ms", "ours, ms", "reading twice, ms", "ours on 2 threads, ms", "reading twice on 2 threads, ms", "gain of the solves",
                  "gain of reading"], rows)


def plot_scaling(records, path):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2))
    for name, group in scaling_groups(records).items():
        dofs = [r["dofs"] for r in group]
        axes[0].loglog(dofs, [last_phase(r)["step_ms"] for r in group], "o-", color=COLOURS[name], label=name, markersize=4)
        axes[1].loglog(dofs, [r["peak_mb"] for r in group], "o-", color=COLOURS[name], label=name, markersize=4)
    for axis, label in zip(axes, ("ms per step in contact, one core", "peak memory of the process, MB")):
        axis.set_xlabel("dofs")
        axis.set_title(label, fontsize=10, loc="left")
        axis.grid(True, which="major", color="#e2e8f0", linewidth=0.7)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
        axis.legend(frameon=False, fontsize=9)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def libraries(everything):
    """Returns all libraries with which parts were measured."""
    records = [entry.get("ours", entry) for part in everything.values() for entry in part]
    return sorted({record["libraries"] for record in records if "libraries" in record})


def machine(everything):
    texts = [f"Measured {datetime.date.today()} on a shared machine ({processor()}), on one core unless stated otherwise, "
             f"with {text}."
             for text in libraries(everything) or ["unknown libraries"]]
    kernels = {blas_kernels(text) for text in libraries(everything)}
    if "peer" in everything and len(kernels) == 1:
        texts.append(f"GetFEM's OpenBLAS uses the kernels for {kernels.pop()}, too.")
    return "\n".join(texts)


def report(everything):
    parts = {"machine": machine(everything)}
    if "ratios" in everything:
        parts["ratios"], parts["memory"] = ratio_table(everything["ratios"]), memory_table(everything["ratios"])
    if "pairs" in everything:
        parts["pairs"] = ratio_table(everything["pairs"])
    if "pairing" in everything:
        parts["pairing"] = pairing_table(everything["pairing"])
    if "explicit" in everything:
        parts["explicit"] = explicit_table(everything["explicit"])
    if "peer" in everything:
        parts["peer"] = peer_table(everything["peer"])
    if "scaling" in everything:
        parts["scaling"] = scaling_table(everything["scaling"])
        plot_scaling(everything["scaling"], ROOT / "docs" / "figures" / "step-scaling.png")
    if "threads" in everything:
        parts["threads"] = thread_table(everything["threads"])
    if "iterative" in everything:
        parts["iterative"] = iterative_table(everything["iterative"])
    if "factor" in everything:
        parts["factorization"], parts["solves"] = factorization_table(everything["factor"]), solve_table(everything["factor"])
    write_parts("performance.md", parts)
