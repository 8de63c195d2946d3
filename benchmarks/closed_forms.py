"""Recomputes the reference values of the benchmarks from the data in their case files, by closed forms.

    python3 benchmarks/closed_forms.py [--table]

reads every [[expect]] with a `value` in benchmarks/*/*.toml and in the cases of cases/ that have a closed form, computes the
value anew and prints both. The status is 0 when all agree to the digits written, and every value in benchmarks/ has a closed form
or is listed in NOT_CLOSED with its origin. With --table it writes tests/data/closed_forms.csv, with which tests in C++ compare the
closed forms that they need everywhere in a body and at all times. Nothing but Python's own library is needed; the derivations are in the README.md of each folder.
"""

import math
import pathlib
import sys
import tomllib

import closed_forms_of_contacts as contacts
import closed_forms_of_waves as waves

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEVEN_DIGITS, FEW_DIGITS = 1e-6, 1e-3  # relative: as reference values are written in benchmarks/ and in cases/
COPPER_QUARTER = math.pi * 3.2e-3**2 / 4.0

BENCHMARKS = {
    "sdnv100/sdnv100.toml": lambda case, q: waves.bar(case, q, 0.02**2, 2),
    "vm265/vm265.toml": lambda case, q: waves.bar(case, q, 1.0, 0),
    "abaqus-1-3-15/five.toml": lambda case, q: waves.bar(case, q, 0.2, 0),
    "abaqus-1-3-15/ten.toml": lambda case, q: waves.bar(case, q, 0.2, 0),
    "abaqus-1-3-15/eighty.toml": lambda case, q: waves.bar(case, q, 0.2, 0),
    "metal-bar/metal-bar.toml": lambda case, q: waves.bar(case, q, COPPER_QUARTER, 2),
    "metal-bar/poisson.toml": lambda case, q: waves.bar(case, q, COPPER_QUARTER, 2),
    "sdnl111/sdnl111.toml": waves.sdnl111,
    "cgs-4/cgs-4.toml": contacts.cgs_4,
    "cgs-4/threshold.toml": contacts.cgs_4,
    "cattaneo-mindlin/cattaneo-mindlin.toml": contacts.cattaneo_mindlin,
    "greco-plate/greco-plate.toml": contacts.greco,
    "cattaneo-mindlin-pair/cattaneo-mindlin-pair.toml": contacts.cattaneo_mindlin_pair,
    "hertz-cylinders/hertz-cylinders.toml": contacts.hertz_cylinders,
    "nafems-roller/roller.toml": contacts.roller,
    "patch-test/patch-test.toml": contacts.patch_test,
    "patch-test/space.toml": contacts.patch_test,
}

CASES = {
    "rod/rod.toml": waves.rod,
    "rod/quadrilaterals.toml": waves.rod,
    "bar/impact.toml": waves.bar_impact,
    "bar/bounce.toml": waves.bar_bounce,
    "stack/stack.toml": waves.stack,
    "layer/layer.toml": waves.layer,
    "incline/incline.toml": contacts.incline,
    "incline/held.toml": contacts.held,
    "bars-pair/pair.toml": lambda case, q: waves.two_bars(case, q, ("one", "two"), (2.0, 2.0)),
    "bars-pair/hammer.toml": lambda case, q: waves.two_bars(case, q, ("hammer", "pile"), (2.0, 8.0)),
    "cradle/cradle.toml": waves.cradle,
    "balls/balls.toml": contacts.two_balls,
    "balls/unequal.toml": contacts.two_balls,
    "ball-block/ball-block.toml": contacts.ball_block,
    "hertz/cylinder.toml": contacts.cylinder,
    "hertz/sphere.toml": contacts.sphere,
    "hertz/cylinder-impact.toml": contacts.cylinder_impact,
    "hertz/sphere-impact.toml": contacts.sphere_impact,
}

NOT_CLOSED = {
    "greco-plate/greco-plate.toml": {
        f"history.{point}.displacement_x[-1]": "published: mean of several codes, or code_aster" for point in "abcde"
    } | {"history.next.reaction_normal[-1]": "published: code_aster"},
    "cattaneo-mindlin/cattaneo-mindlin.toml": {
        "history.contact_force_y[-1]": "measured: the load that the closed form takes"
    },
    "cattaneo-mindlin-pair/cattaneo-mindlin-pair.toml": {
        "history.contact.force_y[-1]": "measured: the load that the closed form takes"
    },
}


