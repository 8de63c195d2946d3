"""A report's page, unpacked independently of the viewer. Shared by the tests of its data and of its texts."""

import base64
import json
import re
import shutil
import subprocess
import zlib

import numpy

from harness import PROGRAM, TIME_LIMIT, TestCase, run

VIEWER = ("<!doctype html><!-- ricochet report --><!-- data format 6 --><html><body><p>a viewer</p><!--RICOCHET-DATA--><script>$&\\1</script>"
          "</body></html>\n")
SHORT = {"time.end": 0.02, "output.fields_every": 10}


class Page:
    """The data of a report, read according to the description of the format."""

    def __init__(self, path):
        self.text = path.read_text(encoding="utf-8")
        scripts = dict(re.findall(r'<script type="[^"]*" id="([^"]*)">(.*?)</script>', self.text, re.DOTALL))
        self.runs = json.loads(scripts["ricochet-runs"])["runs"]
        self.blobs = [zlib.decompress(base64.b64decode(scripts[f"ricochet-blob-{i}"], validate=True))
                      for i in range(len(scripts) - 1)]

    def reals(self, array):
        raw = numpy.frombuffer(self.blobs[array["blob"]], dtype=numpy.uint8).reshape(8, -1).T
        words = numpy.bitwise_xor.accumulate(numpy.ascontiguousarray(raw).view("<u8").ravel())
        return words.view(numpy.float64).reshape(array["rows"], array["columns"])

    def indices(self, array):
        raw = numpy.frombuffer(self.blobs[array["blob"]], dtype=numpy.uint8).reshape(4, -1).T
        code = numpy.ascontiguousarray(raw).view("<u4").ravel().astype(numpy.int64)
        return numpy.cumsum(numpy.where(code & 1, -(code >> 1) - 1, code >> 1))

    def levels(self, array):
        rows, columns, bits = array["rows"], array["columns"], array["bits"]
        planes = 2 if bits > 8 else 1
        raw = numpy.frombuffer(self.blobs[array["blob"]], dtype=numpy.uint8).reshape(rows, planes, columns)
        code = raw[:, 0].astype(numpy.int64) + (raw[:, 1].astype(numpy.int64) << 8 if planes == 2 else 0)
        change = numpy.where(code & 1, -(code >> 1) - 1, code >> 1)
        levels = numpy.zeros((rows, columns), dtype=numpy.int64)
        for r in range(rows):
            own = numpy.cumsum(change[r]) if r == 0 or array["prediction"] == 2 else change[r]
            levels[r] = ((levels[r - 1] if r > 0 else 0) + own) % (1 << bits)
        values = array["low"] + array["step"] * levels
        values[levels == (1 << bits) - 1] = numpy.nan
        return values


class ReportTestCase(TestCase):
    def setUp(self):
        super().setUp()
        # A program with a viewer of its own, as in an installation.
        (self.folder / "bin").mkdir()
        (self.folder / "share" / "ricochet").mkdir(parents=True)
        self.program = shutil.copy2(PROGRAM, self.folder / "bin" / "ricochet")
        self.viewer = self.write("share/ricochet/viewer.html", VIEWER)

    def simulate(self, case, name, values):
        settings = [part for key, value in values.items() for part in ("--set", f"{key}={value}")]
        process = run("run", case, "-o", self.folder / name, "--quiet", "--log-level", "error", *settings)
        self.assertEqual(process.returncode, 0, process.stderr)
        return self.folder / name

    def report(self, *arguments, status=0):
        process = subprocess.run([self.program, "report", *map(str, arguments)], cwd=self.folder, text=True,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=TIME_LIMIT)
        self.assertEqual(process.returncode, status, process.stderr)
        return process
