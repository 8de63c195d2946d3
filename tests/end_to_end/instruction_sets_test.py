"""Environment variable RICOCHET_INSTRUCTION_SET: selects the compiled versions of loops, ours and OpenBLAS', so that an
older processor can be simulated."""

import os
import re
import shutil
import unittest
from pathlib import Path

from harness import DISC, SOURCE, History, TestCase, run, settings, summary_of

NAMES = ("x86-64", "x86-64-v3", "x86-64-v4")
CORES = {"x86-64": "Prescott", "x86-64-v3": "Haswell", "x86-64-v4": "SkylakeX"}
# OpenBLAS' cores that do not use a whole instruction set.
LESSER = {"x86-64": (), "x86-64-v3": ("Prescott", "Core2", "Nehalem", "Barcelona", "Sandybridge", "Bulldozer", "Piledriver")}
LESSER["x86-64-v4"] = LESSER["x86-64-v3"] + ("Haswell", "Zen")
BALL = SOURCE / "cases" / "ball" / "ball.toml"


def masked(name, **more):
    environment = {key: value for key, value in os.environ.items()
                   if key not in ("RICOCHET_INSTRUCTION_SET", "OPENBLAS_CORETYPE")}
    if name is not None:
        environment["RICOCHET_INSTRUCTION_SET"] = name
    return environment | more


def possible():
    """Returns the sets that this processor supports: each contains those before it."""
    return [name for name in NAMES if run("schema", environment=masked(name)).returncode == 0]


def kernels(environment):
    """Returns the kernels of OpenBLAS and ours, as printed by --version."""
    text = run("--version", environment=environment).stdout
    return re.search(r"OpenBLAS \S+ \((\w+)\)", text)[1], re.search(r" for (\S+)( that read one stream)?\n$", text)[1]


