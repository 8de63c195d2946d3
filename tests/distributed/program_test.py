"""ricochet-mpi as a user launches it: what it writes, what it refuses, and how it ends."""

import contextlib
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import time

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "end_to_end"))
import unittest  # noqa: E402

import interrupted_runs  # noqa: E402
from harness import (DISC, SOURCE, TIME_LIMIT, History, TestCase, block_case, run, settings, wait_for,
                     with_more)  # noqa: E402

PROGRAM = os.environ["RICOCHET_MPI_PROGRAM"]
MPIRUN = os.environ["RICOCHET_MPIRUN"]

PROBES = interrupted_runs.PROBES + """
[[probe]]
name = "wall"
boundary = "boundary"
"""

# A fast disc that bounces once, with friction; few steps, a checkpoint often.
BOUNCE = {"contact.0.friction": 0.3, "initial.velocity": "[0.03,-0.1]", "output.checkpoint_every": 40,
          "output.fields_every": 20, "time.end": 0.06, "solver.tolerance": 1e-12}


# A column that stands on the floor, of which the probe watches the top alone.
STRIP_GEOMETRY = """
Rectangle(1) = {0, 0, 0, 0.2, 1}; Rectangle(2) = {0, 1, 0, 0.2, 0.1};
Coherence;
"""
STRIP_GEOMETRY = "SetFactory(\"OpenCASCADE\");" + STRIP_GEOMETRY + """
Physical Surface("low") = {1}; Physical Surface("end") = {2};
bottom() = Curve In BoundingBox{-1, -0.01, -1, 1, 0.01, 1};
Physical Curve("bottom") = bottom();
Mesh.MeshSizeMax = 0.07;
"""
STRIP = """
[mesh]
file = "strip.msh"
plane = "axisymmetric"
[[material]]
group = ["low", "end"]
density = 1000.0
young = 1e6
poisson = 0.3
[obstacle.floor]
type = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
[[contact]]
group = "bottom"
obstacle = "floor"
[initial]
velocity = ["0", "-1"]
[[probe]]
name = "end"
group = "end"
[time]
step = 1e-3
end = 0.03
[solver]
method = "iterative"
tolerance = 1e-12
"""


def command(ranks, *arguments):
    return [MPIRUN, "-n", str(ranks), PROGRAM, *map(str, arguments)]


def several(ranks, *arguments, directory=None):
    return subprocess.run(command(ranks, *arguments), cwd=directory, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=TIME_LIMIT)


def own_lines(text):
    """Without what mpirun says."""
    return [line for line in text.splitlines() if line.startswith("ricochet")]


def processes_of(process):
    """Those that a mpirun has begun, in the order of their ranks."""
    found = []
    for folder in pathlib.Path("/proc").iterdir():
        with contextlib.suppress(OSError):
            if folder.name.isdigit() and int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1]) == process.pid:
                found.append(int(folder.name))
    return sorted(found)


class Distributed(TestCase):
    def setUp(self):
        super().setUp()
        self.disc = self.write("disc.toml", with_more(DISC, PROBES))

    def bounce(self, ranks, name, *options, values=None):
        arguments = ["run", self.disc, "-o", self.folder / name, "--quiet", *options, *settings(values or BOUNCE)]
        return several(ranks, *arguments) if ranks > 0 else run(*arguments, "--set", "solver.method=iterative")

    def start(self, ranks, name, values):
        arguments = ["run", self.disc, "-o", self.folder / name, "--quiet", *settings(values)]
        return subprocess.Popen(command(ranks, *arguments), text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)

    def summary(self, name):
        return json.loads((self.folder / name / "summary.json").read_text())

    def expect_same_files(self, one, other):
        for path in (self.folder / one).iterdir():
            if path.suffix in (".csv", ".h5", ".xdmf"):
                self.assertEqual(path.read_bytes(), (self.folder / other / path.name).read_bytes(), path.name)


