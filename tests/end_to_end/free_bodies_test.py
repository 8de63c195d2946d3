"""Rigid bodies that move freely: momenta, energy, closed forms, and resumed runs."""

import math

import numpy

from harness import History, TestCase, run, summary_of
from shaped_obstacles_test import block_on, box_stl

PLANE = 'type = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]'


class Bodies(TestCase):
    def case(self, obstacle, *, space=False, law="neo-hookean", more="", friction=0.3, step=0.002, end=0.2):
        """Returns a free block, 0.5 high in the plane and 0.6 in space, and a rigid body."""
        text = block_on(obstacle, self.folder, space=space, drive=more, friction=friction, step=step, end=end, group="top")
        text = text.replace("density = 1.0", f'density = 1.0\nlaw = "{law}"', 1)
        return text.replace("lambda = 100.0", "young = 130.0").replace("mu = 50.0", "poisson = 0.3")


class Momenta(Bodies):
    def keeps(self, text, angular=True):
        results = self.simulate(self.write("case.toml", text))
        history = History(results / "history.csv")
        self.assertGreater(max(history["active_contacts"]), 0)
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-11 * history.largest_energy())
        self.assertLess(history["total_energy"][-1], history["total_energy"][0])
        names = [name for name in history.names if name.startswith("momentum_")]
        names += [name for name in history.names if angular and name.startswith("angular_")]
        size = max(abs(value) for name in names for value in history[name])
        for name in names:
            self.assertLess(numpy.ptp(history[name]), 1e-11 * size, name)
        return history

    def test_a_disc_and_a_block(self):
        history = self.keeps(self.case('type = "sphere"\ncentre = [0.4, 0.82]\nradius = 0.3\ndensity = 2.0\nvelocity = [0.3, -1.5]\n'
                                  "spin = 5.0"))
        self.assertNotAlmostEqual(history["floor.spin_z"][-1], 5.0, delta=0.1)

    def test_a_brick_and_a_block_in_space(self):
        """Unequal moments of inertia: it tumbles, with gyroscopic torques."""
        (self.folder / "brick.stl").write_text(box_stl([0.3, 0.3, 0.65], [0.8, 0.6, 0.8]))
        history = self.keeps(self.case('type = "surface"\nfile = "brick.stl"\ndensity = 2.0\nvelocity = [0.2, 0.1, -1.5]\n'
                                  "spin = [2.0, -3.0, 1.0]", space=True, end=0.3))
        self.assertGreater(max(history["floor.contact_force_z"]), 0.0)

    def test_linear_bodies(self):
        """The angular momentum uses the initial positions; the account contains the difference."""
        self.keeps(self.case('type = "sphere"\ncentre = [0.4, 0.82]\nradius = 0.3\nmass = 0.5\nvelocity = [0.3, -1.5]',
                        law="linear"), angular=False)


class Info(Bodies):
    def test_info_has_the_inertia_of_free_bodies(self):
        """A disc: m r²/2; a ball: 2/5 m r²."""
        for space, centre, moment in ((False, "[0.4, 0.82]", "0.09"), (True, "[0.4, 0.4, 0.92]", "(0.072, 0.072, 0.072)")):
            path = self.write("case.toml", self.case(f'type = "sphere"\ncentre = {centre}\nradius = 0.3\nmass = 2.0', space=space))
            self.expect_status(0, run("validate", path, "--mesh"))
            shown = self.expect_status(0, run("info", path)).stdout
            self.assertRegex(shown, r"\n  the body: mass ")
            line = next(line for line in shown.splitlines() if line.startswith('  rigid body "floor": mass 2'))
            self.assertIn(f"moment of inertia about it {moment}", line)


