"""Contact problems as FCLib files: exported by a run, read by h5py, checked against the contact law from the file
alone, solved by `ricochet contact`."""

import numpy

from fclib_problem import ContactTestCase, Problem, by_point
from harness import DISC, SOURCE, History, block_case, run, settings

OBLIQUE = SOURCE / "cases" / "oblique" / "oblique.toml"
BOWL = SOURCE / "cases" / "bowl" / "bowl.toml"
BALL = SOURCE / "cases" / "ball-spin" / "ball-spin.toml"


class Exports(ContactTestCase):
    def export(self, case, steps, values=None, name="out", options=()):
        output = self.folder / name
        process = self.expect_status(0, run("run", case, "-o", output, "--quiet", "--export-contact", steps, *options,
                                            *settings(values or {})))
        return output, process.stdout

    def check_matrix(self, w):
        self.assertTrue((w == w.T).all())
        scale = 1.0 / numpy.sqrt(numpy.diag(w))
        self.assertGreater(numpy.linalg.eigvalsh(w * scale * scale[:, None]).min(), 0.0)

    def check_layout(self, problem):
        """Checks types and shapes, which are those of H5LTmake_dataset_int, _double and _string."""
        for name, (kind, shape) in problem.kinds.items():
            last = name.split("/")[-1]
            if last in ("title", "description", "math_info"):
                self.assertEqual((kind.kind, shape), ("S", ()), name)
            elif last in ("x", "q", "mu", "s", "u", "r", "l", "q_rounding"):
                self.assertEqual((kind, len(shape)), (numpy.dtype("<f8"), 1), name)
            else:
                self.assertEqual((kind, len(shape)), (numpy.dtype("<i4"), 1), name)
            if last in ("spacedim", "nzmax", "m", "n", "nz", "number_of_guesses"):
                self.assertEqual(shape, (1,), name)

    def check_export(self, case, steps, values, dimension, name="out"):
        output, said = self.export(case, steps, values, name)
        files = sorted((output / "contact").iterdir())
        counts = dict(open=0, slip=0, stick=0)
        for path in files:
            with self.subTest(path.name):
                problem = Problem(path)
                self.assertEqual(problem.d, dimension)
                self.check_layout(problem)
                self.check_matrix(problem.w)
                self.assertEqual(problem.kinds["fclib_local/info/points"][1], problem.mu.shape)
                for key, count in self.check_law(problem, problem.solution).items():
                    counts[key] += count
                solved, process = self.solve(path)
                self.assertIn("solved", process.stdout)
                self.check_law(solved, solved.solution)
                for name in ("w", "q", "mu"):
                    self.assertEqual(getattr(solved, name).tobytes(), getattr(problem, name).tobytes())
                for name in ("u", "r"):
                    size = numpy.abs(problem.solution[name]).max()
                    self.assertLessEqual(numpy.abs(solved.solution[name] - problem.solution[name]).max(), 1e-9 * size)
        return files, said, counts

    def test_export_in_two_dimensions(self):
        """The thrown disc, in the middle of its impact; far from the plane there are no points unless all are
        requested."""
        files, said, counts = self.check_export(OBLIQUE, "1,300,535,614:615", {"solver.contact_points": "all"}, 2)
        self.assertEqual([path.name for path in files], [f"step-{k:06d}.hdf5" for k in (1, 300, 535, 614, 615)])
        self.assertIn("contact problems of 5 steps", said)
        self.assertGreater(min(counts.values()), 0, f"open, sticking and slipping points are seen: {counts}")
        files, said, counts = self.check_export(OBLIQUE, "1,535,614:615", None, 2, "near")
        self.assertEqual([path.name for path in files], [f"step-{k:06d}.hdf5" for k in (535, 614, 615)])
        self.assertIn("contact problems of 3 steps", said)
        self.assertIn("1 had none", said)
        self.assertGreater(min(counts.values()), 0, f"open, sticking and slipping points are seen: {counts}")

    def test_export_in_three_dimensions(self):
        files, _, counts = self.check_export(BALL, "340,372", {"time.end": 0.04}, 3)
        self.assertEqual(len(files), 2)
        self.assertGreater(counts["slip"] + counts["stick"], 0)

    def test_export_on_a_curved_obstacle(self):
        """A step linearizes the contact several times: the exported problem is the last one, which gives the force of
        the history."""
        output, _ = self.export(BOWL, "1:20", {"time.end": 0.002})
        files = sorted(path.name for path in (output / "contact").iterdir())
        self.assertEqual(files, [f"step-{step:06d}.hdf5" for step in range(1, 21)])
        history = History(output / "history.csv")
        for name in files:
            problem = Problem(output / "contact" / name)
            self.check_law(problem, problem.solution)
            rn, _ = by_point(problem.solution["r"], 2)
            row = [int(step) for step in history["step"]].index(int(name[5:11]))
            force = (history["contact_force_x"][row] ** 2 + history["contact_force_y"][row] ** 2) ** 0.5
            # The normals of the points differ by an angle of the block's size over the radius.
            self.assertAlmostEqual(rn.sum(), force, delta=1e-5 * force + 1e-9)

    def test_forces_and_provenance(self):
        """Reactions are the forces of the history, in its units; the texts state the origin of the problem."""
        case = self.write("block.toml", block_case())
        values = {"contact.0.friction": 0.4, "initial.velocity": "[0.5,-1.0]", "time.step": 0.002}
        output, _ = self.export(case, "1:150", values)
        history = (output / "history.csv").read_text(encoding="ascii").splitlines()
        names = history[0].split(",")
        pressed = 0
        for path in sorted((output / "contact").iterdir()):
            step = int(path.name[5:11])
            row = dict(zip(names, map(float, history[1 + step].split(","))))
            problem = Problem(path)
            rn, rt = by_point(problem.solution["r"], 2)
            size = max(rn.max(), 1e-300)
            self.assertAlmostEqual(rn.sum(), row["contact_force_y"], delta=1e-11 * size)
            self.assertAlmostEqual(abs(rt.sum()), abs(row["contact_force_x"]), delta=1e-11 * size)
            self.assertEqual((rn > 0.0).sum(), row["active_contacts"])
            pressed += rn.max() > 0.0
            self.assertEqual(problem.text("title"), f"A block falls: step {step}, t = {step * 0.002:.9g}")
            for word in ("block.toml", "--set", "contact.0.friction=0.4", "newmark", "mass consistent", "nodal",
                         "Units are those of the case"):
                self.assertIn(word, problem.text("description"))
            self.assertIn("Ricochet: solved; residual", problem.text("math_info"))
        self.assertGreater(pressed, 10)

    def test_points_without_friction(self):
        """They have one row in the program and d in the file, where the tangential ones have no effect."""
        output, _ = self.export(DISC, "700", {"time.end": 0.07})
        problem = Problem(output / "contact" / "step-000700.hdf5")
        self.assertEqual(problem.d, 2)
        self.assertTrue((problem.mu == 0.0).all())
        self.check_matrix(problem.w)
        self.check_law(problem, problem.solution)
        self.assertGreater(problem.solution["r"].max(), 0.0)
        self.assertTrue((problem.w[1::2, 0::2] == 0.0).all())
        self.assertTrue((numpy.diag(problem.w)[1::2] == numpy.diag(problem.w)[0::2]).all())
        self.assertTrue((problem.solution["r"][1::2] == 0.0).all() and (problem.q[1::2] == 0.0).all())
        self.assertIn("W_TT = W_NN", problem.text("description"))

    def test_only_eligible_points(self):
        """klr-conserving admits only points that have closed: before contact there is no problem, then there are few
        points."""
        case = self.write("block.toml", block_case())
        values = {"time.scheme": "klr-conserving", "contact.0.friction": 0.2, "initial.velocity": "[0.1,-1.0]"}
        self.write("block.toml", block_case().replace('preset = "trapezoidal"\n', ""))
        output, said = self.export(case, "1:30", values)
        files = sorted((output / "contact").iterdir())
        self.assertLess(len(files), 30)
        self.assertGreater(len(files), 0)
        self.assertIn(f"contact problems of {len(files)} steps", said)
        self.assertIn(f"; {30 - len(files)} had none", said)
        numbers = [list(Problem(path).info["points"]) for path in files]
        self.assertTrue(any(0 < len(points) < 5 for points in numbers), numbers)
        for path in files:
            self.check_law(Problem(path), Problem(path).solution)

    def test_exporting_changes_nothing_of_the_run(self):
        case = self.write("block.toml", block_case())
        values = {"contact.0.friction": 0.3}
        plain = self.simulate(case, "plain", values)
        output, _ = self.export(case, "1:30", values)
        for name in ("history.csv", "results.h5"):
            self.assertEqual((plain / name).read_bytes(), (output / name).read_bytes())

    def test_units_by_powers_of_two_give_the_same_bits(self):
        """Lengths times 2^5 and forces times 2^5 (moduli times 2^-5 in two dimensions): q and u scale, r scales."""
        case = self.write("block.toml", block_case())
        values = {"contact.0.friction": 0.3, "time.end": 0.2, "initial.velocity": "[0.5,-1.0]"}
        one, _ = self.export(case, "15", values, "one")
        scaled = dict(values, **{"material.0.density": 2.0 ** -10, "material.0.lambda": 100.0 * 2.0 ** -10,
                                 "material.0.mu": 50.0 * 2.0 ** -10})
        other, _ = self.export(case, "15", scaled, "other")
        a, b = (Problem(folder / "contact" / "step-000015.hdf5") for folder in (one, other))
        self.assertGreater(a.solution["r"].max(), 0.0)
        self.assertEqual((a.w * 2.0 ** 10).tobytes(), b.w.tobytes())
        self.assertEqual((a.solution["r"] * 2.0 ** -10).tobytes(), b.solution["r"].tobytes())
        self.assertEqual(a.solution["u"].tobytes(), b.solution["u"].tobytes())

    def test_directories_and_force(self):
        case = self.write("block.toml", block_case())
        everywhere = {"solver.contact_points": "all"}  # also far from the floor, where these first steps are
        output, _ = self.export(case, "1,2", everywhere)
        self.expect_status(4, run("run", case, "-o", output, "--quiet"))
        elsewhere = self.folder / "problems"
        self.export(case, "3", everywhere, name="second", options=("--export-contact-to", elsewhere))
        self.assertEqual([path.name for path in elsewhere.iterdir()], ["step-000003.hdf5"])
        self.assertFalse((self.folder / "second" / "contact").exists())
        process = self.expect_status(4, run("run", case, "-o", self.folder / "third", "--export-contact", "4",
                                            "--export-contact-to", elsewhere))
        self.assertIn("--force", process.stderr)
        (elsewhere / "notes.txt").write_text("mine", encoding="ascii")
        self.export(case, "4", everywhere, name="third", options=("--export-contact-to", elsewhere, "--force"))
        self.assertEqual(sorted(path.name for path in elsewhere.iterdir()), ["notes.txt", "step-000004.hdf5"])
        self.simulate(case, "out", options=("--quiet", "--force"))
        self.assertFalse((output / "contact").exists(), "nothing of the old run stays")

    def test_lists_of_steps(self):
        case = self.write("block.toml", block_case())
        for steps, said in (("10,", '"" is empty'), ("", "the value is empty"), ("5:3", '"5:3" ends before it begins'),
                            ("x", '"x" is neither'), ("1;2", '"1;2" is neither'), ("0", "step 0, the initial state"),
                            ("-4", "negative"), ("2:", '"2:" is neither'), ("99999999999999999999", "too large for a step number"),
                            ("31", "the run has only 30 steps")):
            with self.subTest(steps):
                process = self.expect_status(1, run("run", case, "-o", self.folder / "bad", "--export-contact", steps))
                self.assertIn(said, process.stderr)
                self.assertFalse((self.folder / "bad").exists())
        self.expect_status(1, run("run", case, "--export-contact-to", self.folder))
        _, said = self.export(case, "29:40")
        self.assertIn("steps after 30 were not reached", said)
        self.assertIn("warning: --export-contact: the run has 30 steps", said)

    def test_friction_bounds_cannot_be_exported(self):
        case = self.write("block.toml", block_case())
        process = self.expect_status(2, run("run", case, "-o", self.folder / "out", "--export-contact", "1", "--set",
                                            "contact.0.friction_bound=3"))
        self.assertIn("contact.0.friction_bound", process.stderr)
        self.assertIn("FCLib", process.stderr)
        self.assertFalse((self.folder / "out").exists())
