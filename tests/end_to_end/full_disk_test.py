"""Runs whose disk is full, or that may not write: an error that states this, and the run resumes once there is space.

    full_disk_test.py [POINTS]     # by default 24 points at which the disk is full, as in ./dev test
"""

import contextlib
import pathlib
import resource
import subprocess
import sys
import unittest

from harness import RESPECTS_MODES, run, settings
from interrupted_runs import ResumeTestCase, busy, start

FULL_DISKS = 24


class FullDisk(ResumeTestCase):
    def fill_disk(self, output, values, limit):
        """Prevents files from growing beyond a limit, which has the effect of a full disk at a selectable point."""
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
                said = run("info", output).stdout  # the summary still has space
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
        """A disk that is too small by a little more every time; once it is larger, the run resumes."""
        failed = {}
        for k in range(FULL_DISKS // 2):
            # Without fields the history or a checkpoint finds the disk full.
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
                # Existing results can be read.
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
        process = self.expect_status(4, run("run", self.disc, "-o", output, before=RESPECTS_MODES))
        self.assertIn("Permission denied", process.stderr)


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1].isdigit():
        FULL_DISKS = int(sys.argv.pop(1))
    unittest.main()
