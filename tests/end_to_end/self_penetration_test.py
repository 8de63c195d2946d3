"""Bodies that penetrate themselves: found and reported, with the contact that prevents it, which is tested; and reports
if nothing was checked."""

import json

from harness import History, TestCase, run, summary_of, write_msh
from report_page import Page
from self_contact_test import CLAMP_GEO

CLAMP = '''[mesh]
file = "clamp.geo"
[[material]]
group = "body"
law = "neo-hookean"
density = 1.0
young = 300.0
poisson = 0.3
[initial]
velocity = ["0", "4*(x-0.3)*(0.5-y)"]
[[probe]]
name = "upper"
at = [1.8, 0.65]
[[probe]]
name = "lower"
at = [1.8, 0.35]
[[probe]]
name = "upper-tip"
at = [2.0, 0.65]
[[probe]]
name = "lower-tip"
at = [2.0, 0.35]
[mass]
type = "equivalent"
[time]
step = 4e-3
end = 0.1
'''


CRACKED = '''[mesh]
file = "cracked.msh"
[[material]]
group = "body"
density = 1.0
young = 1000.0
poisson = 0.3
{drive}
[time]
step = 5e-3
end = 0.2
[output]
fields_every = 0
'''
FAR_GEO = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 9, 0, 1, 1};
Mesh.MeshSizeMax = 0.5;
Physical Surface("body") = {1};
Physical Curve("skin") = Boundary{ Surface{1}; };
"""
SLIT = 1e-6
HELD = '[[support]]\ngroup = "base"\ncomponents = ["x", "y"]\n[[pressure]]\ngroup = "roof"\nvalue = "{}*min(t/0.1, 1)"\n'


def cracked(path):
    """Returns a block of squares of 0.1 with a slit at half of its height, as wide as the rounding of a drawing: nodes
    are doubled except at its tip."""
    columns, rows, tip = 10, 4, 6
    nodes = [(0.1 * i, 0.1 * j) for j in range(rows + 1) for i in range(columns + 1)]
    at = lambda i, j: 1 + j * (columns + 1) + i
    above = {i: len(nodes) + 1 + i for i in range(tip)}
    nodes += [(0.1 * i, 0.1 * 2 + SLIT) for i in range(tip)]
    over = lambda i, j: above.get(i, at(i, j)) if j == 2 else at(i, j)
    cells = [(3, 1, (at(i, j) if j < 2 else over(i, j), at(i + 1, j) if j < 2 else over(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
             for j in range(rows) for i in range(columns)]
    cells += [(1, 2, (at(i, 0), at(i + 1, 0))) for i in range(columns)]
    cells += [(1, 3, (at(i, rows), at(i + 1, rows))) for i in range(columns)]
    cells += [(1, 4, (at(i, 2), at(i + 1, 2))) for i in range(tip)]
    cells += [(1, 5, (over(i, 2), over(i + 1, 2))) for i in range(tip)]
    write_msh(path, ['2 1 "body"', '1 2 "base"', '1 3 "roof"', '1 4 "lower.lip"', '1 5 "upper.lip"'], nodes, cells)


def told(output):
    return [text for text in summary_of(output)["warnings"] if "through itself" in text]


class SelfPenetration(TestCase):
    def found_in(self, output):
        entry = summary_of(output)["unwatched_penetration"]
        self.assertEqual(entry["not_watched"], [])
        self.assertGreaterEqual(entry["looks_at_themselves"], 2)
        return entry["found"]

    def clamp(self, name, more="", options=("--quiet",)):
        (self.folder / "clamp.geo").write_text(CLAMP_GEO)
        return self.simulate(self.write(f"{name}.toml", CLAMP + more), name, options=options)

    def test_a_clamp_and_the_advice(self):
        """Its arms penetrate by the distance of two facing nodes; with the advised contact none do."""
        output = self.clamp("alone")
        history = History(output / "history.csv")
        overlap = lambda where: max(0.35 + low - 0.65 - high for low, high in zip(
            history[f"lower{where}.displacement_y"], history[f"upper{where}.displacement_y"]))
        self.assertGreater(overlap(""), 0.05)
        [found] = self.found_in(output)
        self.assertEqual((found["bodies"], found["obstacle"], found["contact"]), (["the body"], None, None))
        # The arms' ends are deepest; nodes at their corners face nothing, those beside them do.
        self.assertGreater(found["depth"], overlap(""))
        self.assertLess(found["depth"], overlap("-tip"))
        self.assertIn("inside", found["groups"])
        self.assertIn("inside", found["through_groups"])
        self.assertLess(found["first_time"], found["time"])
        [warning] = told(output)
        self.assertIn("the body has gone through itself by", warning)
        self.assertIn("boundary of groups", warning)
        lines = warning.partition("Add\n")[2]
        text = self.expect_status(0, run("info", output)).stdout
        self.assertIn(f"PENETRATION WITHOUT CONTACT: the body in itself, {found['depth']:.3g} deep", text)
        self.expect_status(0, run("report", output))
        judgement = Page(output / "report.html").runs[0]["judgement"]
        self.assertEqual(judgement["unwatched_penetration"], "the body in itself")
        self.assertEqual(judgement["penetration"], found["depth"])
        self.assertEqual(judgement["penetration_not_watched"], "")
        kept = self.clamp("kept", lines + "\n", ("--quiet", "--set", "time.end=0.16"))
        self.assertGreater(max(History(kept / "history.csv")["active_contacts"]), 0)
        self.assertEqual((self.found_in(kept), told(kept)), ([], []))

    def test_facets_without_a_group_of_their_own(self):
        """A group that contains another body as well cannot be a side of such a contact: a group of the body alone is
        requested, and works."""
        beside = CLAMP_GEO.replace('Physical Surface("body") = {3};', 'Rectangle(9) = {4, 0, 0, 0.5, 0.5};\nPhysical Surface("body") = {3, 9};')
        beside = beside.replace('Boundary{ Surface{3}; };', 'Boundary{ Surface{3, 9}; };')
        groups = beside.index('Physical Curve("lower")')
        (self.folder / "clamp.geo").write_text(beside[:groups])
        [warning] = told(self.simulate(self.write("beside.toml", CLAMP), "beside"))
        self.assertIn("Add a group of these facets of this body to the mesh", warning)
        (self.folder / "clamp.geo").write_text(beside)
        lines = '[[contact]]\ngroup = "inside"\nagainst = "inside"\nsliding = "large"\n'
        output = self.simulate(self.write("grouped.toml", CLAMP + lines), "grouped")
        self.assertEqual((self.found_in(output), told(output)), ([], []))

    def test_a_run_that_is_resumed_has_found_the_same(self):
        whole = self.clamp("whole", "[output]\ncheckpoint_every = 10\n")
        part = self.clamp("part", "[output]\ncheckpoint_every = 10\n")
        (part / "summary.json").unlink()
        self.expect_status(0, run("run", self.folder / "part.toml", "-o", part, "--resume", "--quiet"))
        one, other = summary_of(whole), summary_of(part)
        self.assertTrue(other["resumed_at"])
        self.assertEqual(other["unwatched_penetration"], one["unwatched_penetration"])
        self.assertEqual(other["warnings"], one["warnings"])

    def test_a_slit_that_closes_opens_and_flies(self):
        """Lips that almost touch do not overlap; if pressed they do, according to their displacements, as in the linear
        law."""
        cracked(self.folder / "cracked.msh")
        lip = '[[probe]]\nname = "{}"\ngroup = "{}"\n'
        probes = lip.format("low", "lower.lip") + lip.format("high", "upper.lip")
        drives = {"pressed": HELD.format(0.5), "pulled": HELD.format(-0.5), "flying": '[initial]\nvelocity = ["3-0.2*y", "1+0.2*x"]\n'}
        for name, drive in drives.items():
            output = self.simulate(self.write(f"{name}.toml", CRACKED.format(drive=drive + probes)), name)
            found = self.found_in(output)
            if name != "pressed":
                self.assertEqual((found, told(output)), ([], []), name)
                continue
            [found] = found
            self.assertEqual((found["groups"], found["through_groups"]) in
                             ((["lower.lip"], ["upper.lip"]), (["upper.lip"], ["lower.lip"])), True, found)
            # For opposite nodes: the mouth of the slit closes most.
            history = History(output / "history.csv")
            largest = max(low - high for low, high in
                          zip(history["low.displacement_maximum_y"], history["high.displacement_minimum_y"]))
            self.assertGreater(found["depth"], 0.0)
            self.assertLessEqual(found["depth"], 1.01 * largest)
            [warning] = told(output)
            self.assertIn('against = "', warning)

    def test_a_contact_with_another_body_hides_nothing(self):
        """In long steps the arms move by more than an edge between two checks, with and without another body beside them and a
        contact with it."""
        (self.folder / "far.geo").write_text(FAR_GEO)
        beside = (CLAMP.replace('[mesh]\nfile = "clamp.geo"', '[part.clamp]\nfile = "clamp.geo"\n[part.far]\nfile = "far.geo"')
                  .replace('group = "body"', 'group = "all"').replace("(0.5-y)", "(0.5-y)*max(0, min(1, 5-y))"))
        contact = '[[contact]]\ngroup = "clamp.skin"\nagainst = "far.skin"\n'
        for name, text in (("alone", CLAMP), ("beside", beside), ("contact", beside + contact)):
            (self.folder / "clamp.geo").write_text(CLAMP_GEO)
            output = self.simulate(self.write(f"{name}.toml", text), name, {"time.step": 0.02, "time.end": 0.2}, ("--quiet",))
            [entry] = summary_of(output)["unwatched_penetration"]["not_watched"]
            self.assertIn("bodies against themselves between checks", entry, name)

    def test_what_was_not_watched_is_not_called_fine(self):
        """Results of several processes."""
        output = self.clamp("divided", "[output]\nfields_every = 10\n")
        summary = summary_of(output)
        entry = dict(summary["unwatched_penetration"], found=[], depth=0.0, relative_depth=0.0,
                     not_watched=["bodies against themselves (they are divided among several processes)"])
        (output / "summary.json").write_text(json.dumps(dict(summary, unwatched_penetration=entry)), encoding="utf-8")
        self.assertIn("not checked for interpenetration: bodies against themselves",
                      self.expect_status(0, run("info", output)).stdout)
        self.expect_status(0, run("report", output))
        judgement = Page(output / "report.html").runs[0]["judgement"]
        self.assertTrue(judgement["penetration_not_watched"].startswith("bodies against themselves"))
