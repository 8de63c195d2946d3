"""Warnings of motions that the scheme, and of strains that small strain, cannot follow."""

import json
import re

from harness import MESHES, SOURCE, TWO_TRIANGLES, History, TestCase, block_case, body_case, run, settings, summary_of, with_more

SUPPORT = '[[support]]\ngroup = "sides"\ncomponents = ["x"]\nvalue = "{}"\n'


class Warnings(TestCase):
    def warnings_of(self, text, **values):
        output = self.simulate(self.write("case.toml", text), values=values, options=("--quiet", "--force"))
        return summary_of(output)["warnings"]

    def test_distorted_cells(self):
        """With u = a x² the volume is 1 + 2ax. The nodes at x = 1 are represented by points at 0.995."""
        self.write("cell.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"bottom\"\n2 2 \"body\"\n"
                   "$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n2\n"
                   "1 1 2 1 1 1 2\n2 3 2 2 1 1 2 3 4\n$EndElements\n")
        text = ('[mesh]\nfile = "cell.msh"\ndegree = 2\nplane = "strain"\n[[material]]\ngroup = "body"\ndensity = 1.0\nyoung = 1.0\n'
                'poisson = 0.3\nlaw = "neo-hookean"\n[mass]\ntype = "consistent"\n[initial]\ndisplacement = ["{}*x^2", "0"]\n'
                '[time]\nscheme = "hht-alpha"\nstep = 1e-6\nend = 2e-6\n')
        for part, has_energy in ((-0.45, True), (-0.35, False)):
            told = [line for line in self.warnings_of(text.format(part)) if "artificial energy" in line]
            self.assertEqual(len(told), 1 if has_energy else 0, told)
            if has_energy:
                self.assertRegex(told[0], r"at t = 0 the volume of cell 2 at \(0.5, 0.5\) is 0.104 times that at rest near")
        for part, volume in ((-0.55, "-0.0945"), (-0.7, "-0.242")):
            refused = self.expect_status(2, run("run", self.write("case.toml", text.format(part)), "-o", self.folder / "refused"))
            self.assertIn(f"initial.displacement: cell 2 at (0.5, 0.5) is inverted: somewhere in it the volume is {volume} times",
                          refused.stderr)

    def test_supports_whose_velocity_jumps(self):
        ramp, smooth = "-0.01*min(t/0.1, 1)", "-0.005*(1-cos(pi*min(t/0.1, 1)))"
        few_steps = "0.0001*sin(2*pi*t/0.04)"  # twenty in a period
        for motion, scheme, jumps in ((ramp, "newmark", True), (smooth, "newmark", False), (few_steps, "newmark", False),
                                      (ramp, "klr-conserving", False)):
            text = block_case() + SUPPORT.format(motion)
            if scheme != "newmark":
                text = text.replace('scheme = "newmark"\npreset = "trapezoidal"', f'scheme = "{scheme}"')
            text = text.replace("step = 0.01", "step = 0.002")
            told = [line for line in self.warnings_of(text) if "velocity of this support jumps" in line]
            self.assertEqual(len(told), 1 if jumps else 0, (motion, scheme, told))
            if jumps:
                line = text[:text.index("value = \"-0.01")].count("\n") + 1
                self.assertIn(f"case.toml:{line}:9", told[0])
                self.assertIn("jumps at t = 0.1.", told[0])
                self.assertIn("velocity of this support jumps", run("validate", self.folder / "case.toml").stderr)

    def support_force_after_jump(self, time):
        """Runs a square all of whose nodes move along x, at 0.01 per unit of time from t = 0.05 on: without strain, the force
        of the support is that of inertia. Returns its largest value soon after the jump and late, and what the run tells."""
        output = self.simulate(self.write("square.toml", f'''mesh.file = "square.msh"
mesh.degree = 1
mesh.plane = "strain"
mass.type = "lumped"
output.history_every = 1
output.fields_every = 0
[[material]]
group = "body"
density = 1.0
lambda = 0.0
mu = 1.0
[[support]]
group = "bottom"
components = ["x"]
value = "0.01*max(t - 0.05, 0)"
[[support]]
group = "bottom"
components = ["y"]
[[probe]]
name = "all"
boundary = "bottom"
[time]
step = 0.01
end = 3.0
{time}'''), options=("--quiet", "--force"))
        force = [abs(value) for value in History(output / "history.csv")["all.support_x"]]
        told = [line for line in summary_of(output)["warnings"] if "jumps" in line]
        response = "fades" if not told else "grows" if "grows with every step" in told[0] else "alternates"
        return max(force[5:30]), max(force[270:]), response

    def test_forces_of_supports_after_a_jump_are_as_foretold(self):
        """All schemes, and the parameters at which the response changes its kind."""
        self.write("square.msh", TWO_TRIANGLES)
        schema = json.loads(run("schema").stdout)
        schemes = schema["properties"]["time"]["properties"]["scheme"]["enum"]
        times = [f'scheme = "{scheme}"' for scheme in schemes if scheme != "newmark"]
        times += [f'scheme = "newmark"\nbeta = {beta}\ngamma = {gamma}'
                  for beta, gamma in ((0.25, 0.5), (0.2, 0.5), (0.3, 0.5), (0.5, 0.5), (0.25, 0.6), (0.3, 0.6), (0.35, 0.6), (0.25, 0.4))]
        times += [f'scheme = "{scheme}"\nspectral_radius = {radius}'
                  for scheme in ("generalized-alpha", "nonsmooth-generalized-alpha") for radius in (0.5, 1.0)]
        times += [f'scheme = "moreau-jean"\ntheta = {theta}' for theta in (0.5, 1.0)]
        found = set()
        for time in times:
            soon, late, told = self.support_force_after_jump(time)
            response = "fades" if late <= 0.01 * soon or soon < 1e-9 else "grows" if late > 3.0 * soon else "alternates"
            self.assertEqual(told, response, (time, soon, late))
            found.add(response)
        self.assertEqual(found, {"fades", "alternates", "grows"})

    def test_forces_that_cancel_are_no_imbalance_of_momentum(self):
        """A disc squeezed between two planes: the resultant of the contact forces is rounding."""
        text = body_case(MESHES / "disc_o2_msh41_ascii.msh", [0.0, 0.0], [0.0, 1.0], '[initial]\ndisplacement = "static"\n',
                         bottom="boundary", degree=2, mass="equivalent", scheme="reduced-kane", step=0.01, end=0.2)
        text = text.replace("degree", "move = [0.0, 1.0]\ndegree", 1)
        text += ('[obstacle.lid]\ntype = "plane"\npoint = [0.0, 1.99]\nnormal = [0.0, -1.0]\n'
                 '[[contact]]\ngroup = "boundary"\nobstacle = "lid"\n')
        output = self.simulate(self.write("case.toml", text), options=("--quiet", "--force"))
        summary = summary_of(output)
        self.assertEqual([line for line in summary["warnings"] if "momentum" in line], [])
        history = History(output / "history.csv")
        self.assertGreater(history["active_contacts"][-1], 1)
        self.assertLess(abs(history["contact_force_y"][-1]), 1e-9)

    def test_steps_that_are_long_for_their_scheme(self):
        for scheme, limited in (("newmark", True), ("mean-reaction", True), ("reduced-kane", False)):
            text = block_case()
            if scheme != "newmark":
                text = text.replace('scheme = "newmark"\npreset = "trapezoidal"', f'scheme = "{scheme}"')
            for step in (0.1, 0.001):
                told = self.warnings_of(text, **{"time.step": step, "mass.type": "equivalent", "time.end": 10 * step})
                told = [line for line in told if "a compression wave crosses a median cell" in line]
                self.assertEqual(len(told), 1 if limited and step == 0.1 else 0, (scheme, step, told))
                if told:
                    self.assertRegex(told[0], r"use a step of at most [0-9.]+, or scheme")
        # With inertia at contact nodes, shorter steps create as much.
        [told] = [line for line in self.warnings_of(block_case(), **{"time.step": 0.1, "mass.type": "consistent", "time.end": 1.0})
                  if "a compression wave crosses a median cell" in line]
        self.assertNotIn("a step of at most", told)
        self.assertIn('use scheme "reduced-kane" with mass "equivalent"', told)

    def test_crossing_times_of_a_stiff_and_a_soft_body(self):
        """The suggested step has the median of all cells; beside it stand those of materials that differ much."""
        text = with_more(SOURCE / "cases" / "ball-block" / "ball-block.toml", "")
        times = []
        for young in ("2.1e11", "2.1e9", "5.25e8"):
            case = self.write("case.toml", text.replace("young = 2.1e11", f"young = {young}", 1))
            out = self.expect_status(0, run("info", case)).stdout
            times.append([float(t) for t in re.findall(r'([0-9.e+-]+) in "', "".join(re.findall("a median cell of each material: (.*);", out)))])
        self.assertEqual([len(each) for each in times], [0, 2, 2], times)
        self.assertAlmostEqual(times[2][0] / times[1][0], 2.0, delta=0.1)
        self.assertEqual(times[2][1], times[1][1])

    def test_bodies_that_slide_without_damping(self):
        """A block of a different material than the slope of the collection, which does not flutter: damping suppresses
        it."""
        damped = with_more(SOURCE / "cases" / "incline" / "incline.toml", "")
        for text, flutters in ((re.sub("damping = .*\n", "", damped), True), (damped, False)):
            told = self.warnings_of(text, **{
                "time.step": 1e-4, "time.end": 1.0, "material.0.poisson": 0.3, "contact.0.friction": 0.5,
                "initial.displacement": "[0,0]", "initial.velocity": "[6.0,0.0]", "output.fields_every": 0})
            told = [line for line in told if "a body that slides without damping flutters" in line]
            self.assertEqual(len(told), 1 if flutters else 0, told)
            if flutters:
                self.assertRegex(told[0], r"contact was made [0-9]+ times: .* damping = \{ stiffness = 8[0-9.]*e-05 \}")

    def test_which_reactions_act_is_told_once(self):
        process = run("validate", SOURCE / "cases" / "bowl" / "bowl.toml", "--set", "time.reaction_weight=adaptive")
        self.assertEqual(self.expect_status(0, process).stderr.count("the reactions at the end of each step act"), 1)

    def test_energy_that_long_steps_take(self):
        ball = SOURCE / "cases" / "ball" / "ball.toml"
        for weight, loses in (("end", True), ("adaptive", False)):
            output = self.folder / weight
            run("run", ball, "-o", output, "--quiet", "--set", "time.step=2e-4", "--set", f"time.reaction_weight={weight}")
            told = summary_of(output)["warnings"]
            self.assertEqual(any("the scheme itself have removed" in line for line in told), loses, told)

    def test_jumps_anywhere_in_a_long_run(self):
        # A corner at a step, between two steps, at the start of the motion and after a million steps.
        for corner in (0.1, 0.1001, 0.0004, 300.0):
            motion = f"-0.01*max(t-{corner}, 0)"
            text = (block_case() + SUPPORT.format(motion)).replace("step = 0.01", "step = 0.0002")
            told = self.expect_status(0, run("validate", self.write("long.toml", text), "--set", "time.end=310")).stderr
            found = re.search(r"velocity of this support jumps at t = ([^ ]+)\.", told)
            self.assertIsNotNone(found, (corner, told))
            self.assertAlmostEqual(float(found[1]), corner, delta=0.0002)

    def test_parameters_that_no_formula_uses(self):
        text = block_case() + '[initial]\nvelocity = ["v*t_x", "-v"]\nparameters = {v = 1.0, t_x = 2, vel = 3}\n'
        case = self.write("case.toml", text)
        told = self.expect_status(0, run("validate", case)).stderr
        self.assertIn('no formula of this section uses the parameter "vel"', told)
        self.assertEqual(told.count("no formula of this section"), 1, told)
        self.assertRegex(told, rf"case.toml:{text[:text.index('parameters')].count(chr(10)) + 1}:\d+: no formula")
        told = self.expect_status(0, run("validate", case, "--set", "initial.parameters.speed=8")).stderr
        self.assertIn('the parameter "speed"', told)

    def test_energies_that_are_next_to_nothing_are_no_violation(self):
        """A support whose motion starts like exp(-t²), from energies of 1e-323, half of which is rounding."""
        case = block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 0.0]") + SUPPORT.format("0.01*exp(-((t-0.63)/0.01)^2)")
        for step in (2e-4, 1e-3):
            warnings = self.warnings_of(case, **{"time.step": step, "time.end": 0.7})
            self.assertFalse([text for text in warnings if "violated" in text])

    def test_balls_that_nodes_or_steps_may_miss(self):
        def told(radius, side="outside", **values):
            ball = f'type = "sphere"\ncentre = [0.5, {-radius if side == "outside" else radius}]\nradius = {radius}\nside = "{side}"'
            plane = 'type = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]'
            self.assertIn(plane, block_case())
            case = self.write("ball.toml", block_case().replace(plane, ball))
            return run("run", case, "-o", self.folder / "ball", "--force", "--quiet", "--set", "time.end=0.01",
                       *settings(values)).stderr

        between, past = "can pass between them undetected", "can pass the obstacle without touching it"
        self.assertIn(between, told(0.01))
        self.assertNotIn(between, told(5.0))
        self.assertNotIn(between, told(1.5, side="inside"))
        fast = {"initial.velocity": "[0.0,-600.0]"}
        self.assertIn(past, told(5.0, **fast))
        self.assertNotIn(past, told(50.0, **fast))
        self.assertNotIn(past, told(5.0, **fast, **{"obstacle.floor.velocity": "[0.0,-600.0]"}))
        # Gaps that are differences of large numbers lose all digits.
        for radius, refused in ((1e12, True), (1e4, False)):
            said = told(radius)
            self.assertEqual("ball.toml:9:1: gaps to obstacle \"floor\" are rounded to" in said, refused, said)

    def test_strains_that_are_not_small(self):
        # A uniform strain e along y has the equivalent strain sqrt(2/3 e:e) = 2/3 e, the largest of the motion that it
        # starts.
        for strain, told in ((0.30, "equivalent strain of 20 %"), (0.05, None)):
            text = block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 0.0]") + (
                f'[initial]\ndisplacement = ["0", "{strain}*y"]\n')
            found = [line for line in self.warnings_of(text, **{"time.end": 0.02}) if "equivalent strain" in line]
            self.assertEqual(len(found), 1 if told else 0, found)
            if told:
                self.assertIn(told, found[0])
