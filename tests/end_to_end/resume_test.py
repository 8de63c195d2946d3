"""Runs that are interrupted, by anything, go on to the same bytes as one that never was.

    resume_test.py [KILLS] [--disk-full POINTS]     # by default 50 kills and 24 points, as in ./dev test
"""

import contextlib
import json
import os
import pathlib
import random
import resource
import signal
import struct
import subprocess
import sys
import time
import unittest
import zlib

import h5py

from harness import DISC, MESHES, PROGRAM, SCHEMES, TestCase, block_case, run, settings, with_more

KILLS = 50
FULL_DISKS = 24
RESULTS = {"history.csv", "results.h5", "results.xdmf", "obstacles.xdmf", "probes-3.csv"}

PROBES = """
[[probe]]
name = "ground"
contact = 0
[[probe]]
name = "body"
group = "body"
every = 3
"""

# What interrupted runs are made of: friction, a checkpoint often, a frame now and then.
BUSY = {"contact.0.friction": 0.3, "initial.velocity": "[0.03,-0.1]", "output.checkpoint_every": 40,
        "output.fields_every": 7, "time.end": 0.08}


def busy(scheme):
    values = dict(BUSY, **{"time.scheme": scheme, "mass.type": SCHEMES[scheme]})
    if scheme == "newmark":
        values["time.beta"] = 0.25
    return values


def start(case, output, values, *options, **more):
    command = [str(PROGRAM), "run", str(case), "-o", str(output), "--quiet", *options, *settings(values)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)


def wait_for(condition, seconds=60):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError("nothing has happened")
        time.sleep(0.002)


def checkpoints(output):
    return sorted(output.glob("checkpoint-*.ckpt"))


def extrema(output):
    return json.loads((output / "summary.json").read_text())["extrema"]


