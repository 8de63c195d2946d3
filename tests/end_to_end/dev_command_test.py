"""`./dev`: its help and docs/developers/commands.md list all commands, its benchmarks refuse wrong options before
anything is compiled, and its gate for bits finds a change of one rounding."""

import math
import re
import subprocess
import sys
import unittest
import unittest.mock

from harness import PROGRAM, SOURCE, TestCase

sys.path.insert(0, str(SOURCE / "tests" / "bits"))
import run as bits
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
            self.assertEqual(plain.call([plain.program], [], 1.0), "none within the time limit")

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
        with self.assertRaisesRegex(SystemExit, "no run to compare"):
            bits.chosen(runs, ["no such case"])


if __name__ == "__main__":
    unittest.main()
