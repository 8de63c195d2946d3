"""The tolerance of Newton's method is one of accuracy: momenta, the account of energy and the rule that no step creates
energy hold to rounding with any value."""

from harness import History, TestCase, run, settings, summary_of

BOX_GEO = """SetFactory("OpenCASCADE");
Rectangle(1) = {{0, 0, 0, {width}, {height}}};
Mesh.MeshSizeMax = {size};
Mesh.MeshSizeMin = {size};
Physical Surface("body") = {{1}};
Physical Curve("base") = {{1}};
Physical Curve("right") = {{2}};
Physical Curve("top") = {{3}};
Physical Curve("left") = {{4}};
"""
BALL_GEO = """SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0.5, 0.5};
Mesh.MeshSizeMax = 0.25;
Mesh.MeshSizeMin = 0.25;
Physical Volume("body") = {1};
Physical Surface("base") = {1};
"""
TOLERANCES = (1e-4, 1e-6, 1e-9)


def material(group="body", law='law = "neo-hookean"'):
    return f'[[material]]\ngroup = "{group}"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n{law}\n'


def floor(friction=0.4, shape='type = "plane"\npoint = [0, -0.05]\nnormal = [0, 1]'):
    return f'[obstacle.floor]\n{shape}\n[[contact]]\ngroup = "base"\nobstacle = "floor"\nfriction = {friction}\n'


THROW = '[initial]\nvelocity = ["1-2*(y-0.2)", "-1+2*(x-0.5)"]\n'


def time(step=0.01, end=0.4):
    return f'[time]\nstep = {step}\nend = {end}\n'