class Results(Distributed):
    def test_are_those_of_one_process(self):
        self.assertEqual(self.bounce(0, "one").returncode, 0)
        expected, one = History(self.folder / "one" / "history.csv"), self.summary("one")
        largest = {name: max(map(abs, expected[name])) for name in expected.names}
        force = max(value for name, value in largest.items() if name.startswith("contact_force"))
        for ranks in (2, 3):
            name = f"ranks-{ranks}"
            finished = self.bounce(ranks, name)
            self.assertEqual(finished.returncode, 0, finished.stderr)
            self.assertEqual(finished.stdout.count("results in"), 1)
            found = History(self.folder / name / "history.csv")
            self.assertEqual(found.names, expected.names)
            for column in found.names:
                if column in ("iterations", "max_penetration") or column.endswith("_residual"):
                    continue
                scale = largest[column]
                if column.endswith(("_work", "_dissipation")):
                    scale = largest["kinetic_energy"]
                if "force" in column or "reaction" in column or "moment" in column:
                    scale = max(scale, force)
                difference = max(abs(a - b) for a, b in zip(found[column], expected[column], strict=True))
                self.assertLessEqual(difference, 1e-6 * scale, column)
            self.assertLess(max(map(abs, found["energy_residual"])), 1e-9 * largest["kinetic_energy"])
            sampled = History(self.folder / name / "probes-3.csv")
            self.assertEqual(len(sampled.rows), len(History(self.folder / "one" / "probes-3.csv").rows))
            own = self.summary(name)
            for key in ("status", "nodes", "cells", "dofs", "contact_points", "frames", "steps"):
                self.assertEqual(own[key], one[key], key)
            self.assertIsNone(one["processes"])
            self.assertEqual(own["processes"]["count"], ranks)
            self.assertGreater(own["processes"]["messages_per_step"], 1.0)
            self.assertEqual(len(own["impacts"]), len(one["impacts"]))
            for mine, theirs in zip(own["impacts"], one["impacts"]):
                self.assertAlmostEqual(mine["begin"], theirs["begin"], places=12)
                self.assertEqual(mine["contact_points"], theirs["contact_points"])
            self.assertAlmostEqual(own["peak_stress"]["von_mises"] / one["peak_stress"]["von_mises"], 1.0, places=2)
            with h5py.File(self.folder / name / "results.h5") as results:
                self.assertEqual(results["mesh"]["element"][own["peak_stress"]["cell"]], own["peak_stress"]["element"])
            self.expect_same_fields("one", name)
            # Others read it as ever.
            described = run("info", self.folder / name)
            self.assertEqual(described.returncode, 0, described.stderr)

    def expect_same_fields(self, one, name):
        with h5py.File(self.folder / one / "results.h5") as expected, \
                h5py.File(self.folder / name / "results.h5") as found:
            for data in ("nodes", "cells", "element", "contact_facets"):
                self.assertTrue(numpy.array_equal(expected["mesh"][data], found["mesh"][data]), data)
            self.assertEqual(list(expected["frames"]), list(found["frames"]))
            scale = {}  # of all frames: in free flight stresses are rounding
            for frame in expected["frames"].values():
                for field, values in frame.items():
                    scale[field] = max(scale.get(field, 0.0), numpy.nanmax(numpy.abs(numpy.array(values, float))))
            for frame in expected["frames"]:
                for field, values in expected["frames"][frame].items():
                    values, own = numpy.array(values, float), numpy.array(found["frames"][frame][field], float)
                    near = numpy.allclose(own, values, rtol=0.0, atol=1e-6 * scale[field], equal_nan=True)
                    self.assertTrue(near, f"{frame} {field}")

    def test_at_nodes_between_two_points_are_those_of_one_process(self):
        """Of degree 2 the pressure of a node is made of contact points that several processes have."""
        values = {**BOUNCE, "mesh.degree": 2, "time.end": 0.03, "output.fields_every": 10}
        self.assertEqual(self.bounce(0, "one", values=values).returncode, 0)
        self.assertEqual(self.bounce(3, "three", values=values).returncode, 0)
        with h5py.File(self.folder / "one" / "results.h5") as one:
            pressures = [numpy.nanmax(numpy.abs(frame["contact_pressure"])) for frame in one["frames"].values()]
        self.assertGreater(max(pressures), 0.0)
        self.expect_same_fields("one", "three")

    def test_are_the_same_bits_for_as_many_processes(self):
        for name in ("first", "second"):
            self.assertEqual(self.bounce(3, name).returncode, 0)
        self.expect_same_files("first", "second")


