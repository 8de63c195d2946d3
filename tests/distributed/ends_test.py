"""Ends of ricochet-mpi: errors and kills of one process, signals, full disks, and refusals."""

import os
import resource
import shutil
import signal
import subprocess
import time
import unittest

from launched import BOUNCE, MPIRUN, PROGRAM, Distributed, own_lines, processes_of, several
from harness import DISC, SOURCE, TIME_LIMIT, block_case, run, settings, wait_for, with_more


class Ends(Distributed):
    LONG = BOUNCE | {"time.end": 0.3}

    def finish(self, ranks, name):
        finished = several(ranks, "run", "--resume", self.folder / name, "--quiet")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual(self.summary(name)["status"], "done")

    def test_of_one_process_are_those_of_all(self):
        """kill -9 of any rank ends all within seconds, and the run resumes to the same bits."""
        self.assertEqual(self.bounce(3, "whole", values=self.LONG).returncode, 0)
        for victim in range(3):
            name = f"killed-{victim}"
            process = self.start(3, name, self.LONG)
            manifests = lambda: list((self.folder / name / "ranks").glob("*.manifest"))  # noqa: E731
            wait_for(lambda: manifests() or process.poll() is not None)
            ranks = processes_of(process)
            self.assertEqual(len(ranks), 3)
            begun = time.monotonic()
            os.kill(ranks[victim], signal.SIGKILL)
            process.communicate(timeout=30)
            self.assertLess(time.monotonic() - begun, 15.0)
            self.assertNotEqual(process.returncode, 0)
            self.finish(3, name)
            self.expect_same_files("whole", name)

    def test_of_an_error_that_one_process_finds(self):
        """A load without a value where one process has cells: all end within seconds, with one message."""
        begin = time.monotonic()
        values = {**BOUNCE, "load.body_force": '["x > 0.0195 && t > 0.01 ? sqrt(-1) : 0", "0"]'}
        finished = self.bounce(3, "lost", values=values)
        self.assertLess(time.monotonic() - begin, 20)
        self.assertNotEqual(finished.returncode, 0)
        self.assertIn("has no finite value at x = ", finished.stderr)
        self.assertIn("step ", finished.stderr)

    def test_of_an_expected_result_that_does_not_come(self):
        """Only the first process compares: all end with its status, and one message."""
        case = self.write("wrong.toml", with_more(DISC, '[[expect]]\nquantity = "max(history.total_energy)"\nmaximum = 0.0\n')
                          .replace("end = 0.15", "end = 0.001"))
        finished = several(2, "run", case, "-o", self.folder / "wrong", "--quiet")
        self.assertEqual(finished.returncode, 5, finished.stderr)
        self.assertEqual(len(own_lines(finished.stderr)), 1, finished.stderr)
        self.assertIn("expected max(history.total_energy) to be", finished.stderr)
        self.assertNotIn("MPI_ABORT", finished.stderr)

    def test_by_a_signal_leave_a_checkpoint(self):
        self.assertEqual(self.bounce(2, "whole", values=self.LONG).returncode, 0)
        process = self.start(2, "stopped", self.LONG | {"output.checkpoint_every": 1000000})
        history = self.folder / "stopped" / "history.csv"
        wait_for(lambda: (history.exists() and history.stat().st_size > 20000) or process.poll() is not None)
        # It arrives in a long step.
        one, other = processes_of(process)
        os.kill(one, signal.SIGSTOP)
        os.kill(other, signal.SIGTERM)
        time.sleep(2.5)
        self.assertIsNone(process.poll())
        os.kill(one, signal.SIGCONT)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 128 + signal.SIGTERM)
        self.assertEqual(self.summary("stopped")["status"], "interrupted")
        self.assertIn("mpirun -n 2 ricochet-mpi run --resume", self.summary("stopped")["message"])
        described = run("info", self.folder / "stopped").stdout
        self.assertIn(f"checkpoint of step {self.summary('stopped')['checkpoint_step']}: ", described)
        self.assertIn("`mpirun -n 2 ricochet-mpi run` with --resume continues it", described)
        (self.folder / "stopped" / "summary.json").unlink()  # checkpoints state the case as well
        self.assertIn("summary.json is missing", run("info", self.folder / "stopped").stdout)
        finished = several(2, "run", "--resume", self.folder / "stopped", "--quiet")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual((self.folder / "whole" / "history.csv").read_bytes(), history.read_bytes())

    def test_at_a_full_disk(self):
        """Results that cannot grow: one message within seconds, and the earlier results can be resumed."""
        process = self.start(2, "full", self.LONG)
        manifests = lambda: list((self.folder / "full" / "ranks").glob("*.manifest"))  # noqa: E731
        wait_for(lambda: manifests() or process.poll() is not None)
        first = min(processes_of(process))
        resource.prlimit(first, resource.RLIMIT_FSIZE, (100_000, 100_000))
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 4, errors)
        self.assertEqual(len(own_lines(errors)), 1, errors)
        self.finish(2, "full")

    def test_of_a_damaged_checkpoint(self):
        self.assertEqual(self.bounce(2, "whole").returncode, 0)
        shutil.copytree(self.folder / "whole", self.folder / "damaged")
        summary = self.folder / "damaged" / "summary.json"
        summary.write_text(summary.read_text().replace('"status": "done"', '"status": "running"'))
        newest = sorted((self.folder / "damaged" / "ranks" / "0001").glob("*.ckpt"))[-1]
        newest.write_bytes(newest.read_bytes()[:-100])
        finished = several(2, "run", "--resume", self.folder / "damaged", "--quiet")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual(finished.stderr.count(f"{newest.name}: its checksum differs from that in the manifest"), 1, finished.stderr)
        self.expect_same_files("whole", "damaged")
        # If no checkpoint can be read, the run is not started anew.
        for damaged in (self.folder / "damaged" / "ranks" / "0001").glob("*.ckpt"):
            damaged.write_bytes(damaged.read_bytes()[:-100])
        summary.write_text(summary.read_text().replace('"status": "done"', '"status": "running"'))
        finished = several(2, "run", "--resume", self.folder / "damaged", "--quiet")
        self.assertEqual(finished.returncode, 2, finished.stderr)
        self.assertEqual(len(own_lines(finished.stderr)), 1, finished.stderr)
        self.assertIn("no checkpoint can be read; start anew with --force", finished.stderr)
        self.expect_same_files("whole", "damaged")


