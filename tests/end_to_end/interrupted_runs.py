"""Helpers of the tests of interrupted runs: a run worth interrupting, and the criteria for an identical resumed run."""

import subprocess

from harness import DISC, PROGRAM, TestCase, method, settings, summary_of, with_more

RESULTS = {"history.csv", "results.h5", "results.xdmf", "obstacles.xdmf", "results.vtkhdf", "obstacles.vtkhdf", "probes-3.csv"}

PROBES = """
[[probe]]
name = "ground"
contact = 0
[[probe]]
name = "body"
group = "body"
every = 3
"""

# Settings of interrupted runs: friction, frequent checkpoints, a frame now and then.
BUSY = {"contact.0.friction": 0.3, "initial.velocity": "[0.03,-0.1]", "output.checkpoint_every": 40,
        "output.fields_every": 7, "time.end": 0.08}


def busy(scheme):
    return BUSY | method(scheme, "trapezoidal")


def start(case, output, values, *options, **more):
    command = [str(PROGRAM), "run", str(case), "-o", str(output), "--quiet", *options, *settings(values)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)


def checkpoints(output):
    return sorted(output.glob("checkpoint-*.ckpt"))


def told(output):
    """Returns the statements of a summary about the steps themselves."""
    summary = summary_of(output)
    return {name: summary[name] for name in ("extrema", "energy_budget", "reactions", "impacts")}


class ResumeTestCase(TestCase):
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
        self.assertEqual(told(expected), told(found))
        self.assertEqual(summary_of(found)["status"], "done")
        self.assertEqual(list(found.glob("*.new")) + list(found.glob("*.pattern")), [])

    def interrupted(self, values, name):
        """Makes a run that was killed just before its end: the results of a complete one without its summary."""
        output = self.folder / name
        output.mkdir()
        for path in self.reference(values).iterdir():
            text = path.read_bytes()
            if path.name == "summary.json":
                text = text.replace(b'"status": "done"', b'"status": "running"')
            (output / path.name).write_bytes(text)
        return output
