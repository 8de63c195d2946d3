"""The tables of docs/peers.md and docs/performance.md from what run.py measured."""

import statistics

from measurement import PHASES, processor, table, write_parts

AGREE = 1e-6  # of forces, relative to the largest one


def percent(value):
    return f"{100.0 * value:.2g} %"


def small(record, name):
    return f"{record[name]:.1e}" if name in record else ""


def static_table(records):
    rows = []
    for record in records:
        name, dimension, _ = record["body"]
        body = f"{name}{' of a disc' if (name, dimension) == ('half', 2) else ' of a ball' if name == 'half' else f', {dimension}D'}"
        row = [body, percent(record["press"]), f"{record['friction_coefficient']:g}"]
        if "failed" in record:
            rows.append(row + [record["failed"]] + [""] * 7)
            continue
        rows.append(row + [record["dofs"], percent(record["strain"]), f"{record['pressed']:.0f}", f"{record['at_bound']:.0f}" if "at_bound" in record else "",
                           f"{record['largest_force']:.8g}", small(record, "displacement"), small(record, "force"), small(record, "friction_force")])
    return table(["body", "pressed by", "F", "dofs", "largest strain", "nodes pressed", "of these at the friction bound", "force", "displacement", "nodal force",
                  "nodal friction"], rows)


def dynamic_table(records):
    rows = []
    for record in records:
        name, dimension, _ = record["body"]
        row = [name, f"{record['speed']:g}", f"{record['friction_coefficient']:g}", record["scheme"], record["steps"], percent(record["strain"])]
        if "failed" in record:
            rows.append(row + [record["failed"]] + [""] * 5)
            continue
        since = int(record["beyond"])
        rows.append(row + [record["dofs"], f"{record['pressed']:.0f}", small(record, "displacement"), small(record, "force"),
                           small(record, "friction_force"), str(since) if since else "never"])
    return table(["body", "speed", "F", "scheme", "steps", "largest strain", "dofs", "nodes pressed", "displacement", "nodal force", "nodal friction",
                  "beyond 10⁻⁸ from step"], rows)


def time_table(records):
    rows = []
    for record in records:
        name = f"{record['body'][0]}, {record.get('dofs', '?')} dofs"
        row = [name, f"{record['friction']:g}", f"{record['speed']:g}", percent(record["strain"])]
        if "failed" in record:
            rows.append(row + [record["failed"]] + [""] * 8)
            continue
        theirs = statistics.median(record["theirs"])
        row += [record["steps"], f"{statistics.mean(record['iterations']):.1f}", f"{1e3 * theirs:.4g}"]
        for scheme in ("newmark", "reduced-kane"):
            if scheme in record["stopped"]:
                row += ["not finished", "–", "–"]
                continue
            mine = statistics.median(record["ours"][scheme])
            row += [f"{statistics.mean(record['rounds'][scheme]):.1f}", f"{1e3 * mine:.3g}", f"**{theirs / mine:.1f}**"]
        rows.append(row + [f"{record['differences']['force']:.0e}"])
    return table(["", "F", "speed", "largest strain", "steps", "GetFEM: iterations per step", "a step, ms", "`newmark`: iterations", "a step, ms", "ratio",
                  "`reduced-kane`: iterations", "a step, ms", "ratio", "forces differ by"], rows)


def middle(runs, phase, name):
    values = [run[phase][name] for run in runs if phase in run and name in run[phase]]
    return statistics.median(values) if values else None


def phase_rounds(record, phase):
    """Returns the Newton iterations per step in the steps of a phase of ricochet_step_bench, from the history of the
    same run."""
    rounds = record.get("rounds_by_phase", {}).get(phase)
    return f"{statistics.median(rounds):.0f}" if rounds else "1"


def cost_table(records):
    rows = []
    for record in records:
        runs = [run for run in record["runs"] if "failed" not in run]
        strain = percent(record["strain"]) if "strain" in record else "law `linear`" if record["law"] == "linear" else ""
        scheme = f"`{record['scheme']}`"
        if not runs:
            rows.append([record["body"][0], scheme, f"{record['speed']:g}", strain, "not finished"] + ["–"] * 6)
            continue
        for key, name in PHASES:
            step, library, own = (middle(runs, key, value) for value in ("step_ms", "library_solve_ms", "own_solve_ms"))
            if step is None or library is None or runs[0][key]["steps"] < 3:
                continue
            rounds = phase_rounds(record, key)
            rows.append([f"{record['body'][0]}, {runs[0]['dofs']} dofs", scheme, f"{record['speed']:g}", strain, name, str(runs[0][key]["active"]), rounds, f"{step:.3g}", f"{library:.3g}",
                         f"**{step / library:.1f}**", f"{step / library / float(rounds):.2f}", f"{float(rounds) * own / step:.0%}".replace("%", " %")])
    return table(["", "scheme", "speed", "largest strain", "contact", "pressed", "iterations", "step, ms", "CHOLMOD's solve, ms", "step / solve", "step / solve per iteration",
                  "our solves in the step"], rows)


def where_table(records):
    rows = []
    for record in records:
        samples = record["samples"]
        whole = sum(samples.values())
        rows.append([record["body"][0], record["scheme"]] + [f"{100.0 * count / whole:.0f} %" for count in samples.values()])
    return table(["", "scheme"] + list(records[0]["samples"]), rows)


def forces_agree(everything):
    """Returns whether forces agree where steps coincide. The trapezoidal rule and the midpoint scheme amplify rounding
    with this mass: they count up to that step."""
    agree = True
    for part in ("statics", "dynamics"):
        for record in everything.get(part, {}).get("records", []):
            good = "failed" not in record and max(record["force"], record.get("friction_force", 0.0)) < AGREE
            if not good:
                print(f"forces do not agree: {record}")
            agree = agree and good
    return agree


def report(everything):
    note = {part: f"Measured {entry['date']} on a busy machine of two cores ({processor()}), one thread, with {entry['libraries']}." for part, entry in everything.items()}
    peers, performance = {}, {}
    if "statics" in everything:
        peers["finite statics"] = static_table(everything["statics"]["records"])
    if "dynamics" in everything:
        peers["finite dynamics"] = dynamic_table(everything["dynamics"]["records"])
    if "times" in everything:
        performance["finite times"] = f"{note['times']}\n\n{time_table(everything['times']['records'])}"
    if "costs" in everything:
        performance["finite costs"] = f"{note['costs']}\n\n{cost_table(everything['costs']['records'])}"
    if everything.get("where", {}).get("records"):
        performance["finite where"] = where_table(everything["where"]["records"])
    write_parts("peers.md", peers)
    write_parts("performance.md", performance)
    return forces_agree(everything)
