"""Refusals of `--resume`: another case, mesh or version, results that were changed, a directory that is in use."""

import struct
import zlib

import h5py

from harness import MESHES, block_case, run, settings, summary_of, wait_for
from interrupted_runs import ResumeTestCase, busy, checkpoints, start


class Refusals(ResumeTestCase):
    def test_refuses_another_case_and_says_which_entry(self):
        values = busy("newmark")
        output = self.interrupted(values, "out")
        before = {path.name: path.read_bytes() for path in output.iterdir()}
        for key, value, names in (("time.step", 2e-4, "time.step was 0.0001, now it is 0.0002"),
                                  ("contact.0.friction", 0.2, "contact.0.friction was 0.3, now it is 0.2"),
                                  ("time.end", 0.07, "time.end = 0.07 is before t = 0.08"),
                                  ("output.fields_every", 8, "output.fields_every was 7, now it is 8")):
            process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings({**values, key: value})))
            self.assertIn(names, process.stderr)
            self.assertIn("--set", process.stderr)
        self.assertEqual(before, {path.name: path.read_bytes() for path in output.iterdir()})
        # Settings that do not decide results may change; another spelling of a number is no change.
        free = {**values, "title": "\"another\"", "output.checkpoint_every": 3, "time.step": "1.0e-4"}
        self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(free)))
        self.expect_same(self.reference(values), output)

    def test_refuses_another_version(self):
        """As if another version had written the checkpoint and summary.json."""
        values = busy("newmark")
        output = self.interrupted(values, "out")
        version = summary_of(output)["ricochet_version"]
        other = version[:-1] + chr(ord(version[-1]) ^ 1)
        newest = checkpoints(output)[-1]
        content = newest.read_bytes()
        at = content.index(version.encode(), content.index(b"identity.version"))
        content = content[:at] + other.encode() + content[at + len(other):-4]
        newest.write_bytes(content + struct.pack("<I", zlib.crc32(content)))
        says = f"it ran with Ricochet {other}, this is {version}"
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn(says, process.stderr)
        # Nothing else is said to differ, and nothing is to be restored.
        self.assertIn("Continue it with the version that began it, start anew", process.stderr)
        for word in ("the case has changed", "estore"):
            self.assertNotIn(word, process.stderr)
        for checkpoint in checkpoints(output):
            checkpoint.unlink()
        (output / "summary.json").write_text((output / "summary.json").read_text().replace(version, other))
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn(says, process.stderr)
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values | {"output.history_every": 3})))
        for words in (says + "; the case has changed since this run began:\n", "output.history_every was ",
                      "Continue it with the version that began it and restore the case (including --set), start anew"):
            self.assertIn(words, process.stderr)

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

    def test_refuses_results_that_were_changed(self):
        """The message names file and line; nothing is overwritten."""
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
                ("history.csv", b"\n".join([*lines[:100], digit, *lines[101:]]), "lines 101 to 102 differs|line 101 differs"),
                ("history.csv", history.replace(b"total_energy", b"total_Energy", 1), "line 1 differs|lines 1 to 2 differs"),
                ("history.csv", history.replace(b"\n", b"\r\n"), "carriage returns"),
                ("probes-3.csv", probes[:2000] + bytes([probes[2000] ^ 1]) + probes[2001:], "probes-3.csv: "),
                ("results.xdmf", side.replace(b"von_mises", b"von_Mises", 1), "results.xdmf: "),
                ("obstacles.xdmf", obstacles.replace(b"Float", b"float", 1), "obstacles.xdmf: "),
                ("results.h5", fields[:at] + bytes([fields[at] ^ 1]) + fields[at + 1:], "/frames/000050 differs from"),
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
        # Results after the checkpoint do not count.
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

    def test_nothing_to_resume(self):
        values = busy("newmark")
        expected = self.reference(values)
        # It starts from the beginning if nothing exists; nothing is done if the run is complete.
        output = self.folder / "new"
        process = self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("starts from the beginning", process.stderr)
        self.expect_same(expected, output)
        written = {path: path.stat().st_mtime_ns for path in output.iterdir()}
        process = self.expect_status(0, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("complete", process.stderr)
        self.assertEqual(written, {path: path.stat().st_mtime_ns for path in output.iterdir()})
        # Its expectations are evaluated again.
        case = self.write("expecting.toml", self.disc.read_text() + '[[expect]]\nquantity = "history.time[-1]"\nvalue = 1.0\n'
                          'absolute = 0.1\n')
        self.expect_status(5, run("run", case, "-o", self.folder / "expecting", "--quiet", "--set", "output.fields_every=0"))
        process = self.expect_status(5, run("run", case, "-o", self.folder / "expecting", "--resume", "--quiet", "--set",
                                            "output.fields_every=0"))
        self.assertIn("DOES NOT HOLD: history.time[-1]", process.stdout)
        # Results that another program has changed are not resumed.
        output = self.interrupted(values, "cut")
        (output / "history.csv").write_text("step\n")
        process = self.expect_status(4, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("history.csv: has 5 bytes", process.stderr)
        self.expect_status(1, run("run", self.disc, "-o", output, "--resume", "--force"))

    def test_checkpoints_of_another_format(self):
        values = busy("newmark")
        output = self.interrupted(values, "out")
        for path in checkpoints(output):
            content = bytearray(path.read_bytes())
            content[8:12] = struct.pack("<I", 1)
            path.write_bytes(content)
        process = self.expect_status(2, run("run", self.disc, "-o", output, "--resume", *settings(values)))
        self.assertIn("written by another version of Ricochet (format 1)", process.stderr)
        self.assertIn("--force", process.stderr)

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
        self.assertIn(f"its case file {self.disc} no longer exists", process.stderr)
        self.assertIn("ricochet run CASE.toml", process.stderr)
        empty = self.folder / "empty"
        empty.mkdir()
        self.assertIn("no run in this directory", self.expect_status(4, run("run", "--resume", empty)).stderr)
        self.expect_status(1, run("run", "--resume"))
        self.expect_status(1, run("run"))
        self.expect_status(1, run("run", "--resume", output, "-o", empty))

    def test_results_of_nobody_knows_what_are_not_overwritten(self):
        """Nothing in the directory states that they belong to this case: results of an earlier job must not be lost."""
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