class NewtonTolerance(TestCase):
    def setUp(self):
        super().setUp()
        self.write("box.geo", BOX_GEO.format(width=1.0, height=0.4, size=0.12))
        self.write("slab.geo", BOX_GEO.format(width=2.0, height=0.3, size=0.2))
        self.write("ball.geo", BALL_GEO)

    def runs(self, text):
        """Runs a case with every tolerance. Returns the histories, after checks of what holds with any of them."""
        case, histories = self.write("case.toml", text), []
        for tolerance in TOLERANCES:
            folder = self.folder / f"out{tolerance:g}"
            self.expect_status(0, run("run", case, "-o", folder, "--quiet", "--force", *settings({"solver.newton_tolerance": tolerance})))
            history = History(folder / "history.csv")
            self.balances(history, summary_of(folder), f"tolerance {tolerance:g}")
            histories.append(history)
        self.are_more_accurate(histories)
        return histories

    def balances(self, history, summary, what):
        self.assertGreater(max(history["active_contacts"]), 0, what)
        largest = history.largest_energy()
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-13 * largest, what)
        self.assertLess(max(map(abs, history["integration_error"])), 1e-13 * largest, what)
        for name in ("momentum", "angular_momentum"):
            self.assertLess(summary["checks"][name]["largest"], 1e-13, f"{name}, {what}")
        given = ("load_work", "support_work", "obstacle_work", "damping_work")
        own = [total - sum(works) for total, *works in zip(history["total_energy"], *(history[name] for name in given))]
        self.assertLess(max(after - before for before, after in zip(own, own[1:])), 1e-13 * largest, what)

    def are_more_accurate(self, histories):
        """Looser tolerances take fewer iterations, and errors are in proportion to them."""
        rounds = [sum(history["newton_rounds"]) for history in histories]
        self.assertLess(rounds[0], 0.8 * rounds[2])
        self.assertLess(rounds[1], rounds[2])
        name = "kinetic_energy"
        exact, size = histories[2][name], histories[2].largest_energy()
        errors = [max(abs(a - b) for a, b in zip(history[name], exact)) / size for history in histories[:2]]
        self.assertLess(errors[0], 0.02)
        self.assertLess(errors[1], 2e-4)

    def test_a_block_bounces_on_a_plane(self):
        for friction in (0.0, 0.4):
            with self.subTest(friction=friction):
                self.runs('[mesh]\nfile = "box.geo"\n' + material() + floor(friction) + THROW + time())

    def test_a_block_bounces_on_a_hill(self):
        hill = 'type = "sphere"\ncentre = [0.4, -1.05]\nradius = 1.0'
        self.runs('[mesh]\nfile = "box.geo"\n' + material() + floor(0.4, hill) + THROW + time())

    def test_a_ball_of_nearly_incompressible_cells_of_degree_two(self):
        shape = 'type = "plane"\npoint = [0, 0, -0.03]\nnormal = [0, 0, 1]'
        text = material().replace("0.3", "0.48") + floor(0.3, shape) + '[initial]\nvelocity = [1.0, 0.0, -1.0]\n'
        self.runs('[mesh]\nfile = "ball.geo"\ndegree = 2\n' + text + time(0.02, 0.3))

    def test_rubber_that_relaxes(self):
        relaxing = material(law='law = "neo-hookean"\nrelaxation = { modulus = [0.5, 1.0], time = [0.02, 0.5] }')
        self.runs('[mesh]\nfile = "box.geo"\n' + relaxing + floor() + THROW + time())

    def test_a_ring_of_revolution(self):
        text = material() + floor(0.3) + '[initial]\nvelocity = ["0.3*x", "-1"]\n'
        self.runs('[mesh]\nfile = "box.geo"\nplane = "axisymmetric"\n' + text + time())

    def test_a_block_that_a_support_drives_and_a_pressure_loads(self):
        text = (material() + floor(0.3) + '[[support]]\ngroup = "left"\ncomponents = ["x"]\nvalue = "0.1*sin(5*t)"\n'
                '[[pressure]]\ngroup = "top"\nvalue = "3*min(t/0.1,1)"\n')
        self.runs('[mesh]\nfile = "box.geo"\n' + text + time())

    def test_blocks_that_slide_along_each_other(self):
        self.runs('[part.slab]\nfile = "slab.geo"\n[part.box]\nfile = "box.geo"\nmove = [0.2, 0.32]\nvelocity = [2.0, -1.0]\n'
                  + material("slab.body") + material("box.body")
                  + '[[contact]]\ngroup = "box.base"\nagainst = "slab.top"\nsliding = "large"\nfriction = 0.2\n' + time(0.004, 0.2))

    def test_a_rigid_disc_and_a_block(self):
        disc = 'type = "sphere"\ncentre = [0.4, 0.75]\nradius = 0.3\ndensity = 2.0\nvelocity = [0.3, -1.5]\nspin = 5.0'
        self.runs('[mesh]\nfile = "box.geo"\n' + material() + floor(0.3, disc).replace('"base"', '"top"') + time())

    def test_a_body_of_any_size(self):
        """In units of length of any power of two the results have the same digits: of a body of some 10^-8 or 10^7 too."""
        histories = []
        for exponent in (0, -24, 24):
            length = 2.0**exponent
            text = ('[mesh]\nfile = "box.geo"\n' + f"scale = {length!r}\n" +
                    f'[[material]]\ngroup = "body"\ndensity = {length**-2!r}\nyoung = 100.0\npoisson = 0.3\nlaw = "neo-hookean"\n' +
                    floor(shape=f'type = "plane"\npoint = [0, {-0.0625 * length!r}]\nnormal = [0, 1]') +
                    f'[initial]\nvelocity = ["{length!r}-2*(y-{0.1875 * length!r})", "-{length!r}+2*(x-{0.5 * length!r})"]\n' +
                    time(end=0.2) + "[solver]\nnewton_tolerance = 1e-4\n")
            histories.append((length, History(self.simulate(self.write("case.toml", text), f"size{exponent}") / "history.csv")))
        _, usual = histories[0]
        self.assertGreater(max(usual["active_contacts"]), 0)
        for length, history in histories[1:]:
            for name, power in (("momentum_x", 1), ("angular_momentum_z", 2), ("kinetic_energy", 2), ("total_energy", 2)):
                self.assertEqual([value / length**power for value in history[name]], list(usual[name]), (length, name))

    def test_a_value_that_is_none_is_refused(self):
        case = self.write("case.toml", '[mesh]\nfile = "box.geo"\n' + material() + floor() + THROW + time())
        for value in (0, -1e-9, 0.1):
            refused = run("validate", case, *settings({"solver.newton_tolerance": value}))
            self.expect_status(2, refused)
            self.assertIn("newton_tolerance", refused.stderr)
