"""A case of cases/ holds: it is valid, its run succeeds with all its [[expect]] entries, its energy account closes, and
its history has exactly the documented columns. The case file is the first argument."""

import pathlib
import sys
import tomllib
import unittest

from harness import OTHER_ROW, History, TestCase, run, summary_of

CASE = pathlib.Path(sys.argv.pop(1))

AXES = "xyz"


def vector_columns(name, dimension):
    return [f"{name}_{axis}" for axis in AXES[:dimension]]


def boundary_groups(case):
    """Returns the groups of facets to which a case refers."""
    entries = [entry[key] for section in ("contact", "support", "traction") for entry in case.get(section, [])
               for key in ("group", "against") if key in entry]
    return {name for entry in entries for name in ([entry] if isinstance(entry, str) else entry)}


def boundary_columns(name, dimension):
    columns = []
    for force, moment in (("force", "moment"), ("support", "support_moment")):
        columns += vector_columns(f"{name}.{force}", dimension)
        columns += [f"{name}.{moment}_z"] if dimension == 2 else vector_columns(f"{name}.{moment}", dimension)
    return columns


def probe_columns(probe, dimension, on_contact_boundary, of_facets, finite):
    """Returns the columns of a [[probe]] entry: of a contact, of a boundary, of a group, or of a point."""
    name = probe["name"]
    if "contact" in probe:
        areas = ["area", "nominal_area"] if finite else ["area"]
        return (vector_columns(name + ".force", dimension) + vector_columns(name + ".centre", dimension) +
                [f"{name}.{area}" for area in areas])
    if "boundary" in probe:
        return boundary_columns(name, dimension)
    if "group" in probe:
        columns = [column for quantity in ("displacement", "velocity") for kind in ("average", "minimum", "maximum")
                   for column in vector_columns(f"{name}.{quantity}_{kind}", dimension)]
        return columns + ([] if of_facets else [f"{name}.von_mises_{kind}" for kind in ("average", "minimum", "maximum")])
    columns = vector_columns(name + ".displacement", dimension) + vector_columns(name + ".velocity", dimension)
    if on_contact_boundary:
        columns += [f"{name}.{column}" for column in ("gap", "pressure", "reaction_normal")]
        columns += vector_columns(name + ".reaction_tangential", dimension)
        columns += [f"{name}.nominal_pressure"] if finite else []
    return columns


def documented_columns(dimension, case, points):
    columns = ["step", "time", "kinetic_energy", "elastic_energy", "load_potential", "algorithmic_energy",
               "total_energy", "load_work", "contact_work", "friction_work", "support_work", "obstacle_work",
               "damping_work", "numerical_dissipation", "energy_residual"]
    columns += vector_columns("contact_force", dimension) + vector_columns("momentum", dimension)
    columns += ["angular_momentum_z"] if dimension == 2 else vector_columns("angular_momentum", 3)
    columns += ["max_rotation", "active_contacts", "sticking", "slipping", "max_penetration", "iterations"]
    bodies = list(case.get("part", {}))
    tied = any(contact.get("tied", False) for contact in case.get("contact", []))  # the cases with ties are one body
    if len(bodies) > 1 and not tied:
        for body in bodies:
            columns += vector_columns(f"momentum.{body}", dimension)
    finite = any(material.get("law", "linear") != "linear" for material in case["material"])
    if finite:
        columns += ["integration_error", "newton_rounds"]
    if any("relaxation" in material for material in case["material"]):
        columns += ["viscous_dissipation"]
    if any(contact.get("sliding") == "large" for contact in case.get("contact", [])):
        columns += ["re_pairing_work", "unsettled_gap"]
    for number, contact in enumerate(case.get("contact", [])):
        if "against" in contact and not contact.get("tied", False):
            columns += vector_columns(f"pair_force.{number}", dimension)
    facets, on_contact_boundary = boundary_groups(case), {point["name"] for point in points if point["in_contact_boundary"]}
    for probe in case.get("probe", []):
        columns += probe_columns(probe, dimension, probe["name"] in on_contact_boundary, probe.get("group") in facets,
                                 finite)
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
