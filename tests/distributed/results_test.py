"""Results of ricochet-mpi: the numbers of one process, and the same bits for equal numbers of processes."""

import subprocess
import unittest

import h5py
import numpy

from launched import BOUNCE, Distributed, several
from harness import History, run

# A column that stands on the floor; the probe watches only its top.
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
            # Other commands read it as usual.
            described = run("info", self.folder / name)
            self.assertEqual(described.returncode, 0, described.stderr)

    def expect_same_fields(self, one, name):
        with h5py.File(self.folder / one / "results.h5") as expected, \
                h5py.File(self.folder / name / "results.h5") as found:
            for data in ("nodes", "cells", "element", "contact_facets"):
                self.assertTrue(numpy.array_equal(expected["mesh"][data], found["mesh"][data]), data)
            self.assertEqual(list(expected["frames"]), list(found["frames"]))
            scale = {}  # over all frames: in free flight stresses are rounding
            for frame in expected["frames"].values():
                for field, values in frame.items():
                    scale[field] = max(scale.get(field, 0.0), numpy.nanmax(numpy.abs(numpy.array(values, float))))
            for frame in expected["frames"]:
                for field, values in expected["frames"][frame].items():
                    values, own = numpy.array(values, float), numpy.array(found["frames"][frame][field], float)
                    near = numpy.allclose(own, values, rtol=0.0, atol=1e-6 * scale[field], equal_nan=True)
                    self.assertTrue(near, f"{frame} {field}")

    def test_at_nodes_between_two_points_are_those_of_one_process(self):
        """With degree 2 the pressure of a node is recovered from contact points of several processes."""
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
        """States of frames are an exception; there are none here."""
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
        """A probe of cells and an axisymmetric contact that some processes do not have."""
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


if __name__ == "__main__":
    unittest.main()