class InstructionSets(TestCase):
    def simulate_with(self, name, case, values):
        output = self.folder / f"{case.stem}-{name}"
        self.expect_status(0, run("run", case, "-o", output, "--quiet", "--force", *settings(values),
                                  environment=masked(name)))
        return History(output / "history.csv"), summary_of(output)

    def test_a_bad_value_is_refused(self):
        for command in (("run", DISC, "-o", self.folder / "out"), ("schema",), ("info", DISC), ("validate", DISC)):
            process = self.expect_status(1, run(*command, environment=masked("avx2")))
            self.assertEqual(process.stdout, "")
            self.assertIn("RICOCHET_INSTRUCTION_SET=avx2: unknown instruction set; use x86-64, x86-64-v3 or x86-64-v4",
                          process.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_what_the_processor_cannot_do_is_refused(self):
        names = possible()
        self.assertEqual(names, list(NAMES[:len(names)]))
        self.assertGreater(len(names), 0)
        for name in NAMES[len(names):]:
            process = self.expect_status(1, run("schema", environment=masked(name)))
            self.assertIn(f"supports at most {names[-1]}", process.stderr)

    def test_an_empty_value_is_none(self):
        self.assertEqual(self.simulate_with("", DISC, {"time.end": 0.001})[1]["libraries"],
                         self.simulate_with(None, DISC, {"time.end": 0.001})[1]["libraries"])

    def test_the_version_tells_the_kernels_of_both(self):
        for name in possible():
            self.assertEqual(kernels(masked(name)), (CORES[name], name))

    def test_openblas_takes_what_suits_the_processor(self):
        core, name = kernels(masked(None))
        self.assertEqual(name, possible()[-1])
        self.assertNotIn(core, LESSER[name])

    def test_only_amds_processors_read_in_one_stream_and_only_where_nobody_asked(self):
        processor = Path("/proc/cpuinfo").read_text(encoding="utf-8")
        for name in (None, *possible()):
            one_stream = "read one stream" in run("--version", environment=masked(name)).stdout
            self.assertEqual(one_stream, name is None and "AuthenticAMD" in processor)

    def test_what_the_user_has_set_stays(self):
        for name in (None, *possible()):
            for core in ("Prescott", "Nehalem"):
                self.assertEqual(kernels(masked(name, OPENBLAS_CORETYPE=core))[0], core)

    def test_kernels_are_those_of_any_number_of_threads(self):
        for threads in ("1", "2", "3"):
            self.assertEqual(kernels(masked("x86-64-v3" if len(possible()) > 1 else None, OPENBLAS_NUM_THREADS=threads)),
                             kernels(masked("x86-64-v3" if len(possible()) > 1 else None)))

    @unittest.skipUnless(shutil.which("gmsh"), "needs gmsh")
    def test_programs_that_are_started_get_the_same_environment(self):
        """Gmsh meshes a .geo file; here a script of that name checks the environment first."""
        found = self.folder / "environment"
        script = self.write("gmsh", f'#!/bin/sh\nenv >> {found}\nexec {shutil.which("gmsh")} "$@"\n')
        script.chmod(0o755)
        for name in (None, "x86-64"):
            environment = masked(name, PATH=f"{self.folder}:{os.environ['PATH']}",
                                 RICOCHET_CACHE=str(self.folder / f"cache-{name}"))
            found.unlink(missing_ok=True)
            self.expect_status(0, run("run", DISC, "-o", self.folder / "out", "--force", "--quiet", *settings(
                {"time.end": 0.001, "mesh.file": f'"{DISC.with_name("disc.geo")}"'}), environment=environment))
            lines = found.read_text(encoding="utf-8").splitlines()
            self.assertEqual([line for line in lines if line.startswith("OPENBLAS_CORETYPE=")], [])
            self.assertEqual({line for line in lines if line.startswith("RICOCHET_INSTRUCTION_SET=")},
                             {f"RICOCHET_INSTRUCTION_SET={name}"} if name else set())

    def test_a_run_that_is_resumed_with_other_kernels_says_so(self):
        names = possible()
        if len(names) == 1:
            self.skipTest("the processor has one instruction set")
        output = self.folder / "out"
        for again in (names[0], names[-1]):
            self.expect_status(0, run("run", DISC, "-o", output, "--force", "--quiet", *settings({"time.end": 0.002}),
                                      environment=masked(names[0])))
            process = self.expect_status(0, run("run", DISC, "-o", output, "--resume", "--quiet",
                                                *settings({"time.end": 0.004}), environment=masked(again)))
            if again == names[0]:
                self.assertNotIn("resumed with", process.stderr)
            else:
                self.assertRegex(process.stderr, rf"resumed with other libraries, another processor or another RICOCHET_INSTRUCTION_SET \(OpenBLAS.*"
                                                 rf"{CORES[again]}.* for {again}; before: OpenBLAS.*{CORES[names[0]]}.*\)")

    def test_results_agree_to_rounding(self):
        for case, values in ((DISC, {"time.end": 0.03}),
                             (DISC, {"time.end": 0.01, "solver.method": "iterative"}),
                             (BALL, {"time.end": 0.036})):
            histories = []
            for name in possible():
                history, summary = self.simulate_with(name, case, values | {"output.fields_every": 0})
                self.assertRegex(summary["libraries"], rf"^OpenBLAS \S+ \({CORES[name]}\), .* for {name}$")
                histories.append(history)
            first = histories[0]
            self.assertGreater(max(first["active_contacts"]), 0, "the body must touch")
            for other in histories[1:]:
                for column in ("kinetic_energy", "elastic_energy", "contact_force_" + "yz"[case == BALL], "max_rotation"):
                    scale = max(map(abs, first[column]))
                    self.assertGreater(scale, 0)
                    # Unit roundoff times some thousand unknowns, times some hundred steps.
                    self.assertLess(max(abs(a - b) for a, b in zip(first[column], other[column], strict=True)), 1e-10 * scale,
                                    f"{column} of {case.stem}")
