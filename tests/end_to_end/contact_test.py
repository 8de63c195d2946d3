"""Contact problems as FCLib files: exported by a run, read by h5py, checked against the law from the file alone, solved
by `ricochet contact`; and files that h5py writes in every form of a matrix."""

import pathlib
import subprocess
import unittest

import h5py
import numpy

from harness import DISC, MESHES, PROGRAM, SOURCE, TestCase, block_case, run, settings

OBLIQUE = SOURCE / "cases" / "oblique" / "oblique.toml"
BALL = SOURCE / "cases" / "ball-spin" / "ball-spin.toml"


def matrix(group):
    """The matrix of a group as an array, by the layout that FCLib states."""
    m, n, nz, nzmax = (int(group[name][0]) for name in ("m", "n", "nz", "nzmax"))
    p, i, x = group["p"][()], group["i"][()], group["x"][()]
    result = numpy.zeros((m, n))
    if nz >= 0:
        assert len(p) == len(i) == nz <= nzmax
        numpy.add.at(result, (p, i), x[:nz])
        return result
    assert len(i) == len(x) == nzmax and len(p) == (n if nz == -1 else m) + 1 and p[-1] <= nzmax
    for k in range(len(p) - 1):
        for at in range(p[k], p[k + 1]):
            result[(i[at], k) if nz == -1 else (k, i[at])] += x[at]
    return result


