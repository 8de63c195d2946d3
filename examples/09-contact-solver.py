"""The contact solver by itself, on random problems.

Physics: without friction r minimizes 1/2 r W r + q r over r >= 0, which scipy's nnls solves with the Cholesky factor of W. With friction
Coulomb's law must hold at every point: the force is in the friction cone, nothing penetrates, and friction opposes the slip.

The example shows: rc.contact.solve and Solver with dense and scipy.sparse matrices, warm starts, checks of a solution without a solver.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np
import scipy.linalg
import scipy.optimize
import scipy.sparse as sparse

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/09-contact-solver")
out.mkdir(parents=True, exist_ok=True)
random = np.random.default_rng(1)

# Without friction, one row per point, compared with scipy.
n = 60
A = random.standard_normal((n, n))
W, q = A @ A.T / n + 0.1 * np.eye(n), random.standard_normal(n)
found = rc.contact.solve(W, q, 0.0, dimension=1)
L = scipy.linalg.cholesky(W, lower=True)
reference, _ = scipy.optimize.nnls(L.T, -scipy.linalg.solve_triangular(L, q, lower=True))
difference = abs(found.reaction.ravel() - reference).max() / reference.max()
print(f"frictionless, {n} points: differs from scipy's nnls by {difference:.1e}")
assert difference < 1e-8

# With friction, three rows per point and a sparse matrix: a chain of points, each coupled to its neighbours.
points, F = 400, 0.6
blocks = sparse.diags([-0.4, 1.0, -0.4], [-1, 0, 1], shape=(points, points))
turn = random.standard_normal((3, 3))
W = sparse.kron(blocks, turn @ turn.T / 3 + np.eye(3)).tocsc()
W = ((W + W.T) / 2).tocsc()
solver = rc.contact.Solver(W, F)
q = random.standard_normal(3 * points)
counts = []
for _ in range(10):  # the loads change a little: each solution is the initial guess of the next one
    found = solver.solve(q)
    assert np.allclose(found.motion.ravel(), q + W @ found.reaction.ravel(), atol=1e-12)
    counts.append(found.iterations)
    q = q + 0.02 * random.standard_normal(q.size)
    assert found.solved, found.reason

normal, tangential = found.reaction[:, 0], np.linalg.norm(found.reaction[:, 1:], axis=1)
gap, slip = found.motion[:, 0], np.linalg.norm(found.motion[:, 1:], axis=1)
size, motion = normal.max(), abs(found.motion).max()
against = np.einsum("ij,ij->i", found.reaction[:, 1:], found.motion[:, 1:]) + tangential * slip
slips, sticks = found.status == rc.contact.SLIP, found.status == rc.contact.STICK
print(f"{points} points: {sticks.sum()} stick, {slips.sum()} slip, {(found.status == rc.contact.OPEN).sum()} are open; "
      f"residual {found.residual:.1e}, iterations {counts}")
assert normal.min() >= -1e-10 * size and gap.min() >= -1e-10 * motion, "a point pulls or penetrates"
assert abs(normal * gap).max() < 1e-10 * size * motion, "an open point has a force"
assert (tangential <= F * normal + 1e-10 * size).all(), "a force leaves the cone"
assert against.max() < 1e-10 * size * motion and slip[sticks].max() < 1e-10 * motion, "friction is not against the slip"
assert np.allclose(tangential[slips], F * normal[slips], atol=1e-10 * size)

figure, axes = plt.subplots(figsize=(5, 3.4), constrained_layout=True)
axes.fill_between([0, size], [0, 0], [0, F * size], color="0.92", label="cone of friction")
for name, chosen in (("stick", sticks), ("slip", slips)):
    axes.plot(normal[chosen], tangential[chosen], ".", label=name)
axes.set(xlabel="normal reaction", ylabel="size of the friction")
axes.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
