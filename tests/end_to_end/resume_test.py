"""Runs that are interrupted in any way resume to the same bytes as uninterrupted ones.

    resume_test.py [KILLS]     # by default 50 kills, as in ./dev test
"""

import contextlib
import os
import random
import signal
import subprocess
import sys
import time
import unittest

import h5py

from harness import DISC, MESHES, SCHEMES, run, settings, summary_of, wait_for
from interrupted_runs import ResumeTestCase, busy, checkpoints, start

KILLS = 50


class Resume(ResumeTestCase):
    def test_killed_at_random_moments(self):
        """kill -9, then --resume, until the run has reached its end, for one scheme after the other."""
        seed = random.randrange(2**32)
        chance = random.Random(seed)
        kills, resumed, completed = 0, 0, 0
        while kills < KILLS or completed < len(SCHEMES):
            scheme = list(SCHEMES)[completed % len(SCHEMES)]
            values = busy(scheme)
            begun = time.monotonic()
            expected = self.reference(values)
            duration = time.monotonic() - begun if completed < len(SCHEMES) else duration
            output = self.folder / f"killed-{completed}"
            while True:
                process = start(self.disc, output, values, "--resume")
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(chance.uniform(0.0, max(0.7 * duration, 0.15)))
                alive = process.poll() is None
                process.kill()
                _, errors = process.communicate()
                kills += alive
                if not alive:
                    break
                resumed += len(checkpoints(output)) > 0
            self.assertEqual(process.returncode, 0, f"seed {seed}: {errors}")
            self.expect_same(expected, output)
            completed += 1
        print(f"{kills} kills, {resumed} with a checkpoint, {completed} runs", file=sys.stderr)
        self.assertGreater(resumed, kills // 4, f"seed {seed}")

    def test_stopped_by_signals(self):
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)):
            output = self.folder / f"stopped-{status}"
            values = {**busy("newmark"), "time.end": 0.5}
            del values["output.checkpoint_every"]
            expected = self.reference(values)
            process = start(self.disc, output, values)
            wait_for((output / "summary.json").exists)
            process.send_signal(number)
            time.sleep(0.02)
            process.send_signal(number)  # as `timeout` does
            text, errors = process.communicate()
            self.assertEqual(process.returncode, status, errors)
            self.assertIn("run --resume continues", text)
            summary = summary_of(output)
            self.assertEqual(summary["status"], "interrupted")
            # At the end of a step, with a checkpoint of it.
            self.assertEqual([int(path.stem.split("-")[1]) for path in checkpoints(output)], [summary["steps"]])
            rows = (output / "history.csv").read_text().splitlines()
            self.assertEqual(len(rows), summary["steps"] + 2)
            said = run("info", output).stdout
            self.assertIn("(interrupted)", said)
            self.assertIn(f"stopped by {number.name} after step {summary['steps']}", said)
            self.expect_status(0, run("run", self.disc, "-o", output, "--resume", "--quiet", "--threads", "2",
                                      *settings(values)))
            self.expect_same(expected, output)
            self.assertEqual(summary_of(output)["resumed_at"], [summary["steps"]])

    def test_stopped_while_it_starts(self):
        """This includes METIS, which catches SIGTERM while it orders a matrix."""
        mesh = self.folder / "fine.msh"
        subprocess.run(["gmsh", DISC.with_name("disc.geo"), "-2", "-clscale", "0.2", "-o", mesh, "-v", "0"], check=True)
        values = {"mesh.file": f'"{mesh}"', "time.end": 2, "output.fields_every": 0}
        begun = time.monotonic()
        process = start(self.disc, self.folder / "first", values)
        wait_for((self.folder / "first" / "summary.json").exists)
        duration = time.monotonic() - begun
        process.kill()
        process.communicate()
        chance = random.Random(1)
        for k in range(8):
            output = self.folder / f"early{k}"
            process = start(self.disc, output, values)
            time.sleep(chance.uniform(0.1, 1.0) * duration)
            process.send_signal(signal.SIGTERM)
            _, errors = process.communicate()
            self.assertEqual(process.returncode, 143, errors)
            if (output / "summary.json").exists():  # else there was nothing to keep yet
                self.assertEqual(summary_of(output)["status"], "interrupted")

    def test_a_second_signal_stops_at_once(self):
        output = self.folder / "out"
        process = start(self.disc, output, {"time.end": 100, "output.fields_every": 0})
        wait_for((output / "summary.json").exists)
        os.kill(process.pid, signal.SIGSTOP)
        os.waitpid(process.pid, os.WUNTRACED)
        os.kill(process.pid, signal.SIGINT)
        os.kill(process.pid, signal.SIGTERM)
        os.kill(process.pid, signal.SIGCONT)
        process.communicate()
        self.assertIn(process.returncode, (130, 143))
        self.assertEqual(checkpoints(output), [])
        self.assertEqual(summary_of(output)["status"], "running")

    def test_two_checkpoints_are_kept_and_a_damaged_one_is_not_taken(self):
        values = busy("klr-conserving")
        expected = self.reference(values)
        self.assertEqual([path.name for path in checkpoints(expected)],
                         ["checkpoint-000000760.ckpt", "checkpoint-000000800.ckpt"])
        content = checkpoints(expected)[1].read_bytes()
        damaged = [content[:-1], content[:100], b"", content[:5000] + b"x" + content[5001:], b"RICOCHET", content + b"0"]
        for k, bytes_left in enumerate(damaged):
            output = self.interrupted(values, f"damaged-{k}")
            checkpoints(output)[1].write_bytes(bytes_left)
            process = self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(values)))
            self.assertIn("cannot be used, the previous one is used", process.stderr)
            self.assertIn("checkpoint-000000800.ckpt", process.stderr)
            self.assertIn("resumed after step 760", process.stderr)
            self.expect_same(expected, output)
            self.assertIn("cannot be used", "".join(summary_of(output)["warnings"]))
        output = self.interrupted(values, "hopeless")
        for path in checkpoints(output):
            path.write_bytes(path.read_bytes()[:-1])
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("no checkpoint can be read", process.stderr)

    def test_killed_after_its_last_checkpoint(self):
        """The last frame is that of the last step, which the checkpoint has: it is not written again."""
        for form, every in (("xdmf", 8), ("vtkhdf", 8), ("xdmf", 7)):
            values = {**busy("newmark"), "output.format": form, "output.fields_every": every}
            output = self.interrupted(values, f"{form}-{every}")
            self.expect_status(0, run("run", self.disc, "-o", output, "--resume", "--quiet", *settings(values)))
            self.expect_same(self.reference(values), output)

    def test_goes_on_to_a_later_end(self):
        """The bytes are those of one run to that end, whatever an end writes."""
        for k, (scheme, more, ends) in enumerate((
                ("newmark", {}, (0.0413, 0.08)), ("midpoint", {"output.history_every": 3}, (0.02, 0.0405, 0.08)),
                ("klr-conserving", {"output.compression": 3}, (0.0401, 0.08)),
                ("semi-explicit", {"output.fields_every": 0}, (0.0401, 0.08)))):
            values = {**busy(scheme), **more}
            expected = self.reference(values)
            output = self.folder / f"longer-{k}"
            self.expect_status(0, run("run", self.disc, "-o", output, "--quiet", *settings({**values, "time.end": ends[0]})))
            for end in ends[1:]:
                self.assertEqual(summary_of(output)["status"], "done")
                self.expect_status(0, run("run", "--resume", output, "--quiet", "--set", f"time.end={end}"))
            self.expect_same(expected, output)
            steps = summary_of(output)["resumed_at"]
            self.assertEqual(steps, [round(end / 1e-4) for end in ends[:-1]])
        # Without settings of frames: as often as in the original run.
        values = busy("newmark")
        del values["output.fields_every"]
        output = self.simulate(self.disc, "began", {**values, "time.end": 0.02})
        with h5py.File(output / "results.h5") as file:
            before = len(file["frames"])
        self.expect_status(0, run("run", "--resume", output, "--quiet", "--set", "time.end=0.04"))
        with h5py.File(output / "results.h5") as file:
            self.assertAlmostEqual(len(file["frames"]), 2 * before, delta=2)
        # Backwards, and without the checkpoint.
        process = self.expect_status(2, run("run", "--resume", output, "--set", "time.end=0.03"))
        self.assertIn("time.end = 0.03 is before t = 0.04", process.stderr)
        for path in checkpoints(output):
            path.unlink()
        process = self.expect_status(2, run("run", "--resume", output, "--set", "time.end=0.05"))
        self.assertIn("cannot continue to a later time.end", process.stderr)

    def test_goes_on_with_what_the_contact_solver_has_learnt(self):
        """If the factorization was repeated at another scale: the costs of a rubber block on a turning wedge, by sweeps
        and by Newton's method, decide with which of them the next step begins."""
        wedge = self.write("wedge.txt", "-1 -1.5\n2 -1.6\n0.7 -0.02\n-1 -1.5\n")
        case = self.write("block.toml", f"""[mesh]
file = "{MESHES / 'quadrilateral_o1_msh41_ascii.msh'}"
plane = "stress"
degree = 2
refine = 2
[[material]]
group = "all"
density = 1.2
law = "neo-hookean"
young = 20.0
poisson = 0.45
[obstacle.wedge]
type = "surface"
file = "{wedge}"
rotation = "0.3*t"
about = [0.0, -1.0]
[[contact]]
group = "bottom"
obstacle = "wedge"
friction = 0.7
[initial]
velocity = [0.0, -0.2]
[time]
step = 0.05
end = 1.0
[output]
fields_every = 0
""")
        expected = self.simulate(case, "whole", {})
        for steps in (13, 15, 17):
            output = self.simulate(case, f"after-{steps}", {"time.end": 0.05 * steps})
            self.expect_status(0, run("run", "--resume", output, "--quiet", "--set", "time.end=1.0"))
            with self.subTest(steps=steps):
                self.assertEqual((expected / "history.csv").read_bytes(), (output / "history.csv").read_bytes())


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1].isdigit():
        KILLS = int(sys.argv.pop(1))
    unittest.main()