class ClosedForms(Bodies):
    """A rigid body beside a block that it never touches."""

    def flight(self, obstacle, end=1.0, step=0.005, **more):
        text = self.case('type = "sphere"\ncentre = [9.0, 9.0]\nradius = 0.3\nmass = 2.0\n' + obstacle, law="linear", end=end,
                    step=step, **more)
        return History(self.simulate(self.write("case.toml", text)) / "history.csv")

    def test_a_spring_and_a_damper(self):
        history = self.flight("velocity = [1.0, 0.0]\nspring = [50.0, 0.0]\ndamper = [2.0, 0.0]\nspin = 3.0\n"
                              "rotation_damper = 0.5", step=0.001)
        rate, decay = math.sqrt(25.0 - 0.25), 0.5
        for time, x, spin in zip(history["time"], history["floor.displacement_x"], history["floor.spin_z"]):
            self.assertAlmostEqual(x, math.exp(-decay * time) * math.sin(rate * time) / rate, delta=2e-6)
            self.assertAlmostEqual(spin, 3.0 * math.exp(-0.5 / 0.09 * time), delta=1e-4)
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-12)

    def test_forces_and_gravity(self):
        history = self.flight('force = ["4*t", "0"]\ntorque = "0.18"\nvelocity = [0.0, 2.0]',
                              more="[load]\ngravity = [0.0, -9.81]\n")
        for time, x, y, turned in zip(*(history[name] for name in ("time", "floor.displacement_x", "floor.displacement_y",
                                                                   "floor.rotation_z"))):
            self.assertAlmostEqual(x, time ** 3 / 3.0, delta=1e-5)
            self.assertAlmostEqual(y, 2.0 * time - 0.5 * 9.81 * time ** 2, delta=1e-12)
            self.assertAlmostEqual(turned, time ** 2, delta=1e-4)

    def test_what_is_held_stays(self):
        history = self.flight('hold = ["x", "rotation"]\nforce = ["1", "1"]\ntorque = "1"')
        self.assertEqual(max(map(abs, history["floor.displacement_x"])), 0.0)
        self.assertEqual(max(map(abs, history["floor.rotation_z"])), 0.0)
        self.assertAlmostEqual(history["floor.displacement_y"][-1], 0.25, delta=1e-12)


class Impacts(Bodies):
    def test_the_restitution_is_that_of_two_bodies(self):
        """A ball of the block's mass: velocities of both before and after, and their momenta."""
        text = self.case('type = "sphere"\ncentre = [0.5, 0.75]\nradius = 0.2\nmass = 0.5\nvelocity = [0.0, -0.5]', end=0.5,
                         friction=0.0)
        results = self.simulate(self.write("case.toml", text))
        summary = summary_of(results)
        self.assertEqual([body["name"] for body in summary["bodies"]][-1], "floor")
        self.assertAlmostEqual(summary["bodies"][-1]["mass"], 0.5, delta=1e-15)
        impact = summary["impacts"][0]
        self.assertAlmostEqual(impact["normal_velocity_before"], -0.5, delta=1e-6)
        self.assertGreater(impact["restitution"], 0.2)
        self.assertLess(impact["restitution"], 1.0)
        said = self.expect_status(0, run("info", results)).stdout
        self.assertIn('  impact 1: the body on "floor" first at ', said)
        # Its velocity changes; that of an obstacle with a prescribed motion does not.
        self.assertIn('  contact of "top" with "floor", starting at (0, -0.5): ', said)
        self.assertNotIn("stick", said)
        self.assertTrue(summary["contacts"][0]["obstacle_moves_freely"])

    def test_springs_are_in_the_balance_of_momentum(self):
        text = self.case('type = "sphere"\ncentre = [9.0, 9.0]\nradius = 0.3\nmass = 2.0\nvelocity = [1.0, 0.5]\n'
                         "spring = [50.0, 20.0]\nspin = 2.0\nrotation_spring = 4.0")
        process = run("run", self.write("case.toml", text), "-o", self.folder / "out", "--quiet")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertNotIn("balance of", process.stderr)

    def test_its_nodes_are_none_of_the_mesh(self):
        text = self.case('type = "sphere"\ncentre = [0.5, 0.82]\nradius = 0.3\ndensity = 2.0')
        said = self.expect_status(0, run("validate", self.write("case.toml", text))).stdout
        self.assertIn('the mesh is 0.02479 away from obstacle "floor"', said)
        self.assertIn("the obstacle moves freely: mass 0.565487, centre (0.5, 0.82)", said)

    def test_a_static_start_needs_what_holds_it(self):
        text = self.case('type = "sphere"\ncentre = [0.5, 0.82]\nradius = 0.3\ndensity = 2.0',
                         more='[initial]\ndisplacement = "static"\n')
        said = self.expect_status(2, run("run", self.write("case.toml", text), "-o", self.folder / "out")).stderr
        self.assertIn('requires a restraint of "floor" against motion along x', said)


    def test_a_static_start_may_move_a_rigid_body(self):
        """The support raises the block, with the disc on it, by more than a cell: no node is inside the disc where it then
        is, although some would be inside it where it was."""
        held = "mass = 1.0\nspring = [1.0, 1.0]\nrotation_spring = 1.0"
        raised = ('[[support]]\ngroup = "bottom"\ncomponents = ["y"]\nvalue = 0.2\n[[support]]\ngroup = "bottom"\ncomponents = ["x"]\n'
                  '[initial]\ndisplacement = "static"\n')
        text = self.case(f'type = "sphere"\ncentre = [0.5, 0.82]\nradius = 0.3\n{held}', more=raised, end=0.01)
        results = self.simulate(self.write("case.toml", text))
        self.assertGreater(History(results / "history.csv")["floor.displacement_y"][0], 0.15)
        self.assertEqual(summary_of(results)["unwatched_penetration"]["found"], [])


