"""The tutorial runner finds errors on a page: otherwise a tutorial with any contents could pass."""

import pathlib
import re
import shutil
import tempfile
import unittest

from tutorial_pages import Command, File, agrees, difference, is_installed, read, run

ENVIRONMENT = {"PATH": "/usr/bin:/bin"}
TUTORIALS = pathlib.Path(__file__).resolve().parents[2] / "docs" / "tutorials"


class TutorialPages(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ricochet-tutorial-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def page(self, text):
        path = self.folder / "page.md"
        path.write_text(text, encoding="utf-8")
        return path

    def problems(self, text):
        place = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        return [problem for _, _, _, problem in run(self.page(text), place, ENVIRONMENT)]

    def test_numbers_agree_to_the_digits_shown(self):
        for shown, found in (("force 7.93 N", "force 7.931 N"), ("force 7.93 N", "force 7.94 N"), ("1,492 tests", "1492 tests"),
                             ("error 1e-13", "error 2e-13"), ("\u22120.5", "-0.52"), ("zero 0", "zero 1e-15"), ("a  b", "a b")):
            self.assertTrue(agrees(shown, found), (shown, found))
        for shown, found in (("force 7.93 N", "force 7.95 N"), ("force 7.93 N", "force 7.93 kN"), ("force 7.93 N", "force N"),
                             ("0.5", "-0.5"), ("zero 0", "zero 1e-9"), ("1 and 2", "2 and 1"), ("6 of 6 runs done", "5 of 6 runs done"), ("whole", "whole line")):
            self.assertFalse(agrees(shown, found), (shown, found))

    def test_what_an_ellipsis_stands_for(self):
        self.assertTrue(agrees("from … to 3", "from 1 by 2 to 3"))
        self.assertFalse(agrees("from … to 3", "from 1 by 2 to 5"))
        self.assertIsNone(difference(["…", "b"], ["a", "", "b"]))
        self.assertIsNone(difference(["a", "…"], ["a", "b", "c"]))
        self.assertIn("the page shows\n    c", difference(["…", "c"], ["a", "b"]))

    def test_lines_that_only_one_side_has(self):
        self.assertIsNone(difference(["a", "b"], ["a", "", "b"]))
        self.assertIn("nothing more", difference(["a", "b"], ["a"]))
        self.assertIn("does not show\n    b", difference(["a"], ["a", "b"]))
        self.assertIn("does not show\n    a", difference([], ["a"]))

    def test_files_and_commands(self):
        steps = read(self.page("```toml\n# a.toml\nx = 1\n```\n```console\n$ cat \\\n  a.toml\nx = 1\n$ true\n```\n"))
        self.assertEqual(steps, [File("a.toml", "# a.toml\nx = 1\n"), Command("cat a.toml", ["x = 1"]), Command("true", [])])
        for kind in ("sh", "bash", "python", "toml", "cpp", "cmake"):
            with self.assertRaisesRegex(AssertionError, "no test runs this block"):
                read(self.page(f"```{kind}\nwithout a name\n```\n"))
        with self.assertRaisesRegex(AssertionError, "without a command"):
            read(self.page("```console\nprinted by nothing\n```\n"))

    def test_a_page_is_run(self):
        self.assertEqual(self.problems("```\n# a.txt\n3.14\n```\n```console\n$ tail -1 a.txt\n3.14\n```\n"), [None])
        self.assertIn("the page shows\n    3.5", self.problems("```\n# a.txt\n3.14\n```\n```console\n$ tail -1 a.txt\n3.5\n```\n")[0])
        self.assertEqual(self.problems("```console\n$ false\n```\n"), ["ended with status 1"])

    def test_what_is_not_installed_is_left_out(self):
        self.assertTrue(is_installed("bash", ENVIRONMENT) and is_installed("json", ENVIRONMENT))
        self.assertFalse(is_installed("no-such-program", ENVIRONMENT) or is_installed("no_such_module", ENVIRONMENT))
        self.assertEqual(self.problems("```console needs no-such-program\n$ false\n```\n"), [None])
        self.assertEqual(self.problems("```console needs bash\n$ false\n```\n"), ["ended with status 1"])

    def test_pages_start_only_programs_that_they_ask_for(self):
        """Programs on a test machine need not exist on a reader's: CMake, for one, uses `make` by default."""
        of_debian = {"bash", "cmp", "diff", "echo", "grep", "ls", "true"}  # essential packages have them
        for path in sorted(TUTORIALS.glob("*.md")):
            text = path.read_text(encoding="utf-8")
            for step in read(path):
                if isinstance(step, File) or step.needs:
                    continue
                for command in re.split(r"\|\||&&|\||;", re.sub("'[^']*'|\"[^\"]*\"", "…", step.text)):
                    program = command.split()[0]
                    if program in of_debian | {"ricochet", "python3"} or program.startswith("build/"):
                        continue
                    self.assertRegex(text, rf"(?i)you need.*`{program}`", f"{path.name}: {step.text}")
                    if program == "cmake" and "-S" in command:
                        self.assertIn("-G Ninja", command, f"{path.name}: {step.text}")
                        self.assertRegex(text, r"(?i)you need.*`ninja-build`", path.name)


if __name__ == "__main__":
    unittest.main()
