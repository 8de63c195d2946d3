"""docs/case-file.md agrees with the output of the program, and the commands of the cases' pages can be typed one after
the other."""

import pathlib
import re
import shlex
import sys

from harness import SOURCE, TestCase, run

sys.path.insert(0, str(SOURCE / "docs"))

import history_columns  # noqa: E402


class Documentation(TestCase):
    def test_reference_of_the_case_file(self):
        printed = self.expect_status(0, run("schema", "--markdown")).stdout
        written = (SOURCE / "docs" / "case-file.md").read_text(encoding="utf-8")
        self.assertEqual(written, printed, "write it anew: build/ricochet schema --markdown > docs/case-file.md")

    def test_tables_of_columns(self):
        printed = self.expect_status(0, run("schema", "--columns")).stdout
        self.assertEqual(history_columns.written_table(), printed, "write it anew: docs/history_columns.py build/ricochet")

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