class Runs(Bodies):
    def test_a_run_that_is_resumed_has_the_same_bits(self):
        (self.folder / "brick.stl").write_text(box_stl([0.3, 0.3, 0.65], [0.8, 0.6, 0.8]))
        text = self.case('type = "surface"\nfile = "brick.stl"\ndensity = 2.0\nvelocity = [0.2, 0.1, -1.5]\n'
                    "spin = [2.0, -3.0, 1.0]", space=True)
        path = self.write("case.toml", text + "[output]\ncheckpoint_every = 1\n")
        whole = self.simulate(path, "whole")
        half = self.folder / "half"
        process = run("run", path, "-o", half, "--set", "time.end=0.11")
        self.assertEqual(process.returncode, 0, process.stderr)
        process = run("run", path, "-o", half, "--resume")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual((whole / "history.csv").read_bytes(), (half / "history.csv").read_bytes())

    def test_what_makes_no_sense_is_refused(self):
        for obstacle, fragment in (
                (PLANE + "\nmass = 1.0", "encloses nothing that has a centre of mass"),
                ('type = "sphere"\ncentre = [9.0, 9.0]\nradius = 0.3\nmass = 1.0\nrotation = "t"', "moves under the forces on it"),
                ('type = "sphere"\ncentre = [9.0, 9.0]\nradius = 0.3\nmass = 1.0\ndensity = 1.0', 'already has "mass"'),
                ('type = "sphere"\ncentre = [9.0, 9.0]\nradius = 0.3\nmass = 1.0\nspring = [-1.0, 0.0]', "must not be negative"),
                ('type = "sphere"\ncentre = [9.0, 9.0]\nradius = 0.3\nmass = 1.0\nhold = ["z"]', "no direction \"z\"")):
            process = run("run", self.write("case.toml", self.case(obstacle)), "-o", self.folder / "out", "--force")
            self.assertEqual(process.returncode, 2, process.stderr)
            self.assertIn(fragment, process.stderr)
        text = self.case('type = "sphere"\ncentre = [9.0, 9.0]\nradius = 0.3\nmass = 1.0', law="linear")
        process = run("run", self.write("case.toml", text), "-o", self.folder / "out", "--force", "--set",
                      "time.scheme=midpoint", "--set", "mass.type=consistent")
        self.assertEqual(process.returncode, 2, process.stderr)
        self.assertIn("does not support rigid bodies that move freely", process.stderr)
