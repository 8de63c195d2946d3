"""[[contact]] of every body with every other: the same as a contact for each pair, at any distance."""

import math
import shutil

from harness import History, TestCase, run, settings, summary_of

RINGS, SECTORS = 3, 20


def disc_text():
    """Returns a disc of radius 0.5 in triangles."""
    nodes = [(0.0, 0.0)]
    for ring in range(1, RINGS + 1):
        for k in range(SECTORS):
            angle = 2 * math.pi * (k + 0.5 * (ring % 2)) / SECTORS
            nodes.append((0.5 * ring / RINGS * math.cos(angle), 0.5 * ring / RINGS * math.sin(angle)))

    def number(ring, k):
        return 1 if ring == 0 else 2 + (ring - 1) * SECTORS + k % SECTORS

    elements = [f"1 2 1 1 {number(RINGS, k)} {number(RINGS, k + 1)}" for k in range(SECTORS)]
    elements += [f"2 2 2 1 1 {number(1, k)} {number(1, k + 1)}" for k in range(SECTORS)]
    for ring in range(1, RINGS):
        for k in range(SECTORS):
            ahead = k + ring % 2  # on the outer ring, the node between this one and the next
            elements.append(f"2 2 2 1 {number(ring, k)} {number(ring + 1, ahead)} {number(ring, k + 1)}")
            elements.append(f"2 2 2 1 {number(ring, k + 1)} {number(ring + 1, ahead)} {number(ring + 1, ahead + 1)}")
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 1 "skin"', '2 2 "disc"', "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(nodes)), *(f"{i} {x!r} {y!r} 0" for i, (x, y) in enumerate(nodes, start=1)), "$EndNodes"]
    lines += ["$Elements", str(len(elements)), *(f"{i} {line}" for i, line in enumerate(elements, start=1)), "$EndElements", ""]
    return "\n".join(lines)


def part(name, x, y, velocity):
    return f'[part.{name}]\nfile = "disc.msh"\nmove = [{x}, {y}]\nvelocity = {velocity}\n'


MATERIAL = '[[material]]\ngroup = "all"\ndensity = 1.0\nyoung = 200.0\npoisson = 0.3\nlaw = "neo-hookean"\n'
TIME = '[time]\nscheme = "reduced-kane"\nstep = 5e-3\nend = 0.25\n[output]\nfields_every = 0\ncheckpoint_every = 20\n'
# One disc strikes the second, which moves on to a third; a fourth is far away.
ROW = (part("disc-1", 0.0, 0.0, [2.0, 0.1]) + part("disc-2", 1.02, 0.2, [0.0, 0.0]) + part("disc-3", 2.07, 0.0, [0.0, 0.0])
       + part("other", 9.0, 0.0, [0.0, 0.0]))
PAIRS = [("disc-1", "disc-2"), ("disc-1", "disc-3"), ("disc-2", "disc-3")]
EXPLICIT = "".join(f'[[contact]]\ngroup = "{one}.skin"\nagainst = "{other}.skin"\nsliding = "large"\nfriction = 0.3\n'
                   for one, other in PAIRS)
PROBE = '[[probe]]\nname = "all"\ncontact = 0\n'