class Problem:
    """A file of FCLib's layout, read with h5py."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            local = file["fclib_local"]
            self.d = int(local["spacedim"][0])
            self.w = matrix(local["W"])
            self.v = matrix(local["V"]) if "V" in local else numpy.zeros((len(self.w), 0))
            self.r = matrix(local["R"]) if "R" in local else numpy.zeros((0, 0))
            self.q, self.mu = local["vectors/q"][()], local["vectors/mu"][()]
            self.s = local["vectors/s"][()] if "R" in local else numpy.zeros(0)
            self.info = {name: value[()] for name, value in local["info"].items()} if "info" in local else {}
            self.kinds = {name: (value.dtype, value.shape) for name, value in self.datasets(file)}
            self.solution = {name: value[()] for name, value in file["solution"].items()} if "solution" in file else None
            self.guesses = [{name: value[()] for name, value in file[f"guesses/{k + 1}"].items()}
                            for k in range(int(file["guesses/number_of_guesses"][0]))] if "guesses" in file else []

    @staticmethod
    def datasets(file):
        found = []
        file.visititems(lambda name, item: found.append((name, item)) if isinstance(item, h5py.Dataset) else None)
        return found

    def text(self, name):
        return self.info[name].decode()


def by_point(vector, d):
    """(normal components, tangential vectors)"""
    rows = vector.reshape(-1, d)
    return rows[:, 0], rows[:, 1:]


class Contact(TestCase):
    def export(self, case, steps, values=None, name="out", options=()):
        output = self.folder / name
        process = self.expect_status(0, run("run", case, "-o", output, "--quiet", "--export-contact", steps, *options,
                                            *settings(values or {})))
        return output, process.stdout

    def check_law(self, problem, solution, tolerance=1e-9):
        """u = W r + V l + q, and at every point K* contains û, r is in K, and they are orthogonal."""
        u, r = solution["u"], solution["r"]
        multiplier = solution.get("l", numpy.zeros(0))
        force = numpy.abs(problem.w) @ numpy.abs(r) + numpy.abs(problem.v) @ numpy.abs(multiplier) + numpy.abs(problem.q)
        length = force.max()
        self.assertLessEqual(numpy.abs(problem.w @ r + problem.v @ multiplier + problem.q - u).max(), 1e-12 * length)
        (un, ut), (rn, rt) = by_point(u, problem.d), by_point(r, problem.d)
        slip, friction = numpy.linalg.norm(ut, axis=1), numpy.linalg.norm(rt, axis=1)
        self.assertGreaterEqual(rn.min(), 0.0)
        self.assertLessEqual((friction - problem.mu * rn).max(), 1e-12 * max(rn.max(), 1e-300))
        hat = un + problem.mu * slip
        # K* = {û: û_N >= μ |û_T|}; û_N - μ |û_T| is u_N.
        self.assertGreaterEqual(un.min(), -tolerance * length)
        products = hat * rn + numpy.sum(ut * rt, axis=1)
        self.assertLessEqual(numpy.abs(products).max(), tolerance * length * max(rn.max(), 1e-300))
        pressed = rn > 0.0
        return dict(open=int((~pressed).sum()), slip=int((pressed & (slip > tolerance * length)).sum()),
                    stick=int((pressed & (slip <= tolerance * length)).sum()))

    def check_matrix(self, w):
        self.assertTrue((w == w.T).all())
        scale = 1.0 / numpy.sqrt(numpy.diag(w))
        self.assertGreater(numpy.linalg.eigvalsh(w * scale * scale[:, None]).min(), 0.0)

    def check_layout(self, problem):
        """Types and shapes are those of H5LTmake_dataset_int, _double and _string."""
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

    def solve(self, path, *options, status=0):
        output = self.folder / "solution.hdf5"
        process = self.expect_status(status, run("contact", path, "-o", output, *options))
        return Problem(output), process

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

    # --- exported by a run -------------------------------------------------------------------------------------------

    def test_export_in_two_dimensions(self):
        """The thrown disc, in the middle of its impact; far from the plane no point takes part unless all shall."""
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
        files, _, counts = self.check_export(BALL, "170,186", {"time.end": 0.04}, 3)
        self.assertEqual(len(files), 2)
        self.assertGreater(counts["slip"] + counts["stick"], 0)

    def test_forces_and_provenance(self):
        """Reactions are the forces of the history, in its units; the texts say where the problem comes from."""
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
        """They have one row in the program and d in the file, of which the tangential ones do nothing."""
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
        """klr-conserving lets only points touch that have closed: before, there is no problem; then, few points."""
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
        """Lengths times 2^5, forces times 2^5 too (moduli times 2^-5 in two dimensions): q and u scale, r scales."""
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
        for steps, said in (("10,", '"" is empty'), ("", '"" is empty'), ("5:3", '"5:3" ends before it begins'),
                            ("x", '"x" is neither'), ("1;2", '"1;2" is neither'), ("0", "step 0, the initial state"),
                            ("-4", "negative"), ("2:", '"2:" is neither'), ("99999999999999999999", "beyond all steps"),
                            ("31", "the run has 30 steps only")):
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

    # --- written by others ----------------------------------------------------------------------------------------------

    def example(self, d, points, constraints=0, seed=3):
        random = numpy.random.default_rng(seed)
        size = d * points + constraints
        half = random.uniform(-1, 1, (size, size))
        whole = half @ half.T + 0.1 * numpy.eye(size)
        whole = 0.5 * (whole + whole.T)
        rows = d * points
        return dict(d=d, W=whole[:rows, :rows], V=whole[:rows, rows:], R=whole[rows:, rows:],
                    q=random.uniform(-1, 1, rows) - numpy.tile([1.0] + [0.0] * (d - 1), points),
                    mu=random.uniform(0.1, 0.9, points), s=random.uniform(-1, 1, constraints))

    def write_matrix(self, group, array, form, whole=numpy.int32, real=numpy.float64):
        rows, columns = (array != 0.0).nonzero()
        if form == "csc":
            order = numpy.lexsort((rows, columns))
            rows, columns = rows[order], columns[order]
        x, count = array[rows, columns], len(rows)
        outer, inner, size = {"triplet": (rows, columns, 0), "csc": (columns, rows, array.shape[1]),
                              "csr": (rows, columns, array.shape[0])}[form]
        if form != "triplet":
            outer = numpy.concatenate([[0], numpy.cumsum(numpy.bincount(outer, minlength=size))])
        for name, value in (("nzmax", count), ("m", array.shape[0]), ("n", array.shape[1]),
                            ("nz", {"triplet": count, "csc": -1, "csr": -2}[form])):
            group[name] = numpy.array([value], dtype=whole)
        group["p"], group["i"], group["x"] = outer.astype(whole), inner.astype(whole), x.astype(real)

    def write_file(self, data, form, whole=numpy.int32, real=numpy.float64, name="hand.hdf5"):
        path = self.folder / name
        with h5py.File(path, "w") as file:
            local = file.create_group("fclib_local")
            local["spacedim"] = numpy.array([data["d"]], dtype=whole)
            for key in ("W", "V", "R") if len(data["s"]) else ("W",):
                self.write_matrix(local.create_group(key), data[key], form, whole, real)
            vectors = local.create_group("vectors")
            for key in ("q", "mu", "s") if len(data["s"]) else ("q", "mu"):
                vectors[key] = data[key].astype(real)
            local.create_group("info")["title"] = "by hand"  # a string of variable length
        return path

    def test_every_form_gives_the_same(self):
        for d in (2, 3):
            for constraints in (0, 3):
                data = self.example(d, 6, constraints)
                found = []
                for form in ("triplet", "csc", "csr"):
                    for whole, real in ((numpy.int32, numpy.float64), (numpy.int64, numpy.float64),
                                        (numpy.uint16, numpy.float64), (numpy.float64, numpy.float64)):
                        if whole is numpy.uint16 and form != "triplet":
                            continue  # -1 and -2 are no unsigned numbers
                        solved, process = self.solve(self.write_file(data, form, whole, real))
                        self.assertIn("by hand", process.stdout)
                        self.check_law(solved, solved.solution)
                        found.append(b"".join(solved.solution[key].tobytes() for key in sorted(solved.solution)))
                self.assertEqual(len(set(found)), 1)
                self.assertEqual("l" in solved.solution, constraints > 0)
                if constraints:
                    residual = solved.v.T @ solved.solution["r"] + solved.r @ solved.solution["l"] + solved.s
                    self.assertLessEqual(numpy.abs(residual).max(), 1e-12)

    def test_entries_with_room_behind_them(self):
        """Arrays of nzmax entries, of which the first are used: the rest is whatever was in memory."""
        data = self.example(3, 4, 2)
        expected = self.solve(self.write_file(data, "csc"))[0].solution
        for form in ("triplet", "csc", "csr"):
            for long in (("p", "i", "x"), ("x",), ("p",), ("i",)):
                path = self.write_file(data, form)
                with h5py.File(path, "a") as file:
                    for matrix_name in ("W", "V", "R"):
                        group = file["fclib_local"][matrix_name]
                        group["nzmax"][0] += 5
                        for name in long if form == "triplet" else set(long) - {"p"}:
                            values = group[name][()]
                            del group[name]
                            group[name] = numpy.concatenate(
                                [values, numpy.full(5, numpy.nan if name == "x" else -7, dtype=values.dtype)])
                solved, _ = self.solve(path)
                for name, values in expected.items():
                    self.assertEqual(values.tobytes(), solved.solution[name].tobytes(), (form, long))

    def test_data_sets_that_were_never_written(self):
        """FCLib writes them where it is given no array, as /solution/r of the file in its own tests."""
        data = self.example(3, 4)
        for options in ({}, {"chunks": (5,), "compression": "gzip"}):
            path = self.write_file(data, "csr")
            with h5py.File(path, "a") as file:
                file["solution/u"] = numpy.ones(12)
                self.assertEqual(file["solution"].create_dataset("r", (12,), "f8", **options).id.get_storage_size(), 0)
                self.assertEqual(file["fclib_local/info"].create_dataset("math_info", (), "S9").id.get_storage_size(), 0)
            solved, process = self.solve(path)
            self.check_law(solved, solved.solution)
            self.assertIn(f"warning: {path}: /solution/r: was never written", process.stderr)
            self.assertIn("a solution", self.expect_status(0, run("info", path)).stdout)
        with h5py.File(path, "a") as file:  # q = 0: the solution is zero, and so is what is read
            del file["fclib_local/vectors/q"]
            file["fclib_local/vectors"].create_dataset("q", (12,), "f8", fillvalue=-0.5)
        solved, process = self.solve(path)
        self.assertEqual(set(solved.q), {-0.5})
        self.assertIn("/fclib_local/vectors/q: was never written", process.stderr)
        self.check_law(solved, solved.solution)

    def test_data_sets_that_were_never_written_and_cannot_be_read(self):
        for rows, said in ((12, "was never written and has no fill value"),
                           (196608, "was never written, and its 196608 entries would take more room than the whole")):
            path = self.write_file(self.example(3, 4), "csc")
            with h5py.File(path, "a") as file:
                local = file["fclib_local"]
                properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
                if rows == 12:
                    properties.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
                else:  # W = 0 of so many rows takes next to no room
                    local["W/m"][0] = local["W/n"][0] = rows
                    del local["W/p"]
                    local["W"].create_dataset("p", data=numpy.zeros(rows + 1, dtype="i1"), compression="gzip")
                del local["vectors/q"]
                h5py.h5d.create(local["vectors"].id, b"q", h5py.h5t.IEEE_F64LE, h5py.h5s.create_simple((rows,)),
                                properties)
            process = self.expect_status(2, run("contact", path))
            self.assertIn(said, process.stderr)

    def test_texts_of_no_and_of_several_entries(self):
        titles = ((h5py.Empty("S1"), ""), (numpy.zeros(0, dtype="S3"), ""), (numpy.bytes_(b""), ""),
                  (numpy.array([b"one", b"two "]), "one\ntwo"), (["one", "two"], "one\ntwo"), ([["", "two"]], "two"),
                  (numpy.array([b"one", b""]), "one"))
        for value, text in titles:
            path = self.write_file(self.example(2, 3), "csc")
            with h5py.File(path, "a") as file:
                del file["fclib_local/info/title"]
                file["fclib_local/info/title"] = value
            solved, process = self.solve(path)
            found = solved.text("title") if "title" in solved.info else ""
            self.assertEqual(found.rstrip(), text)
            self.assertEqual(process.stderr, "")

    def test_single_precision(self):
        data = self.example(3, 6)
        solved, _ = self.solve(self.write_file(data, "csr", numpy.int64, numpy.float32))
        self.assertEqual(solved.w.tobytes(), data["W"].astype(numpy.float32).astype(numpy.float64).tobytes())
        self.check_law(solved, solved.solution)

    def test_every_solver(self):
        listed = self.expect_status(0, run("contact", "--list")).stdout
        names = [line.split()[0] for line in listed.splitlines()]
        self.assertIn("automatic", names)
        path = self.write_file(self.example(2, 8), "csc")
        for name in names:
            with self.subTest(name):
                process = run("contact", path, "--solver", name, "--tolerance", "1e-10", "--record")
                self.assertIn(process.returncode, (0, 3))
                self.assertIn("NOT SOLVED" if process.returncode else "solved", process.stdout)
                self.assertRegex(process.stdout, r"residual +\d")

    def test_what_is_not_solved_is_status_3_and_no_solution(self):
        """W is zero, and q penetrates: no reaction helps."""
        data = self.example(2, 4)
        data["W"][:] = 0.0
        solved, process = self.solve(self.write_file(data, "csc"), status=3)
        self.assertIn("NOT SOLVED", process.stdout)
        self.assertRegex(process.stderr, r"hand\.hdf5: the contact problem is not solved: .*residual")
        self.assertIsNone(solved.solution)
        self.assertEqual(len(solved.guesses), 1)
        self.assertIn("Ricochet: NOT SOLVED", solved.text("math_info"))

    def test_solving_a_solved_file_again(self):
        """What was said of the first solution is replaced; everything else stays, bit for bit."""
        path = self.write_file(self.example(3, 5, 2), "triplet")
        first, _ = self.solve(path)
        once = (self.folder / "solution.hdf5").read_bytes()
        self.expect_status(0, run("contact", self.folder / "solution.hdf5", "-o", self.folder / "solution.hdf5"))
        self.assertEqual((self.folder / "solution.hdf5").read_bytes(), once)
        self.assertEqual(first.text("math_info").count("Ricochet:"), 1)

    def test_info(self):
        path = self.write_file(self.example(3, 5, 2), "triplet")
        said = self.expect_status(0, run("info", path)).stdout
        for word in ("by hand", "5 in 3 dimensions, 2 equality constraints", "no solution"):
            self.assertIn(word, said)
        output = self.simulate(self.write("block.toml", block_case()))
        process = self.expect_status(2, run("info", output / "results.h5"))
        self.assertIn("no file of FCLib", process.stderr)

    def test_wrong_use(self):
        path = self.write_file(self.example(2, 2), "csc")
        for arguments, status, said in (((), 1, "--list"), ((path, "--solver", "best"), 1, "automatic"),
                                        ((path, "--tolerance", "-1"), 1, "--tolerance"),
                                        ((path, "--tolerance", "1"), 1, "--tolerance"),
                                        ((path, "--tolerance", "nan"), 1, "--tolerance"),
                                        ((self.folder / "none.hdf5",), 4, "no such file"),
                                        ((self.folder,), 4, "directory"),
                                        ((self.write("text.hdf5", "text"),), 2, "is not an HDF5 file"),
                                        ((path, "-o", self.folder / "no" / "x.hdf5"), 4, "cannot be written")):
            with self.subTest(arguments):
                process = self.expect_status(status, run("contact", *arguments))
                self.assertIn(said, process.stderr)

    def test_damaged_file(self):
        data = self.example(2, 4)
        data["W"][1, 2] += 0.5
        process = self.expect_status(2, run("contact", self.write_file(data, "csc")))
        self.assertRegex(process.stderr, r"hand\.hdf5: /fclib_local/W: is not symmetric: .* row 1 and column 2 ")

    def test_a_full_disk_leaves_nothing(self):
        path = self.write_file(self.example(3, 60), "csc")
        output = self.folder / "solution.hdf5"
        command = f"trap '' XFSZ; ulimit -f 8; exec '{PROGRAM}' contact '{path}' -o '{output}'"
        process = subprocess.run(["bash", "-c", command], text=True, capture_output=True)
        self.expect_status(4, process)
        self.assertIn("cannot write", process.stderr)
        self.assertEqual(sorted(item.name for item in self.folder.iterdir()), ["hand.hdf5"])


if __name__ == "__main__":
    unittest.main()