class Refusals(Distributed):
    def expect(self, finished, status, *words):
        self.assertEqual(finished.returncode, status, finished.stderr)
        lines = own_lines(finished.stderr)
        self.assertEqual(len(lines), 1, finished.stderr)
        for word in words:
            self.assertIn(word, lines[0])

    def test_name_what_cannot_be_divided(self):
        for case, words in {"ball-block/ball-block": ("contact between bodies",), "balloon/balloon": ("finite strain",)}.items():
            path = SOURCE / "cases" / (case + ".toml")
            finished = several(2, "run", path, "-o", self.folder / "refused")
            self.expect(finished, 2, f"{path.name}:", *words)
            self.assertFalse((self.folder / "refused" / "summary.json").exists())
        for values, words in (({"solver.method": "direct"}, ("factor",)),
                              ({"time.scheme": "laursen-love", "mass.type": "consistent"}, ("laursen-love",))):
            self.expect(self.bounce(2, "refused", values=values), 2, *words)

    def test_of_bad_input_come_once(self):
        self.expect(self.bounce(3, "bad", values={"material.0.density": -1.0}), 2, "density")
        self.expect(several(2, "run", self.folder / "none.toml"), 4, "none.toml")
        (self.folder / "taken").write_text("a file")
        self.expect(self.bounce(3, "taken"), 4, "taken", "cannot create this directory")
        few = self.write("few.toml", block_case())
        self.expect(several(30, "run", few, "-o", self.folder / "few"), 2, "few.toml:", "too few for 30 processes")

    def test_of_a_body_inside_of_an_obstacle_count_all_of_it(self):
        case = self.write("block.toml", block_case())

        def start_at(height, ranks, name):
            arguments = ["run", case, "-o", self.folder / name, "--quiet", "--set",
                         f"obstacle.floor.point=[0.1,{0.2 + height}]", "--set", "obstacle.floor.normal=[0.1,1.2]",
                         "--set", "solver.method=iterative", "--set", "time.end=0.05"]
            return several(ranks, *arguments) if ranks > 1 else run(*arguments)
        alone = start_at(0.05, 1, "deep")
        self.assertEqual(alone.returncode, 2)
        self.expect(start_at(0.05, 3, "deep"), 2, alone.stderr.split("deep: ", 1)[-1].strip().removeprefix("ricochet: "))
        for ranks, name in ((1, "one"), (3, "three")):
            self.assertEqual(start_at(5e-4, ranks, name).returncode, 0)
        self.assertTrue(any("inside an obstacle" in warning for warning in self.summary("one")["warnings"]))
        self.assertEqual(self.summary("three")["warnings"], self.summary("one")["warnings"])

    def test_of_cases_that_processes_do_not_share(self):
        """Each process is in a folder of its own."""
        case = self.disc.read_text().replace('file = "', f'file = "{self.disc.parent}/')
        for name in ("a", "b"):
            (self.folder / name).mkdir()
            (self.folder / name / "case.toml").write_text(case)
        arguments = ["run", "case.toml", "-o", self.folder / "run", "--quiet"]

        def run_two():
            apart = [MPIRUN]
            for name in ("a", "b"):
                apart += ["-n", "1", "-wdir", str(self.folder / name), PROGRAM, *map(str, arguments), ":"]
            return subprocess.run(apart[:-1], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, timeout=TIME_LIMIT)
        (self.folder / "b" / "case.toml").write_text(case + "# another\n")
        self.expect(run_two(), 4, "case.toml", "process 1 of 2 reads a text that differs")
        (self.folder / "b" / "case.toml").unlink()
        self.expect(run_two(), 4, "case.toml", "process 1 of 2 cannot read it")
        bad = several(2, "walk")
        self.assertEqual(bad.returncode, 1)
        self.assertEqual(bad.stderr.count("Run with --help"), 1, bad.stderr)
        self.assertEqual(several(2, "--version").stdout.count("ricochet-mpi "), 1)

    def test_of_other_numbers_of_processes(self):
        values = BOUNCE | {"output.checkpoint_every": 100}
        self.assertEqual(self.bounce(2, "two", values=values).returncode, 0)
        longer = settings({"time.end": 0.08})
        self.expect(several(3, "run", "--resume", self.folder / "two", *longer), 2, "2 processes")
        alone = run("run", "--resume", self.folder / "two", *longer)
        self.assertEqual(alone.returncode, 2)
        self.assertIn("mpirun -n 2 ricochet-mpi", alone.stderr)
        self.assertEqual(self.bounce(0, "one", values=values).returncode, 0)
        self.expect(several(2, "run", "--resume", self.folder / "one", *longer), 2, "one process", "ricochet run --resume")
        finished = several(2, "run", "--resume", self.folder / "two", "--quiet", *longer)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.expect(self.bounce(2, "two"), 4, "already holds a run")
        self.assertEqual(self.bounce(2, "two", "--force", values=values).returncode, 0)


if __name__ == "__main__":
    unittest.main()
