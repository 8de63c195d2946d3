"""Damaged results: every reader reports them and neither crashes nor hangs. HDF5 1.10 itself crashes on some."""

import random
import re

from harness import TestCase, block_case, run

FORMATS = {"xdmf": "results.h5", "vtkhdf": "results.vtkhdf"}
# Signatures of the parts of an HDF5 file that locate its data sets.
PARTS = re.compile(rb"OHDR|OCHK|FRHP|FHDB|FHIB|BTHD|BTLF|BTIN|TREE|SNOD|HEAP|GCOL|FSHD|FSSE")


def damaged(whole, chance):
    """Returns the bytes of a file with a few of them changed."""
    content = bytearray(whole)
    at = chance.randrange(len(content))
    way = chance.choice(("bits", "zeros", "ones", "cut", "moved"))
    length = chance.choice((1, 8, 64, 512))
    if way == "bits":
        for _ in range(chance.choice((1, 3, 20))):
            content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
    elif way == "cut":
        del content[at:]
    else:
        other = chance.randrange(len(content))
        piece = content[other:other + length] if way == "moved" else bytes([255 * (way == "ones")]) * length
        content[at:at + len(piece)] = piece
        del content[len(whole):]
    return bytes(content)


class DamagedResults(TestCase):
    def simulated(self, file_format):
        case = self.write("block.toml", block_case() + f'[output]\nfields_every = 2\nformat = "{file_format}"\n')
        output = self.simulate(case, file_format)
        return output, output / FORMATS[file_format]

    def report(self, output, file, content, what):
        file.write_bytes(content)
        process = run("report", output, "-o", self.folder / "page.html")
        self.assertIn(process.returncode, (0, 2), f"{what}: status {process.returncode}: {process.stderr}")
        if process.returncode == 2:
            self.assertIn(f"{file}: ", process.stderr, what)
        return process.returncode

    def test_every_part_of_the_index(self):
        """A byte after the signature of each part is changed."""
        for file_format in FORMATS:
            output, file = self.simulated(file_format)
            whole = file.read_bytes()
            parts = [found.start() for found in PARTS.finditer(whole)]
            self.assertGreater(len(parts), 10)
            refused = 0
            for at in parts[::max(1, len(parts) // 20)]:
                content = bytearray(whole)
                content[at + 9] ^= 0xff
                refused += self.report(output, file, bytes(content), f"{file_format}: byte {at + 9}") != 0
            self.assertGreater(refused, 5)
            # The directory of the frames, on which HDF5 itself crashes.
            if (at := whole.find(b"FHDB")) >= 0:
                content = whole[:at + 64] + b"\xff" * 64 + whole[at + 128:]
                self.assertEqual(self.report(output, file, content, "FHDB"), 2)
            self.assertEqual(self.report(output, file, whole, "whole"), 0)

    def test_at_random(self):
        for file_format in FORMATS:
            output, file = self.simulated(file_format)
            whole = file.read_bytes()
            for seed in range(40):
                self.report(output, file, damaged(whole, random.Random(seed)), f"{file_format}: seed {seed}")
                self.expect_status(0, run("info", output))

    def test_a_figure_and_a_contact_problem(self):
        output, file = self.simulated("xdmf")
        content = file.read_bytes()
        at = content.find(b"FHDB")
        file.write_bytes(content[:at + 64] + b"\xff" * 64 + content[at + 128:])
        process = self.expect_status(2, run("plot", output, "--what", "pressure-map", "-o", self.folder / "figure.svg"))
        self.assertIn("results.h5: cannot be read as an HDF5 file", process.stderr)
        self.expect_status(0, run("run", self.folder / "block.toml", "-o", self.folder / "out", "--quiet", "--export-contact", "20"))
        (problem,) = (self.folder / "out" / "contact").iterdir()
        whole = problem.read_bytes()
        for seed in range(20):
            problem.write_bytes(damaged(whole, random.Random(seed)))
            self.assertIn(run("contact", problem).returncode, (0, 2, 3), seed)