class AllPairs(TestCase):
    def setUp(self):
        super().setUp()
        self.write("disc.msh", disc_text())

    def case(self, name, contacts, parts=ROW, more=""):
        return self.write(f"{name}.toml", parts + MATERIAL + contacts + more + TIME)

    def history(self, name, contacts, more=""):
        return History(self.simulate(self.case(name, contacts, more=more), name) / "history.csv")

    def expect_alike(self, one, other):
        size = one.largest_energy()
        for column in ("total_energy", "kinetic_energy", "friction_work", "contact_work"):
            for a, b in zip(one[column], other[column]):
                self.assertAlmostEqual(a / size, b / size, delta=1e-9)

    def test_the_same_as_a_contact_for_each_pair(self):
        explicit = self.history("explicit", EXPLICIT)
        self.assertGreater(max(map(abs, explicit["pair_force.2_x"])), 0.0)  # the third disc is struck as well
        for name, group in (("pattern", '"disc-*"'), ("skins", '"disc-*.skin"'), ("list", '["disc-1.skin", "disc-2.skin", "*-3"]')):
            found = self.history(name, f"[[contact]]\ngroup = {group}\nfriction = 0.3\n", PROBE)
            self.expect_alike(explicit, found)
            for number in range(3):
                for a, b in zip(explicit[f"pair_force.{number}_x"], found[f"pair_force.{number}_x"]):
                    self.assertAlmostEqual(a, b, delta=1e-6)
            # A probe of the contact is the sum over its pairs of the forces on the first body of each.
            for row in range(len(found.rows)):
                total = sum(found[f"pair_force.{number}_x"][row] for number in range(3))
                self.assertAlmostEqual(found["all.force_x"][row], total, delta=1e-9)
        summary = summary_of(self.folder / "pattern")
        self.assertEqual([(c["group"], c["against"], c["pair_of"]) for c in summary["contacts"]],
                         [(*pair, "disc-*") for pair in PAIRS])
        text = self.expect_status(0, run("info", self.folder / "pattern")).stdout
        self.assertIn('bodies "disc-2" and "disc-3"', text)

    def test_all_of_them_and_energy(self):
        found = self.history("all", '[[contact]]\ngroup = "all"\n')
        size = found.largest_energy()
        self.assertLess(max(map(abs, found["energy_residual"])), 1e-10 * size)
        self.assertLessEqual(max(found["total_energy"]), found["total_energy"][0] + 1e-10 * size)
        summary = summary_of(self.folder / "all")
        self.assertEqual(len(summary["contacts"]), 6)
        text = self.expect_status(0, run("info", self.folder / "all")).stdout
        self.assertIn('every body of "all" against every other, 6 pairs', text)

    def test_a_pair_with_a_contact_of_its_own_has_that(self):
        own = '[[contact]]\ngroup = "disc-1.skin"\nagainst = "disc-2.skin"\nsliding = "large"\nfriction = 0.3\n'
        found = self.history("own", own + '[[contact]]\ngroup = "disc-*"\nfriction = 0.3\n')
        self.expect_alike(self.history("explicit", EXPLICIT), found)
        contacts = summary_of(self.folder / "own")["contacts"]
        self.assertEqual([(c["group"], c["against"]) for c in contacts][1:], PAIRS[1:])

    def test_a_run_that_goes_on_has_the_same_bits(self):
        case = self.case("row", '[[contact]]\ngroup = "all"\nfriction = 0.3\n')
        whole = self.simulate(case, "whole")
        # By then the first pair has met, but not the second.
        part = self.simulate(case, "part", {"time.end": 0.15})
        shutil.copytree(part, self.folder / "longer")
        self.expect_status(0, run("run", "--resume", self.folder / "longer", "--quiet", *settings({"time.end": 0.25})))
        self.assertEqual((whole / "history.csv").read_bytes(), (self.folder / "longer" / "history.csv").read_bytes())

    def test_refusals(self):
        def message(contacts, parts=ROW):
            return self.expect_status(2, run("validate", self.case("refused", contacts, parts))).stderr

        self.assertIn('needs either "obstacle" or "against"; found none of them; without them `group` must be "all"',
                      message('[[contact]]\ngroup = "disc-1.skin"\n'))
        self.assertIn('"pad-*"', message('[[contact]]\ngroup = "pad-*"\n'))
        self.assertIn("is on 1 body, and there is no other",
                      message('[[contact]]\ngroup = "all"\n', part("alone", 0.0, 0.0, [0.0, 0.0])))
        self.assertIn("is only for contact between two groups", message('[[contact]]\ngroup = "all"\ntied = true\n'))