def references(name, case, expect):
    """The closed form of an [[expect]] of cases/, or None."""
    form = CASES[name]
    if form in (waves.layer, contacts.incline):
        friction = expect.get("when", {}).get("contact.0.friction", case["contact"][0]["friction"])
        return form(case, expect["quantity"], friction) if friction > 0.0 or form is contacts.incline else None
    return form(case, expect["quantity"])


TABLE = ROOT / "tests" / "data" / "closed_forms.csv"


def table():
    """Returns values of closed forms that verification tests have in C++, too: problem, quantity, position, time, value."""
    rows = []
    for k in range(8):
        time = 0.2 * k + 0.101  # not at a jump
        for x in (0.0, 3.0, 10.0):
            rows.append(("impact", "displacement", x, time, waves.STRIKING_BAR.displacement(x, time)))
            rows.append(("impact", "velocity", x, time, waves.STRIKING_BAR.velocity(x, time)))
        rows.append(("impact", "pressure", 0.0, time, waves.STRIKING_BAR.force_at(time) / 0.5))
        for problem, form in (("bounce", waves.bouncing_bar), ("rod", waves.released_rod)):
            displacement, pressure = form(time)
            rows += [(problem, "displacement", 0.0, time, displacement), (problem, "pressure", 0.0, time, pressure)]
        for a in (0.15, 0.2, 0.3, 0.45, 1.5):
            layer = waves.SlidingLayer(a)
            rows += [(f"layer {a}", "velocity", 0.0, 5.0 * time, layer.velocity(5.0 * time)), (f"layer {a}", "traction", 0.0, 5.0 * time, layer.traction(5.0 * time))]
    rows += [(f"layer {a}", "slip", 0.0, 100.0, waves.SlidingLayer(a).slip(100.0)) for a in (0.15, 0.2, 0.3, 0.45, 1.5)]
    return "".join(f"{problem},{quantity},{x:g},{time:.12g},{value:.12g}\n" for problem, quantity, x, time, value in rows)


class Comparison:
    """A reference value of a case file beside its closed form (None if there is none) or its origin."""

    def __init__(self, case, quantity, value, computed, origin, agreement):
        self.case, self.quantity, self.value, self.computed, self.origin = case, quantity, value, computed, origin
        self.holds = origin is not None or (
            computed is not None and abs(value - computed) <= agreement * abs(computed) + 1e-15)

    def __str__(self):
        computed = "" if self.computed is None else f"{self.computed:.10g}"
        verdict = self.origin or ("agrees" if self.holds else "DISAGREES" if computed else "HAS NO CLOSED FORM")
        return f"{self.case:38} {self.quantity:43} {self.value:<14.9g} {computed:17} {verdict}"


def comparisons():
    for path in sorted((ROOT / "benchmarks").glob("*/*.toml")):
        name, case = path.relative_to(ROOT / "benchmarks").as_posix(), tomllib.loads(path.read_text(encoding="utf-8"))
        for expect in case["expect"]:
            if "value" in expect:
                quantity = expect["quantity"]
                origin = NOT_CLOSED.get(name, {}).get(quantity)
                computed = None
                if origin is None and name in BENCHMARKS:
                    computed = BENCHMARKS[name](case, quantity)
                    if computed is not None and "over" in expect:
                        computed /= BENCHMARKS[name](case, expect["over"])
                        quantity += " over " + expect["over"].rsplit(".", 1)[-1]
                yield Comparison(name, quantity, expect["value"], computed, origin, SEVEN_DIGITS)
    for name in CASES:
        case = tomllib.loads((ROOT / "cases" / name).read_text(encoding="utf-8"))
        for expect in case["expect"]:
            computed = references(name, case, expect) if "value" in expect else None
            if computed is not None:
                yield Comparison("cases/" + name, expect["quantity"], expect["value"], computed, None, FEW_DIGITS)


def main():
    if sys.argv[1:] == ["--table"]:
        TABLE.write_text(table(), encoding="ascii")
    wrong = 0
    for comparison in comparisons():
        wrong += not comparison.holds
        print(comparison)
    print(f"{wrong} do not agree" if wrong else "all agree")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
