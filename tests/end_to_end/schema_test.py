"""The JSON Schema of `ricochet schema`: it accepts what the program accepts, and refuses the keys of another choice as the program does."""

import json
import re
import tomllib
import unittest

import jsonschema

from harness import MESHES, SOURCE, TestCase, run

# Sections of a case that is accepted, each with a key of a choice that it does not make: the first does not choose at all.
FOREIGN = {"time": ('restitution = 0.5', 'scheme = "newmark"\npreset = "trapezoidal"\nrestitution = 0.5', 'scheme = "midpoint"\nbeta = 0.25',
                    'penalty = 1.0', 'preset = "trapezoidal"', 'spectral_radius = 0.5'),
           "material": ('c10 = 1.0', 'bulk_modulus = 1.0', 'law = "saint-venant-kirchhoff"\nc01 = 1.0'),
           "obstacle.floor": ('radius = 1.0',)}
OWN = {"time": ('reaction_weight = "end"', 'scheme = "reduced-kane"\nreaction_weight = "end"', 'scheme = "newmark"\nbeta = 0.25\ngamma = 0.5'),
       "material": ('damping = { mass = 1.0 }', 'law = "linear"')}
CASE = """[mesh]
file = "{mesh}"
[[material]]
group = "body"
density = 1.0
young = 1.0
poisson = 0.3
{material}
[obstacle.floor]
type = "plane"
point = [0, -2]
normal = [0, 1]
{obstacle.floor}
[[contact]]
group = "boundary"
obstacle = "floor"
[time]
step = 0.1
end = 1.0
{time}
"""


def with_lines(section, lines):
    """Returns the case with lines in one of its sections."""
    text = CASE.replace("{mesh}", str(MESHES / "disc_o2_msh41_ascii.msh"))
    return re.sub(r"^\{(.*)\}\n", lambda found: lines + "\n" if found[1] == section else "", text, flags=re.MULTILINE)


class CaseSchema(TestCase):
    def setUp(self):
        super().setUp()
        schema = json.loads(self.expect_status(0, run("schema")).stdout)
        jsonschema.Draft202012Validator.check_schema(schema)
        self.validator = jsonschema.Draft202012Validator(schema)

    def accepts(self, text):
        """Returns whether the schema and the program accept a case, which they must agree on."""
        by_schema = self.validator.is_valid(tomllib.loads(text))
        case = self.folder / "case.toml"
        case.write_text(text, encoding="utf-8")
        process = run("validate", case)
        self.assertEqual(process.returncode, 0 if by_schema else 2, f"{text}\n{process.stderr}")
        return by_schema

    def test_accepts_all_cases(self):
        cases = [path for folder in ("cases", "benchmarks", "tests/bits", "docs/figures") for path in (SOURCE / folder).rglob("*.toml")]
        self.assertGreater(len(cases), 50)
        texts = {path: path.read_text(encoding="utf-8") for path in cases}
        for page in (SOURCE / "docs").rglob("*.md"):
            blocks = re.findall(r"^```toml\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
            texts |= {f"{page}: {number}": block for number, block in enumerate(blocks)}
        complete = {name: case for name, case in ((name, tomllib.loads(text)) for name, text in texts.items()) if {"material", "time"} <= case.keys()}
        self.assertGreater(len(complete), len(cases) + 5)
        for name, case in complete.items():
            self.assertEqual([error.message for error in self.validator.iter_errors(case)], [], name)

    def test_refuses_keys_of_another_choice(self):
        self.assertTrue(self.accepts(with_lines("", "")))
        for section, all_lines in FOREIGN.items():
            for lines in all_lines:
                self.assertFalse(self.accepts(with_lines(section, lines)), lines)

    def test_accepts_keys_of_the_choice(self):
        for section, all_lines in OWN.items():
            for lines in all_lines:
                self.assertTrue(self.accepts(with_lines(section, lines)), lines)


if __name__ == "__main__":
    unittest.main()
