"""docs/case-file.md agrees with the output of the program, and the commands of the cases' pages can be typed one after
the other."""

import pathlib
import shlex
import unittest

from harness import SOURCE, TestCase, run


class Documentation(TestCase):
    def test_reference_of_the_case_file(self):
        printed = self.expect_status(0, run("schema", "--markdown")).stdout
        written = (SOURCE / "docs" / "case-file.md").read_text(encoding="utf-8")
        self.assertEqual(written, printed, "write it anew: build/ricochet schema --markdown > docs/case-file.md")

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


if __name__ == "__main__":
    unittest.main()