class Resume(TestCase):
    def setUp(self):
        super().setUp()
        self.disc = self.write("disc.toml", with_more(DISC, PROBES))

    def reference(self, values, case=None):
        name = f"reference-{abs(hash(str(sorted(map(str, values.items())))))}"
        if not (self.folder / name).exists():
            self.simulate(case or self.disc, name, values)
        return self.folder / name

    def expect_same(self, expected, found):
        for name in RESULTS & {path.name for path in expected.iterdir()}:
            self.assertEqual((expected / name).read_bytes(), (found / name).read_bytes(), f"{found}: {name}")
        self.assertEqual(extrema(expected), extrema(found))
        self.assertEqual(json.loads((found / "summary.json").read_text())["status"], "done")
        self.assertEqual(list(found.glob("*.new")) + list(found.glob("*.pattern")), [])

    def test_killed_at_random_moments(self):
        """kill -9, then --resume, until the run has come to its end, for one scheme after the other."""
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
            text, errors = process.communicate()
            self.assertEqual(process.returncode, status, errors)
            self.assertIn("run --resume goes on", text)
            summary = json.loads((output / "summary.json").read_text())
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
            self.assertEqual(json.loads((output / "summary.json").read_text())["resumed_at"], [summary["steps"]])

    def test_stopped_while_it_starts(self):
        """Also where METIS orders a matrix, which catches SIGTERM on its own account."""
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
                self.assertEqual(json.loads((output / "summary.json").read_text())["status"], "interrupted")

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
        self.assertEqual(json.loads((output / "summary.json").read_text())["status"], "running")

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
            self.assertIn("cannot be used, the one before is taken", process.stderr)
            self.assertIn("checkpoint-000000800.ckpt", process.stderr)
            self.assertIn("resumed after step 760", process.stderr)
            self.expect_same(expected, output)
            self.assertIn("cannot be used", "".join(json.loads((output / "summary.json").read_text())["warnings"]))
        output = self.interrupted(values, "hopeless")
        for path in checkpoints(output):
            path.write_bytes(path.read_bytes()[:-1])
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("no checkpoint can be read", process.stderr)

    def interrupted(self, values, name):
        """A run that was killed just before its end: what a complete one leaves but for its summary."""
        output = self.folder / name
        output.mkdir()
        for path in self.reference(values).iterdir():
            text = path.read_bytes()
            if path.name == "summary.json":
                text = text.replace(b'"status": "done"', b'"status": "running"')
            (output / path.name).write_bytes(text)
        return output

    def test_refuses_another_case_and_says_which_entry(self):
        values = busy("newmark")
        output = self.interrupted(values, "out")
        before = {path.name: path.read_bytes() for path in output.iterdir()}
        for key, value, names in (("time.step", 2e-4, "time.step was 0.0001, now it is 0.0002"),
                                  ("contact.0.friction", 0.2, "contact.0.friction was 0.3, now it is 0.2"),
                                  ("time.end", 0.07, "time.end = 0.07 comes before t = 0.08"),
                                  ("output.fields_every", 8, "output.fields_every was 7, now it is 8")):
            process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings({**values, key: value})))
            self.assertIn(names, process.stderr)
            self.assertIn("--set", process.stderr)
        self.assertEqual(before, {path.name: path.read_bytes() for path in output.iterdir()})
        # What does not decide results may change; and another way to write a number is no change.
        free = {**values, "title": "\"another\"", "output.checkpoint_every": 3, "time.step": "1.0e-4"}
        self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(free)))
        self.expect_same(self.reference(values), output)

    def test_refuses_another_version(self):
        """As if another version had written the checkpoint, and summary.json."""
        values = busy("newmark")
        output = self.interrupted(values, "out")
        version = json.loads((output / "summary.json").read_text())["ricochet_version"]
        other = version[:-1] + chr(ord(version[-1]) ^ 1)
        newest = checkpoints(output)[-1]
        content = newest.read_bytes()
        at = content.index(version.encode(), content.index(b"identity.version"))
        content = content[:at] + other.encode() + content[at + len(other):-4]
        newest.write_bytes(content + struct.pack("<I", zlib.crc32(content)))
        says = f"it ran with Ricochet {other}, this is {version}"
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn(says, process.stderr)
        for checkpoint in checkpoints(output):
            checkpoint.unlink()
        (output / "summary.json").write_text((output / "summary.json").read_text().replace(version, other))
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn(says, process.stderr)

    def test_refuses_another_mesh(self):
        mesh = self.folder / "block.msh"
        text = (MESHES / "quadrilateral_o1_msh41_ascii.msh").read_text()
        mesh.write_text(text)
        case = self.write("case.toml", block_case(mesh) + "[output]\ncheckpoint_every = 5\n")
        output = self.folder / "out"
        self.expect_status(0, run("run", case, "-o", output, "--quiet"))
        summary = output / "summary.json"
        summary.write_text(summary.read_text().replace('"status": "done"', '"status": "running"'))
        self.assertIn("1.5", text)
        mesh.write_text(text.replace("1.5 ", "1.5000001 "))
        process = self.expect_status(2, run("run", case, "-o", output, "--resume"))
        self.assertIn("the mesh has changed since it began (differences in: nodes)", process.stderr)
        mesh.write_text(text)
        self.expect_status(0, run("run", case, "-o", output, "--resume"))

    def test_nothing_to_resume(self):
        values = busy("newmark")
        expected = self.reference(values)
        # From the beginning where nothing is there; and nothing is done where the run is complete.
        output = self.folder / "new"
        process = self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("starts from the beginning", process.stderr)
        self.expect_same(expected, output)
        written = {path: path.stat().st_mtime_ns for path in output.iterdir()}
        process = self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("complete", process.stderr)
        self.assertEqual(written, {path: path.stat().st_mtime_ns for path in output.iterdir()})
        # What it is expected to hold is asked again.
        case = self.write("expecting.toml", self.disc.read_text() + '[[expect]]\nquantity = "history.time[-1]"\nvalue = 1.0\n'
                          'absolute = 0.1\n')
        self.expect_status(5, run("run", case, "-o", self.folder / "expecting", "--quiet", "--set", "output.fields_every=0"))
        process = self.expect_status(5, run("run", case, "-o", self.folder / "expecting", "--resume", "--quiet", "--set",
                                            "output.fields_every=0"))
        self.assertIn("DOES NOT HOLD: history.time[-1]", process.stdout)
        # Results that another program has changed are not gone on with.
        output = self.interrupted(values, "cut")
        (output / "history.csv").write_text("step\n")
        process = self.expect_status(4, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("history.csv: has 5 bytes", process.stderr)
        self.expect_status(1, run("run", self.disc, "-o", output, "--resume", "--force"))

    def test_refuses_results_that_were_changed(self):
        """And says which file and line; nothing is overwritten."""
        values = busy("newmark")
        expected = self.reference(values)
        history = (expected / "history.csv").read_bytes()
        lines = history.split(b"\n")
        obstacles = (expected / "obstacles.xdmf").read_bytes()
        side = (expected / "results.xdmf").read_bytes()
        probes = (expected / "probes-3.csv").read_bytes()
        fields = (expected / "results.h5").read_bytes()
        other = (self.reference({**values, "initial.velocity": "[0.03,-0.11]"}) / "results.h5").read_bytes()
        with h5py.File(expected / "results.h5") as file:
            at = file["/frames/000050/displacement"].id.get_offset()
        digit = lines[100][:-1] + bytes([lines[100][-1] ^ 1])
        for k, (name, content, says) in enumerate((
                ("history.csv", b"\n".join([*lines[:100], digit, *lines[101:]]), "lines 101 to 102 is|line 101 is"),
                ("history.csv", history.replace(b"total_energy", b"total_Energy", 1), "line 1 is|lines 1 to 2 is"),
                ("history.csv", history.replace(b"\n", b"\r\n"), "CR LF"),
                ("probes-3.csv", probes[:2000] + bytes([probes[2000] ^ 1]) + probes[2001:], "probes-3.csv: "),
                ("results.xdmf", side.replace(b"von_mises", b"von_Mises", 1), "results.xdmf: "),
                ("obstacles.xdmf", obstacles.replace(b"Float", b"float", 1), "obstacles.xdmf: "),
                ("results.h5", fields[:at] + bytes([fields[at] ^ 1]) + fields[at + 1:], "/frames/000050 is not what"),
                ("results.h5", other, "/frames/0000"))):
            output = self.interrupted(values, f"changed-{k}")
            self.assertNotEqual(content, (output / name).read_bytes(), f"{name} {k}")
            (output / name).write_bytes(content)
            before = {path.name: path.read_bytes() for path in output.iterdir()}
            process = self.expect_status(4, run("run", self.disc, "-o", output, "--resume", *settings(values)))
            self.assertIn(name, process.stderr)
            self.assertRegex(process.stderr, says)
            self.assertIn("--force", process.stderr)
            self.assertEqual(before, {path.name: path.read_bytes() for path in output.iterdir()})
        # What came after the checkpoint does not count.
        output = self.interrupted(values, "longer")
        checkpoints(output)[1].unlink()
        (output / "history.csv").write_bytes(b"\n".join(lines[:790]) + b"\n790,nonsense")
        self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.expect_same(expected, output)

    def test_refuses_compressed_and_single_results_that_were_changed(self):
        values = {**busy("newmark"), "output.fields_precision": "single", "output.compression": 6}
        expected = self.reference(values)
        output = self.interrupted(values, "same")
        checkpoints(output)[1].unlink()
        self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.expect_same(expected, output)
        output = self.interrupted(values, "changed")
        fields = bytearray((output / "results.h5").read_bytes())
        with h5py.File(output / "results.h5") as file:
            displacement = file["/frames/000020/displacement"]
            at = displacement.id.get_chunk_info(0).byte_offset if displacement.chunks else displacement.id.get_offset()
        fields[at + 20] ^= 1
        (output / "results.h5").write_bytes(fields)
        process = self.expect_status(4, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("/frames/000020", process.stderr)

    def test_checkpoints_of_another_format(self):
        values = busy("newmark")
        output = self.interrupted(values, "out")
        for path in checkpoints(output):
            content = bytearray(path.read_bytes())
            content[8:12] = struct.pack("<I", 1)
            path.write_bytes(content)
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("another version of the program wrote it (format 1, and this one reads format 2)", process.stderr)
        self.assertIn("--force", process.stderr)

    def test_goes_on_to_a_later_end(self):
        """The bytes of one run to that end, whatever is written at an end only."""
        for k, (scheme, more, ends) in enumerate((
                ("newmark", {}, (0.0413, 0.08)), ("midpoint", {"output.history_every": 3}, (0.02, 0.0405, 0.08)),
                ("klr-conserving", {"output.compression": 3}, (0.0401, 0.08)),
                ("semi-explicit", {"output.fields_every": 0}, (0.0401, 0.08)))):
            values = {**busy(scheme), **more}
            expected = self.reference(values)
            output = self.folder / f"longer-{k}"
            self.expect_status(0, run("run", self.disc, "-o", output, "--quiet", *settings({**values, "time.end": ends[0]})))
            for end in ends[1:]:
                self.assertEqual(json.loads((output / "summary.json").read_text())["status"], "done")
                self.expect_status(0, run("run", "--resume", output, "--quiet", "--set", f"time.end={end}"))
            self.expect_same(expected, output)
            steps = json.loads((output / "summary.json").read_text())["resumed_at"]
            self.assertEqual(steps, [round(end / 1e-4) for end in ends[:-1]])
        # Without a word on frames: as often as the run that began.
        values = busy("newmark")
        del values["output.fields_every"]
        output = self.simulate(self.disc, "began", {**values, "time.end": 0.02})
        with h5py.File(output / "results.h5") as file:
            before = len(file["frames"])
        self.expect_status(0, run("run", "--resume", output, "--quiet", "--set", "time.end=0.04"))
        with h5py.File(output / "results.h5") as file:
            self.assertAlmostEqual(len(file["frames"]), 2 * before, delta=2)
        # Backwards, and where the checkpoint is gone.
        process = self.expect_status(2, run("run", "--resume", output, "--set", "time.end=0.03"))
        self.assertIn("time.end = 0.03 comes before t = 0.04", process.stderr)
        for path in checkpoints(output):
            path.unlink()
        process = self.expect_status(2, run("run", "--resume", output, "--set", "time.end=0.05"))
        self.assertIn("cannot go on to a later time.end", process.stderr)

    def test_a_directory_knows_its_case(self):
        values = busy("newmark")
        expected = self.reference(values)
        for lost in ((), ("summary.json",)):
            output = self.interrupted(values, f"known{len(lost)}")
            checkpoints(output)[1].unlink()
            for name in lost:
                (output / name).unlink()
            self.expect_status(0, run("run", "--resume", output, directory="/"))
            self.expect_same(expected, output)
        # The case has changed, or is gone.
        output = self.interrupted(values, "known")
        text = self.disc.read_text()
        self.disc.write_text(text.replace("[load]", "[load]\nbody_force = [\"0\", \"-1\"]") if "[load]" in text
                             else text + "[load]\ngravity = [0.0, -1.0]\n")
        process = self.expect_status(2, run("run", "--resume", output))
        self.assertIn("the case has changed since this run began", process.stderr)
        self.disc.rename(self.folder / "elsewhere.toml")
        process = self.expect_status(4, run("run", "--resume", output))
        self.assertIn(f"its case file {self.disc} is not there any more", process.stderr)
        self.assertIn("ricochet run CASE.toml", process.stderr)
        empty = self.folder / "empty"
        empty.mkdir()
        self.assertIn("no run is in this directory", self.expect_status(4, run("run", "--resume", empty)).stderr)
        self.expect_status(1, run("run", "--resume"))
        self.expect_status(1, run("run"))
        self.expect_status(1, run("run", "--resume", output, "-o", empty))

    def test_results_of_nobody_knows_what_are_not_overwritten(self):
        """Nothing in the directory says that they are of this case: a job that ran before must not be lost."""
        values = busy("newmark")
        for k, summary in enumerate((None, "", "{}")):
            output = self.folder / f"foreign{k}"
            output.mkdir()
            (output / "history.csv").write_text("step,time\n0,0\n")
            if summary is not None:
                (output / "summary.json").write_text(summary)
            process = self.expect_status(4, run("run", self.disc, "-o", output, "--resume", *settings(values)))
            self.assertIn("neither a checkpoint nor a summary.json", process.stderr)
            self.assertEqual((output / "history.csv").read_text(), "step,time\n0,0\n")

    def test_one_run_at_a_time(self):
        output = self.folder / "out"
        process = start(self.disc, output, {"time.end": 100})
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        wait_for((output / "summary.json").exists)
        for option in ("--force", "--resume", "--quiet"):
            second = self.expect_status(4, run("run", self.disc, "-o", output, option, "--set", "time.end=100"))
            self.assertIn("another run is writing into this directory", second.stderr)
        self.assertIn("running", run("info", output).stdout)
        self.assertIsNone(process.poll())

    def fill_disk(self, output, values, limit):
        """Files cannot grow beyond a limit: what a write to a full disk gives, at a place that can be chosen."""
        return start(self.disc, output, values, "--resume",
                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY)))

    def test_full_disk_by_file_size(self):
        """history.csv, results.h5, a checkpoint: whichever reaches the limit first."""
        failed = set()
        for scheme in ("newmark", "semi-explicit"):
            values = busy(scheme)
            expected = self.reference(values)
            largest = max(path.stat().st_size for path in expected.iterdir())
            for k in range(FULL_DISKS // 4):
                output = self.folder / f"full-{scheme}-{k}"
                process = self.fill_disk(output, values, 20_000 + (largest - 30_000) * k // (FULL_DISKS // 4))
                _, errors = process.communicate()
                self.assertEqual(process.returncode, 4, errors)
                self.assertIn("File too large", errors)
                failed.update(name for name in ("history.csv", "results.h5", "results.xdmf", "ckpt") if name in errors)
                said = run("info", output).stdout  # the summary still has its place
                self.assertIn("(FAILED)", said)
                self.assertIn("File too large", said)
                self.expect_status(0, run("run", self.disc, "-o", output, "--resume", "--quiet", *settings(values)))
                self.expect_same(expected, output)
        self.assertLessEqual({"results.h5"}, failed)

    @contextlib.contextmanager
    def small_disk(self, kilobytes):
        place = self.folder / "disk"
        place.mkdir(exist_ok=True)
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", place],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            self.skipTest(f"no small disk can be mounted here: {done.stderr.strip()}")
        try:
            yield place
        finally:
            subprocess.run(["umount", place], check=True)

    def test_full_disk(self):
        """A disk that is too small by a little more every time; once it is larger the run goes on."""
        failed = {}
        for k in range(FULL_DISKS // 2):
            # Without fields it is the history or a checkpoint that finds the disk full.
            values = busy("newmark") if k % 2 == 0 else {
                **busy("newmark"), "output.fields_every": 0, "output.checkpoint_every": 300}
            expected = self.reference(values)
            needed = sum(path.stat().st_size for path in expected.iterdir()) // 1024
            size = 20 + (needed - 20) * k // (FULL_DISKS // 2)
            with self.small_disk(size) as place:
                output = place / "out"
                process = run("run", self.disc, "-o", output, "--quiet", *settings(values))
                self.expect_status(4, process)
                self.assertIn("No space left on device", process.stderr)
                name = process.stderr.strip().splitlines()[-1].split(":")[1].strip()
                failed[k, size] = pathlib.Path(name).name
                # What is there can be looked at.
                if (output / "results.xdmf").exists() and (output / "results.xdmf").stat().st_size > 0:
                    self.assertIn("</Xdmf>", (output / "results.xdmf").read_text())
                subprocess.run(["mount", "-o", f"remount,size={3 * needed}k", place], check=True)
                self.expect_status(0, run("run", self.disc, "-o", output, "--resume", "--quiet", *settings(values)))
                self.expect_same(expected, output)
        print(f"full at {failed}", file=sys.stderr)
        self.assertLessEqual({"history.csv", "results.h5"}, set(failed.values()))

    def test_read_only_directory(self):
        with self.small_disk(1000) as place:
            output = place / "out"
            output.mkdir()
            subprocess.run(["mount", "-o", "remount,ro", place], check=True)
            for where in (output, place / "another"):
                process = self.expect_status(4, run("run", self.disc, "-o", where))
                self.assertIn("Read-only file system", process.stderr)

    def test_directory_of_someone_else(self):
        output = self.folder / "out"
        output.mkdir()
        output.chmod(0o555)
        if os.geteuid() == 0:
            self.skipTest("root may write anywhere")
        process = self.expect_status(4, run("run", self.disc, "-o", output))
        self.assertIn("Permission denied", process.stderr)


if __name__ == "__main__":
    arguments = sys.argv[1:]
    if "--disk-full" in arguments:
        at = arguments.index("--disk-full")
        FULL_DISKS = int(arguments[at + 1])
        del arguments[at:at + 2]
    if arguments and arguments[0].isdigit():
        KILLS = int(arguments.pop(0))
    unittest.main(argv=[sys.argv[0], *arguments])
