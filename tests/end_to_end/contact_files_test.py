"""Contact problems written by others: FCLib files that h5py writes with every storage of a matrix, solved by `ricochet
contact`; its results and refusals."""

import subprocess

import h5py
import numpy

from fclib_problem import ContactTestCase
from harness import PROGRAM, block_case, run


class Files(ContactTestCase):
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
        """Arrays of nzmax entries, of which only the first are used: the rest is uninitialized memory."""
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
        """FCLib writes them if it is given no array, as /solution/r of the file in its own tests."""
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
        with h5py.File(path, "a") as file:  # q = 0: the solution is zero, and so are the data read
            del file["fclib_local/vectors/q"]
            file["fclib_local/vectors"].create_dataset("q", (12,), "f8", fillvalue=-0.5)
        solved, process = self.solve(path)
        self.assertEqual(set(solved.q), {-0.5})
        self.assertIn("/fclib_local/vectors/q: was never written", process.stderr)
        self.check_law(solved, solved.solution)

    def test_data_sets_that_were_never_written_and_cannot_be_read(self):
        for rows, said in ((12, "was never written and has no fill value"),
                           (196608, "was never written, and its 196608 entries would need more space than the whole")):
            path = self.write_file(self.example(3, 4), "csc")
            with h5py.File(path, "a") as file:
                local = file["fclib_local"]
                properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
                if rows == 12:
                    properties.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
                else:  # W = 0 of so many rows takes almost no space
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
        """The data of the first solution are replaced; everything else stays, bit for bit."""
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
        self.assertIn("not an FCLib file", process.stderr)

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