class PeakStress(Distributed):
    def test_is_looked_for_in_the_same_states(self):
        """Frames aside, of which there are none here."""
        values = BOUNCE | {"output.fields_every": 0}
        for ranks, name in ((0, "one"), (2, "two"), (4, "four")):
            self.assertEqual(self.bounce(ranks, name, values=values).returncode, 0)
        one = self.summary("one")["peak_stress"]
        self.assertLess(one["states_looked_at"], one["states"])
        for name in ("two", "four"):
            found = self.summary(name)["peak_stress"]
            self.assertEqual((found["states_looked_at"], found["time"], found["cell"]), (one["states_looked_at"], one["time"], one["cell"]))
            self.assertAlmostEqual(found["von_mises"], one["von_mises"], delta=1e-6 * one["von_mises"])


class Groups(Distributed):
    def test_may_have_nothing_on_a_process(self):
        """A probe of cells, and an axisymmetric contact, of which some processes have none."""
        case = self.write("strip.toml", STRIP)
        geometry = self.write("strip.geo", STRIP_GEOMETRY)
        mesh = self.folder / "strip.msh"
        subprocess.run(["gmsh", "-2", str(geometry), "-o", str(mesh), "-v", "0"], check=True)
        self.assertEqual(run("run", case, "-o", self.folder / "one", "--quiet").returncode, 0)
        finished = several(4, "run", case, "-o", self.folder / "four", "--quiet")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        one, four = (History(self.folder / name / "history.csv") for name in ("one", "four"))
        self.assertEqual(one.names, four.names)
        for column in ("end.von_mises_maximum", "end.displacement_average_y", "max_penetration", "contact_force_y"):
            largest = max(max(map(abs, one[column])), 1e-9)
            self.assertLessEqual(max(abs(a - b) for a, b in zip(one[column], four[column])), 1e-6 * largest, column)


class Ends(Distributed):
    LONG = BOUNCE | {"time.end": 0.3}

    def finish(self, ranks, name):
        finished = several(ranks, "run", "--resume", self.folder / name, "--quiet")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual(self.summary(name)["status"], "done")

    def test_of_one_process_are_those_of_all(self):
        """kill -9 of any rank ends all within seconds, and the run goes on to the same bits."""
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
        """A load that has no value at a place where one of them has cells: all end within seconds, with one message."""
        begin = time.monotonic()
        values = {**BOUNCE, "load.body_force": '["x > 0.0195 && t > 0.01 ? sqrt(-1) : 0", "0"]'}
        finished = self.bounce(3, "lost", values=values)
        self.assertLess(time.monotonic() - begin, 20)
        self.assertNotEqual(finished.returncode, 0)
        self.assertIn("has no finite value at x = ", finished.stderr)
        self.assertIn("step ", finished.stderr)

    def test_of_an_expected_result_that_does_not_come(self):
        """The first process alone compares: all end with its status, and one message."""
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
        # The step that it comes in is a long one.
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
        self.assertIn("`mpirun -n 2 ricochet-mpi run` with --resume goes on with it", described)
        (self.folder / "stopped" / "summary.json").unlink()  # checkpoints know the case, too
        self.assertIn("summary.json is missing", run("info", self.folder / "stopped").stdout)
        finished = several(2, "run", "--resume", self.folder / "stopped", "--quiet")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual((self.folder / "whole" / "history.csv").read_bytes(), history.read_bytes())

    def test_at_a_full_disk(self):
        """Results that cannot grow: one message within seconds, and what was there goes on."""
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
        self.assertEqual(finished.stderr.count(f"{newest.name}: it is not the file of the manifest"), 1, finished.stderr)
        self.expect_same_files("whole", "damaged")
        # With none that can be read nothing is begun anew.
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
        self.expect(self.bounce(3, "taken"), 4, "taken", "cannot make this directory")
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
        self.assertTrue(any("inside of an obstacle" in warning for warning in self.summary("one")["warnings"]))
        self.assertEqual(self.summary("three")["warnings"], self.summary("one")["warnings"])

    def test_of_cases_that_processes_do_not_share(self):
        """Every other process is in a folder of its own."""
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
        self.expect(run_two(), 4, "case.toml", "process 1 of 2 reads another text")
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
        self.expect(self.bounce(2, "two"), 4, "holds a run already")
        self.assertEqual(self.bounce(2, "two", "--force", values=values).returncode, 0)


if __name__ == "__main__":
    unittest.main()
