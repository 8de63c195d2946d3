"""Contact problems in FCLib files, read by h5py: their contents, whether a solution satisfies the contact law, and
their solution by `ricochet contact`. Shared by the tests of exported problems and of problems written by others."""

import h5py
import numpy

from harness import TestCase, run


def matrix(group):
    """Returns the matrix of a group as an array, in any of FCLib's storages."""
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
    """A problem in an FCLib file, read with h5py."""

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
    """Returns (normal components, tangential vectors)."""
    rows = vector.reshape(-1, d)
    return rows[:, 0], rows[:, 1:]


class ContactTestCase(TestCase):
    def check_law(self, problem, solution, tolerance=1e-9):
        """Checks u = W r + V l + q, and at every point that K* contains û, r is in K, and they are orthogonal."""
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

    def solve(self, path, *options, status=0):
        output = self.folder / "solution.hdf5"
        process = self.expect_status(status, run("contact", path, "-o", output, *options))
        return Problem(output), process
