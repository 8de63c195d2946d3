"""docs/case-file.md agrees with the output of the program, and the commands of the cases' pages can be typed one after
the other."""

import itertools
import pathlib
import re
import shlex
import sys

from harness import SOURCE, TestCase, run

sys.path.insert(0, str(SOURCE / "docs"))

import history_columns  # noqa: E402


# Columns of histories in their order, by the condition under which they exist. Users' programs read them by these names: a column
# that is renamed, lost or moved breaks them. * stands for the components of a vector, ° for those of an axial vector.
COLUMNS = [
    ("", "step time kinetic_energy elastic_energy load_potential algorithmic_energy total_energy load_work contact_work friction_work "
     "support_work obstacle_work damping_work numerical_dissipation energy_residual contact_force* momentum* angular_momentum° "
     "max_rotation active_contacts sticking slipping max_penetration iterations"),
    ("meshes of 2 to 20 bodies", "momentum.BODY*"),
    ("laws of finite strain", "integration_error newton_rounds velocity_correction"),
    ("`relaxation` of a material", "viscous_dissipation"),
    ("large sliding between bodies", "re_pairing_work unsettled_gap"),
    ("surfaces that touch themselves", "left_out_points"),
    ("rigid bodies that move freely", "NAME.displacement* NAME.velocity* NAME.rotation° NAME.spin° NAME.contact_force*"),
    ("contacts between bodies", "pair_force.N*"),
    ("probes with `at`", "NAME.displacement* NAME.velocity*"),
    ("probes with `at`, on a contact boundary", "NAME.gap NAME.pressure NAME.reaction_normal NAME.reaction_tangential*"),
    ("probes with `at`, on a contact boundary, with laws of finite strain", "NAME.nominal_pressure"),
    ("probes with `boundary`", "NAME.force* NAME.moment° NAME.support* NAME.support_moment°"),
    ("probes with `group`", "NAME.displacement_average* NAME.displacement_minimum* NAME.displacement_maximum* "
     "NAME.velocity_average* NAME.velocity_minimum* NAME.velocity_maximum*"),
    ("probes with `group`, groups of cells", "NAME.von_mises_average NAME.von_mises_minimum NAME.von_mises_maximum"),
    ("probes with `contact`", "NAME.force* NAME.centre* NAME.area"),
    ("probes with `contact`, with laws of finite strain", "NAME.nominal_area"),
]


class Documentation(TestCase):
    def test_reference_of_the_case_file(self):
        printed = self.expect_status(0, run("schema", "--markdown")).stdout
        written = (SOURCE / "docs" / "case-file.md").read_text(encoding="utf-8")
        self.assertEqual(written, printed, "write it anew: build/ricochet schema --markdown > docs/case-file.md")

    def test_tables_of_columns(self):
        printed = self.expect_status(0, run("schema", "--columns")).stdout
        self.assertEqual(history_columns.written_table(), printed, "write it anew: docs/history_columns.py build/ricochet")

    def test_columns_keep_names_components_and_order(self):
        marks = {"one": "", "vector": "*", "axial": "°"}
        found = [(condition, " ".join(name + marks[components] for name, components, *_ in rows))
                 for condition, rows in itertools.groupby(history_columns.documented_columns(), key=lambda row: row[3])]
        self.assertEqual(found, COLUMNS)

    def test_names_of_code_are_in_the_files_that_pages_link(self):
        """`name` in [file](path), or [file](path), `name`: a renamed function must not live on in a page."""
        named = re.compile(r"`([A-Za-z_:]+)(?:\(\))?`\s+in\s+\[[^\]]*\]\(([^)#]+\.[hc]pp)\)"
                           r"|\[[^\]]*\]\(([^)#]+\.[hc]pp)\)\)?, `([A-Za-z_:]+)(?:\(\))?`(?! in| of|,)")
        found = 0
        for page in sorted((SOURCE / "docs").rglob("*.md")):
            for match in named.finditer(page.read_text(encoding="utf-8")):
                name, path = (match[1], match[2]) if match[1] else (match[4], match[3])
                with self.subTest(page=page.name, name=name):
                    text = (page.parent / path).read_text(encoding="utf-8")
                    self.assertRegex(text, rf"\b{name.split('::')[-1]}\b", path)
                found += 1
        self.assertGreater(found, 50)

    def test_new_names_of_the_glossary_exist(self):
        """The glossary says what became of the names in notes and issues: a new name that was renamed again must follow."""
        folders = ("src", "apps", "python", "bench", "tests")
        paths = [path for folder in folders for path in (SOURCE / folder).rglob("*") if path.suffix in (".cpp", ".hpp", ".py", ".txt")]
        names = set(re.findall(r"\w+", "\n".join(map(str, paths)) + "\n".join(path.read_text(encoding="utf-8") for path in paths)))
        rows = re.findall(r"^\| `[^`]*` \| (.*?) \|", (SOURCE / "docs/developers/glossary.md").read_text(encoding="utf-8"), re.MULTILINE)
        new = [name for row in rows for code in re.findall(r"`([^`]+)`", row) for name in re.findall(r"[A-Za-z_]\w*", code)]
        self.assertGreater(len(new), 900)
        self.assertEqual([name for name in new if name not in names], [])

    def test_commands_of_the_cases_write_into_different_directories(self):
        taken = {}
        for page in sorted((SOURCE / "cases").glob("*/README.md")):
            for line in page.read_text(encoding="utf-8").splitlines():
                if not line.startswith("    build/ricochet run "):
                    continue
                words = shlex.split(line.rstrip("\\"), comments=True)
                case = SOURCE / words[2]
                self.assertTrue(case.is_file(), f"{page}: {line}")
                output = words[words.index("-o") + 1] if "-o" in words else f"out/{pathlib.Path(words[2]).stem}"
                self.assertNotIn(output, taken, f"{page}: {line.strip()} and {taken.get(output)} write into {output}")
                taken[output] = f"{page}: {line.strip()}"
        self.assertGreater(len(taken), 15)
