"""A case of cases/ holds: it is valid, its run succeeds with all its [[expect]] entries, its energy account closes, and
its history has exactly the documented columns. The case file is the first argument."""

import itertools
import pathlib
import sys
import tomllib
import unittest

from harness import OTHER_ROW, SOURCE, History, TestCase, run, summary_of

sys.path.insert(0, str(SOURCE / "docs"))

from history_columns import documented_columns as table_of_columns  # noqa: E402

CASE = pathlib.Path(sys.argv.pop(1))

def columns_of(quantities, dimension, old="", new=""):
    axes = {"one": [""], "vector": ["_x", "_y", "_z"][:dimension], "axial": ["_z"] if dimension == 2 else ["_x", "_y", "_z"]}
    return [name.replace(old, new) + axis for name, components, *_ in quantities for axis in axes[components]]


def boundary_groups(case):
    """Returns the groups of facets to which a case refers."""
    entries = [entry[key] for section in ("contact", "support", "traction") for entry in case.get(section, [])
               for key in ("group", "against") if key in entry]
    return {name for entry in entries for name in ([entry] if isinstance(entry, str) else entry)}


def documented_columns(dimension, case, points):
    """Returns the columns of a case, in the order of the table: those whose conditions hold, for all bodies and probes."""
    contacts = case.get("contact", [])
    finite = any(material.get("law", "linear") != "linear" for material in case["material"])
    tied = any(contact.get("tied", False) for contact in contacts)  # the cases with ties are one body
    bodies = [] if tied or len(case.get("part", {})) < 2 else list(case["part"])
    holds = {"": True, "laws of finite strain": finite,
             "`relaxation` of a material": any("relaxation" in material for material in case["material"]),
             "large sliding between bodies": any(contact.get("sliding") == "large" for contact in contacts),
             "surfaces that touch themselves": any(contact.get("against") == contact["group"] for contact in contacts)}
    names = {"meshes of 2 to 20 bodies": ("BODY", bodies),
             "contacts between bodies": ("N", [str(number) for number, contact in enumerate(contacts)
                                               if "against" in contact and not contact.get("tied", False)]),
             "rigid bodies that move freely": ("NAME", [name for name, obstacle in case.get("obstacle", {}).items()
                                                        if {"mass", "density"} & obstacle.keys()])}
    columns = []
    for condition, rows in itertools.groupby(table_of_columns(), key=lambda row: row[3]):
        rows = list(rows)
        if condition in names:
            placeholder, own = names[condition]
            columns += [column for name in own for column in columns_of(rows, dimension, placeholder, name)]
        elif not condition.startswith("probes with"):
            columns += columns_of(rows, dimension) if holds[condition] else []
    facets, on_contact = boundary_groups(case), {point["name"] for point in points if point["in_contact_boundary"]}
    for probe in case.get("probe", []):
        holds |= {"on a contact boundary": probe["name"] in on_contact, "with laws of finite strain": finite,
                  "groups of cells": probe.get("group") not in facets}
        for row in table_of_columns():
            kind, *conditions = row[3].split(", ")
            if kind in {f"probes with `{key}`" for key in probe} and all(holds[each] for each in conditions):
                columns += columns_of([row], dimension, "NAME", probe["name"])
    return columns


class CaseTest(TestCase):
    def test_is_valid_and_keeps_its_promises(self):
        validated = self.expect_status(0, run("validate", CASE))
        self.assertRegex(validated.stdout, r"estimate, stage 1 of a step, \d+ unknowns: method direct; a factor of \S+ entries")
        results = self.simulate(CASE)
        history = History(results / "history.csv")
        summary = summary_of(results)
        self.assertEqual(summary["status"], "done")
        self.check_columns(history, summary)
        self.check_rows(history, summary)
        scale = history.largest_energy()
        self.assertGreater(scale, 0.0, "a case in which nothing moves shows nothing")
        for step, residual in zip(history["step"], history["energy_residual"]):
            self.assertLessEqual(abs(residual), 1e-10 * scale, f"energy_residual in step {step:g}")
        watched = summary["unwatched_penetration"]
        self.assertTrue(watched["checked"])
        self.assertEqual((watched["found"], watched["contact_beyond_rim"]), ([], []), "all that touches is in contact")
        self.check_warnings(summary)
        for expectation in summary["expectations"]:
            self.assertTrue(expectation["holds"], expectation)
            self.assertNotRegex(expectation["quantity"], OTHER_ROW)

    def check_warnings(self, summary):
        """Cases show the recommended settings: there must be no warnings about scheme and step, losses or gains of
        energy. Some exceed small strain on purpose; their runs must warn of that, and of nothing else."""
        for warning in summary["warnings"]:
            self.assertIn("small strain", warning)

    def check_columns(self, history, summary):
        with open(CASE, "rb") as file:
            case = tomllib.load(file)
        points = [probe["name"] for probe in case.get("probe", []) if "at" in probe]
        self.assertEqual([probe["name"] for probe in summary["probes"]], points)
        self.assertEqual(history.names, documented_columns(summary["dimension"], case, summary["probes"]))

    def check_rows(self, history, summary):
        with open(CASE, "rb") as file:
            case = tomllib.load(file)
        every = case.get("output", {}).get("history_every", 2 if summary["scheme"] == "semi-explicit" else 1)
        steps = summary["steps"]
        wanted = list(range(0, steps + 1, every)) + ([steps] if steps % every else [])
        self.assertEqual(history["step"], wanted)
        for step, time in zip(history["step"], history["time"]):
            self.assertAlmostEqual(time, step * summary["time_step"], delta=1e-12 * summary["end_time"])
        for total, *parts in zip(history["total_energy"], history["kinetic_energy"], history["elastic_energy"],
                                 history["load_potential"]):
            self.assertAlmostEqual(total, sum(parts), delta=1e-14 * sum(map(abs, parts)))


if __name__ == "__main__":
    unittest.main()
