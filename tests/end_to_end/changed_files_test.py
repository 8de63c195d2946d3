"""Another program changes a file that a run is writing: the run stops with a message, and nothing is lost silently."""

import subprocess

from harness import PROGRAM, TestCase, block_case, run, settings, summary_of, wait_for

ENDLESS = {"time.end": 1e4, "output.fields_every": 20, "output.checkpoint_every": 100}


def cut(path):
    with path.open("r+b") as file:
        file.truncate(500)


def lengthen(path):
    with path.open("ab") as file:
        file.write(b"a line of somebody else\n")


def replace(path):
    other = path.with_name("other")
    other.write_bytes(path.read_bytes())
    other.replace(path)


class ChangedFiles(TestCase):
    def changed(self, name, change, more=()):
        """Runs while a file is changed. Returns its directory, the status and the messages."""
        output = self.folder / f"{change.__name__}-{name}"
        process = subprocess.Popen([PROGRAM, "run", self.case, "-o", output, "--quiet", *settings(ENDLESS | dict(more))],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        path = output / name
        wait_for(lambda: path.exists() and path.stat().st_size > 20000 and list(output.glob("checkpoint-*.ckpt")))
        change(path)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 4, f"{output.name}: {said}")
        self.assertIn(f"{path}: ", said)
        # In the middle of a frame HDF5 fails.
        self.assertRegex(said, r"another program has changed it|has another program changed the file\?")
        summary = summary_of(output)
        self.assertEqual(summary["status"], "failed")
        self.assertIn(name, summary["message"])
        return output, said

    def setUp(self):
        super().setUp()
        self.case = self.write("block.toml", block_case() + '[[probe]]\nname = "often"\nat = [0.0, 0.0]\nevery = 1\n')

    def test_text(self):
        output, said = self.changed("history.csv", cut)
        self.assertRegex(said, r"has 500 bytes, but this run has written \d+")
        # The remaining results are those written before, without gaps.
        self.assertEqual((output / "history.csv").stat().st_size, 500)
        refused = self.expect_status(4, run("run", "--resume", output, "--quiet"))
        self.assertIn("history.csv: has 500 bytes", refused.stderr)
        self.changed("history.csv", lengthen)
        _, said = self.changed("history.csv", replace)
        self.assertIn("is not the file that this run has been writing", said)
        _, said = self.changed("probes-1.csv", lambda path: path.unlink())
        self.assertIn("no longer exists", said)

    def test_fields(self):
        for file_format, names in (("xdmf", ("results.h5", "results.xdmf", "obstacles.xdmf")),
                                   ("vtkhdf", ("results.vtkhdf", "obstacles.vtkhdf"))):
            for name in names:
                self.changed(name, cut, {"output.format": file_format})

    def test_readers_change_nothing(self):
        """A reader that only changes the access time does not stop the run."""
        output = self.folder / "watched"
        process = subprocess.Popen([PROGRAM, "run", self.case, "-o", output, "--quiet", *settings(ENDLESS | {"time.end": 60})],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        wait_for(lambda: (output / "history.csv").exists() and list(output.glob("checkpoint-*.ckpt")))
        while process.poll() is None:
            for path in output.iterdir():
                if path.name.startswith(("history", "results")):
                    path.read_bytes()
                    path.touch()
            run("info", output)
        self.assertEqual(process.returncode, 0, process.stderr.read())
