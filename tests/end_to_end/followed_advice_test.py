"""Advice is tested: if a message advises a setting, it is applied to the case that caused it, and the message
disappears.

Every message in the sources that advises a setting (advising_messages.py) is in one of these tables: TRIED and
TRIED_BY_RUNS of followed_advice_tables.py, whose advice is followed here; ELSEWHERE, if another test does so; UNTRIED,
which is to become shorter. New messages belong in the first two."""

import re

from advising_messages import advising_messages
from followed_advice_cases import BLOCK, FILES, KANE, PRESSED_PAIR, STRUCK
from followed_advice_tables import TRIED, TRIED_BY_RUNS
from harness import SOURCE, TestCase, block_case, run, settings

# By the words of the sources: the file, under tests/, and words of the test.
ELSEWHERE = {
    'needs a linear material law: set material.law = "linear"':
        ("verification/finite_midpoint_test.cpp", "SchemesOfTheLinearLawAreRefused"),
    'the contact zone is too coarse for a reliable force: refine the mesh there':
        ("end_to_end/followed_advice_test.py", "test_of_contact_zones_that_are_coarse"),
    'for a reliable largest force and duration; refine the mesh there':
        ("end_to_end/followed_advice_test.py", "test_of_contact_zones_that_are_coarse"),
    'the energy loss that this restitution implies: use a smaller time.step and smaller cells':
        ("end_to_end/followed_advice_test.py", "test_of_restitution_that_the_method_has_made"),
    'leave multipliers_on out: with the multipliers on':
        ("end_to_end/multiplier_side_test.py", "leave multipliers_on out: with the multipliers on"),
    'a length at which no step is rejected, or a larger time.tolerance': ("verification/adaptive_onset_test.cpp", "EndWhereTheyDoNotGetOn"),
    'Add a group of these facets of this body to the mesh': ("end_to_end/self_penetration_test.py", "test_facets_without_a_group_of_their_own"),
    "in its [[material]]: the time in which a wave crosses a cell":
        ("end_to_end/warnings_test.py", "test_bodies_that_slide_without_damping"),
    "scheme \"{}\" {}; use scheme \"reduced-kane\"":
        ("end_to_end/followed_advice_tables.py", "does not support friction: its energy balance"),
    "use a time.step in which bodies move by less than the thickness of the obstacle":
        ("end_to_end/shaped_obstacles_test.py", "test_short_ones_do_not"),
}
# By the words of the sources: advice that no test follows. The list is to become shorter, not longer. A factor too
# large for CHOLMOD has 2^31 entries: its analysis alone takes a minute.
UNTRIED = [
    'entries, more than CHOLMOD can count: set solver.method = "iterative"',
]


class FollowedAdvice(TestCase):
    def setUp(self):
        super().setUp()
        for name, text in FILES.items():
            self.write(name, text)

    def said(self, text, values, command):
        case = self.write("case.toml", text)
        output = ["-o", self.folder / "out", "--force", "--quiet"] if command == "run" else []
        return run(command, case, *output, *settings({key: value for key, value in values.items() if value is not None}))

    def follow(self, tried, command):
        for message, text, values, advice in tried:
            found = re.search(message, self.said(text, values, command).stderr)
            self.assertIsNotNone(found, f"nothing says: {message}")
            for taken in advice:
                taken = taken(found) if callable(taken) else taken
                with self.subTest(message=message, taken=taken):
                    more, changed = (taken, {}) if isinstance(taken, str) else ("", taken)
                    after = self.expect_status(0, self.said(text + more, {**values, **changed}, command))
                    self.assertNotRegex(after.stderr, message)

    def test_before_a_run(self):
        self.follow(TRIED, "validate")

    def test_of_runs(self):
        self.follow(TRIED_BY_RUNS, "run")

    def info(self, text, values, name):
        """Returns the output of `ricochet info` for a run, and for it beside itself."""
        out = self.simulate(self.write("case.toml", text), name, {key: value for key, value in values.items() if value is not None})
        return run("info", out).stdout, run("info", out, out).stdout

    def test_of_contact_zones_that_are_coarse(self):
        for refine, coarse in ((0, True), (2, False)):
            one, beside = self.info(block_case(), {"mesh.refine": refine}, f"refined-{refine}")
            self.assertEqual("too coarse for a reliable largest force and duration; refine the mesh there" in one, coarse)
            self.assertEqual("the contact zone is too coarse for a reliable force: refine the mesh there" in beside, coarse)

    def test_of_restitution_that_the_method_has_made(self):
        for step, refine in ((0.01, 0), (0.002, 2)):
            values = {**KANE, "time.end": 1.0, "time.reaction_weight": "end", "time.step": step, "mesh.refine": refine}
            _, beside = self.info(STRUCK, values, f"refined-{refine}")
            self.assertEqual("implies: use a smaller time.step and smaller cells" in beside, refine == 0)

    def test_overlaps_deeper_than_a_cell_are_no_press_fits(self):
        """A static start would push the block through the floor: it is not advised, and warns."""
        deep = self.expect_status(2, self.said(BLOCK, {**KANE, "mesh.move": "[0.0, -0.9]"}, "validate")).stderr
        self.assertIn("creates energy; check on which side of the obstacle the body is", deep)
        self.assertNotIn('"static"', deep)
        said = self.expect_status(0, self.said(BLOCK, {**KANE, "mesh.move": "[0.0, -0.9]", "initial.displacement": "static"}, "validate"))
        self.assertIn('warning: initial.displacement = "static" moves the body by', said.stderr)

    def test_edges_are_no_curves_that_facets_stand_for(self):
        """Two parallelograms overlap: a mesh of second order, which would be the same, is not advised."""
        said = self.said(PRESSED_PAIR, {"part.two.move": "[0.2, 1.05]", "contact.0.initial_gap": "closed"}, "validate")
        self.assertNotIn("mesh of second order", self.expect_status(0, said).stderr)

    def test_every_message_is_in_a_table(self):
        messages = advising_messages()
        self.assertGreater(len(messages), 50, "the sources are where they were")
        patterns = [pattern for pattern, *_ in TRIED + TRIED_BY_RUNS]
        fragments = [*ELSEWHERE, *UNTRIED]
        for file, message in messages:
            with self.subTest(file):
                known = any(covers(pattern, message) for pattern in patterns) or any(fragment in message for fragment in fragments)
                self.assertTrue(known, f"{file} advises a setting, and no test takes it (followed_advice_tables.py): {message}")
        for fragment in fragments:
            self.assertTrue(any(fragment in message for _, message in messages), f"no message says any more: {fragment}")

    def test_other_tests_are_there(self):
        for fragment, (file, name) in ELSEWHERE.items():
            self.assertIn(name, (SOURCE / "tests" / file).read_text(encoding="utf-8"), fragment)


def covers(pattern, message):
    """Returns whether the words of a pattern, in pieces between its placeholders, are those of a message."""
    words = [re.sub(r"\\(.)", r"\1", piece) for piece in re.split(r"\(\\S\+\)|\\\.\\S\+|\.\*", pattern)]
    return all(piece.strip() in message for piece in words)
