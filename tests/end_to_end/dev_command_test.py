"""`./dev`: its help and docs/developers/commands.md list all commands, wrong options are refused before anything is
compiled, the tiers of tests are what their options say, and the gate for bits finds a change of one rounding."""

import contextlib
import importlib.util
import io
import math
import re
import subprocess
import sys
import unittest
import unittest.mock

from harness import PROGRAM, SOURCE, TestCase

def module(path):
    """Returns the module of a script, several of which are called run.py."""
    spec = importlib.util.spec_from_file_location("_".join(path.relative_to(SOURCE).with_suffix("").parts), path)
    result = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(result)
    return result


bits, tiers, faults = (module(SOURCE / "tests" / name) for name in ("bits/run.py", "run.py", "faults/run.py"))
from runs import Side, all_runs, cases


def python(*arguments):
    return subprocess.run([sys.executable, "-B", *map(str, arguments)], check=False, capture_output=True, text=True)


class Commands(TestCase):
    def test_commands_and_help_agree(self):
        text = (SOURCE / "dev").read_text()
        called = re.search(r"^  ([a-z |]+)\) name=\$1; shift; \"command_\$name\"", text, re.MULTILINE)[1].split(" | ")
        self.assertEqual(sorted(called), sorted(re.findall(r"^command_(\w+)\(\) \{", text, re.MULTILINE)))
        shown = subprocess.run([SOURCE / "dev", "--help"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(sorted(called), sorted(re.findall(r"^  (\w+) +[a-z]", shown, re.MULTILINE)))
        page = (SOURCE / "docs" / "developers" / "commands.md").read_text(encoding="utf-8")
        self.assertEqual(set(called), set(re.findall(r"^\| `\./dev (\w+)", page, re.MULTILINE)))
        benches = {script.parent.name for script in (SOURCE / "bench").glob("*/run.py")} - {"step"}
        self.assertEqual(benches, set(re.findall(r"^\| `\./dev bench (\w+)", page, re.MULTILINE)))

    def test_benchmarks(self):
        text = (SOURCE / "dev").read_text()
        for script in sorted((SOURCE / "bench").glob("*/run.py")):
            name = script.parent.name
            with self.subTest(name):
                self.assertIn(f"{name}_bench_packages=(", text)
                self.assertEqual(python(script, "--check").returncode, 0)
                refused = python(script, "--check", "--nonsense")
                self.assertEqual(refused.returncode, 2)
                self.assertIn("./dev bench" if name == "step" else f"./dev bench {name}", refused.stderr)


    def test_help_and_unknown_arguments(self):
        for name in ("build", "python", "demo", "viewer", "package", "docs", "format"):
            shown = subprocess.run([SOURCE / "dev", name, "--help"], check=True, capture_output=True, text=True).stdout
            self.assertRegex(shown, rf"^  {name} ")
            self.assertEqual(len(re.findall(r"(?m)^  [a-z]", shown)), 1)

    def test_the_page_has_the_faults(self):
        page = (SOURCE / "docs" / "developers" / "testing.md").read_text(encoding="utf-8")
        self.assertIn(f"\n\n{faults.table(faults.read_faults())}\n\n", page)


class Tiers(TestCase):
    """The arguments of ctest that options of `./dev test` and `./dev sanitize` amount to."""

    def arguments(self, *words):
        return tiers.ctest_arguments(*tiers.parse(words))

    def excluded(self, *words):
        found = self.arguments(*words)
        self.assertLessEqual(found.count("-LE"), 1, "of several, ctest takes the last")
        return found[found.index("-LE") + 1] if "-LE" in found else ""

    def test_long_tests_run_if_they_are_selected(self):
        for words, excluded in (((), "^long$"), (("--all",), ""), (("-R", "x"), ""), (("-L", "x"), ""), (("-E", "x"), "^long$"),
                                (("-LE", "a"), "^long$|a"), (("--all", "-LE", "a"), "a"), (("-LE", "a", "--all"), "a"),
                                (("-LE", "a", "-R", "x", "-LE", "b"), "a|b")):
            self.assertEqual(self.excluded("test", *words), excluded, words)

    def test_labels_of_tiers(self):
        for tier, label in (("mpi", "^distributed$"), ("sanitize-quick", "^sanitize$")):
            found = self.arguments(tier, "-R", "x", "-L", "y")
            self.assertEqual(found[found.index("-L"):][:4], ["-L", label, "-L", "y"])
        for tier in tiers.TIERS:
            self.assertIn("--no-tests=error", self.arguments(tier))

    def test_unknown_options_are_refused(self):
        for words in (("test", "--al"), ("test", "unit.mass"), ("test", "-LEx"), ("mpi", "--all"), ("sanitize", "--quik")):
            done = python(SOURCE / "tests" / "run.py", "--check", *words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(tiers.TIERS[words[0]].command, done.stderr)

    def test_a_skipped_test_needs_a_reason(self):
        log = "1/1 Testing: {}\nOK (skipped=1)\nTest time =   0.10 sec\nTest Passed.\n\"x"
        (self.folder / "log").write_text(log.format("end_to_end.completion"))
        (self.folder / "other").write_text(log.format("end_to_end.study"))
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            self.assertTrue(tiers.report(tiers.entries(self.folder / "log")))
            self.assertFalse(tiers.report(tiers.entries(self.folder / "other")))
        self.assertIn("end_to_end.completion: skipped=1: needs fish", printed.getvalue())
        self.assertIn("end_to_end.study: skipped=1: ERROR", printed.getvalue())


class Bits(TestCase):
    """Two trees of sources with the same program, and one case that differs by one rounding."""

    def tree(self, name, change=lambda text: text):
        root = self.folder / name
        (root / "cases").mkdir(parents=True)
        (root / "build").mkdir()
        (root / "build" / "ricochet").symlink_to(PROGRAM)
        for case in ("rod", "layer"):
            (root / "cases" / case).mkdir()
            for path in (SOURCE / "cases" / case).iterdir():
                if path.suffix in (".toml", ".msh", ".geo", ".csv"):
                    text = path.read_text()
                    (root / "cases" / case / path.name).write_text(change(text) if path.name == "rod.toml" else text)
        return Side(root)

    def test_one_rounding_is_found(self):
        changed = math.nextafter(1.0, 2.0)
        plain = self.tree("plain")
        other = self.tree("other", lambda text: re.sub(r"(?m)^density = 1.0$", f"density = {changed!r}", text))
        runs = [run for run in all_runs({case for case in cases(plain.root) if case.startswith("cases/")}, plain.program, ("1 thread", "resumed"), 40)
                if run.scheme in ("reduced-kane", "klr-conserving")]
        old, again, new = plain.results(runs), plain.results(runs), other.results(runs)
        self.assertEqual(bits.differences(runs, old, again), [])
        found = bits.differences(runs, old, new)
        self.assertEqual([line.split(" ")[0] for line in found], ["cases/rod/rod.toml"] * 4)
        for line in found:
            self.assertIn("history.csv", line)
            self.assertIn("last frame", line)
        self.assertTrue(all(result["status"] in (0, 5) and result["frame"] for result in old.values()))

    def test_a_case_of_one_side_is_a_difference(self):
        plain, other = self.tree("plain"), self.tree("other")
        (other.root / "cases" / "rod" / "rod.toml").unlink()
        runs = [run for run in all_runs({"cases/rod/rod.toml"}, plain.program, ("1 thread",), 10)
                if run.scheme == "reduced-kane"]
        line, = bits.differences(runs, plain.results(runs), other.results(runs))
        self.assertIn("-> no such case, status 0 -> -, ", line)

    def test_a_run_that_crashes_on_both_sides_is_named_and_not_kept(self):
        plain = self.tree("plain")
        (plain.root / "build" / "ricochet").unlink()
        plain.program.write_text("#!/bin/sh\nkill -SEGV $$\n")
        plain.program.chmod(0o755)
        runs = [run for run in all_runs({"cases/rod/rod.toml"}, PROGRAM, ("1 thread",), 10) if run.scheme == "newmark"]
        found = plain.results(runs)
        self.assertEqual(bits.differences(runs, found, found), [])
        self.assertEqual(bits.faults(found), ["cases/rod/rod.toml newmark (1 thread): ended with status -11"])
        bits.keep(self.folder / "results" / "kept.json", found)
        self.assertEqual((self.folder / "results" / "kept.json").read_text(), "{}")

    def test_a_run_without_end_is_stopped(self):
        plain = self.tree("plain")
        (plain.root / "build" / "ricochet").unlink()
        plain.program.write_text("#!/bin/sh\nsleep 600\n")
        plain.program.chmod(0o755)
        with unittest.mock.patch("runs.TIME_LIMIT", 0.2):
            self.assertEqual(plain.call([plain.program], [], 1.0)[0], "none within the time limit")

    def test_one_at_a_time(self):
        worktree = bits.revisions.Worktree("test")
        worktree.folder = self.folder / "build-test"
        worktree.lock()
        other = bits.revisions.Worktree("test")
        other.folder = worktree.folder
        with self.assertRaisesRegex(SystemExit, "another one is running"):
            other.lock()
        worktree.locked.close()
        other.locked.close()

    def test_nothing_to_compare_is_an_error(self):
        runs = all_runs(cases(SOURCE), PROGRAM, ("1 thread",), 10)
        self.assertEqual(len(bits.chosen(runs, ["rod.toml newmark"])), 1)
        for texts in (["no such case"], ["rod.toml newmark", "HEAD~3"]):
            with self.assertRaisesRegex(SystemExit, f'no run to compare whose name contains "{texts[-1]}"'):
                bits.chosen(runs, texts)
