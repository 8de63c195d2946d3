"""Properties of every run under the default scheme, row by row: account, signs of works, no interpenetration, momentum.

Tolerances are relative to the largest energy of the run. With the linear law a step is solved up to rounding, some
1e-12 after a few hundred operations per step; at finite strain Newton's method may leave 1e-8 of a step's energy
(docs/finite-strain.md).
"""

import math

ACCOUNT = {False: 1e-10, True: 1e-8}  # by whether strains are finite: residual of the account, and energy created
STICKING = 1e-9  # work of friction while all points stick, in a run
DEPTH = 1e-9  # of the body, at contact points
PROPERTIES = ("account", "created by the method", "contact work", "friction work", "damping work", "relaxation", "sticking", "penetration",
              "momentum", "numbers", "status")


def rises(column):
    """Returns the largest rise above any earlier value."""
    lowest, most = math.inf, 0.0
    for value in column:
        lowest = min(lowest, value)
        most = max(most, value - lowest)
    return most


def largest_step(column):
    return max((b - a for a, b in zip(column, column[1:])), default=0.0)


def all_stick(run, k):
    """Returns whether no point slips in the step that leads to a row. A mean of the reactions also acts during the
    step, in which a point may slip before it sticks, and may move without friction before it touches: it then counts
    only if both ends are alike (docs/energy.md)."""
    slipping, pressed = run.columns["slipping"], run.columns["active_contacts"]
    if (run.summary.get("reactions") or {}).get("acting") == "end":
        return slipping[k] == 0
    return slipping[k] == slipping[k - 1] == 0 and pressed[k] == pressed[k - 1]


def findings(scene, run):
    """Returns [(property, size, text)] of the violations."""
    found, c, finite = [], run.columns, scene.facts["finite"]
    scale = run.energy_scale()
    if not run.finite():
        return [("numbers", math.inf, "a number of the history is not finite")]
    if scale == 0:
        return found
    tolerance = ACCOUNT[finite]
    zero = [0.0] * len(c["time"])
    relaxed, error = c.get("viscous_dissipation", zero), c.get("integration_error", zero)

    def check(name, size, allowed, text):
        if not size / scale <= allowed:
            found.append((name, size / scale, text))

    works = [sum(c[w][k] for w in ("load_work", "contact_work", "friction_work", "support_work", "obstacle_work", "damping_work"))
             for k in range(len(zero))]
    start = c["total_energy"][0]
    missing = [abs(e - start - w + d + v - i) for e, w, d, v, i in
               zip(c["total_energy"], works, c["numerical_dissipation"], relaxed, error)]
    check("account", max(missing), tolerance, "change of the energy less all works and dissipations")
    parts = [abs(e - k - s - p) for e, k, s, p in
             zip(c["total_energy"], c["kinetic_energy"], c["elastic_energy"], c["load_potential"])]
    check("account", max(parts), 1e-12 * len(zero), "total energy less its parts")
    by_method = [w - d + i for w, d, i in zip(c["contact_work"], c["numerical_dissipation"], error)]
    check("created by the method", largest_step(by_method), tolerance, "contact work less numerical dissipation in a step")
    check("contact work", rises(c["contact_work"]), tolerance, "normal forces have added energy")
    check("friction work", rises(c["friction_work"]), tolerance, "friction has added energy")
    check("damping work", rises(c["damping_work"]), tolerance, "damping has added energy")
    check("relaxation", rises([-v for v in relaxed]), tolerance, "viscoelastic branches have added energy")
    # In a step that is divided, points may slip in one part and stick in the last.
    rows = min(len(zero), run.first_makeshift)
    stuck = [abs(c["friction_work"][k] - c["friction_work"][k - 1]) for k in range(1, rows) if all_stick(run, k)]
    check("sticking", sum(stuck), max(STICKING, tolerance), "friction has done work while all points stuck")
    if scene.facts.get("pointwise"):
        depth = max(c["max_penetration"]) / scene.size()
        if depth > DEPTH:
            found.append(("penetration", depth, "a contact node is inside an obstacle"))
    return found + momentum_findings(scene, run)


def momentum_findings(scene, run):
    """Impulses of gravity and obstacles equal the change of momentum if the reactions of the end act during the whole
    step."""
    facts, c, d = scene.facts, run.columns, scene.dimension
    acting = (run.summary.get("reactions") or {}).get("acting")
    # The forces of a divided step are those of its last part.
    if acting != "end" or math.isfinite(run.first_makeshift) or scene.family == "free" or any(facts.get(k) for k in ("supported", "loads", "mass damping")):
        return []
    load, mass = scene.section("load"), sum(body["mass"] for body in run.summary["bodies"])
    gravity = load.keys["gravity"].values if load else (0.0,) * d
    scale, worst = math.sqrt(2 * scene.mass() * run.energy_scale()), 0.0
    for k, axis in enumerate("xyz"[:d]):
        if scene.plane == "axisymmetric" and axis == "x":
            continue
        p, f, t, drift = c[f"momentum_{axis}"], c[f"contact_force_{axis}"], c["time"], 0.0
        for row in range(1, len(t)):
            drift += p[row] - p[row - 1] - (t[row] - t[row - 1]) * (f[row] + mass * gravity[k])
            worst = max(worst, abs(drift))
    return [("momentum", worst / scale, "change of the momentum less impulses")] if worst > 1e-8 * scale else []
