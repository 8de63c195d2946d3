"""The contact solvers and the masses without a simulation, for matrices of numpy and scipy."""

import threading

import numpy
import pytest
import scipy.sparse
import scipy.sparse.linalg

import ricochet as rc

TOLERANCE = 1e-11


def problem(points, seed):
    random = numpy.random.default_rng(seed)
    a = random.normal(size=(3 * points, 3 * points))
    w = a @ a.T + 0.1 * numpy.eye(3 * points)
    q = random.normal(size=(points, 3))
    q[:, 0] -= 1.0
    return w, q.reshape(-1)


def require_laws(w, q, friction, found):
    """Checks Signorini's conditions and Coulomb's law, independently of the library."""
    u = (q + w @ found.reaction.reshape(-1)).reshape(-1, 3)
    r = found.reaction
    size = abs(q).max()
    assert abs(found.motion - u).max() < TOLERANCE * abs(w).max() * abs(r).max()
    normal, tangential = r[:, 0], numpy.linalg.norm(r[:, 1:], axis=1)
    assert (normal >= 0).all() and (u[:, 0] > -1e-9 * size).all()
    assert abs(normal * u[:, 0]).max() < 1e-8 * size * abs(r).max()
    assert (tangential <= friction * normal * (1 + 1e-12)).all()
    slip = numpy.linalg.norm(u[:, 1:], axis=1)
    # The dissipation is maximal: -r_T . u_T = F r_N |u_T|.
    assert (r[:, 1:] * u[:, 1:]).sum(axis=1) == pytest.approx(-friction * normal * slip, abs=1e-7 * size * abs(r).max())


@pytest.mark.parametrize("seed", range(20))
def test_solutions_meet_the_laws(seed):
    w, q = problem(6, seed)
    dense = rc.contact.solve(w, q, 0.3)
    require_laws(w, q, 0.3, dense)
    sparse = rc.contact.solve(scipy.sparse.csr_matrix(w), q, 0.3)
    require_laws(w, q, 0.3, sparse)
    assert sparse.reaction == pytest.approx(dense.reaction, rel=1e-6, abs=1e-8)
    product = rc.contact.solve(scipy.sparse.linalg.aslinearoperator(w), q, 0.3)
    require_laws(w, q, 0.3, product)


def test_every_solver_and_friction_per_point():
    w, q = problem(5, 3)
    friction = numpy.linspace(0.0, 0.6, 5)
    reference = rc.contact.solve(w, q, friction)
    require_laws(w, q, friction, reference)
    assert "gauss-seidel" in rc.contact.solver_names()
    for name in rc.contact.solver_names():
        found = rc.contact.solve(w, q, friction, solver=name, tolerance=1e-10, check=False)
        if found.outcome == "not applicable":
            assert name == "active-set" and found.reason  # it does not support friction
            continue
        assert found.solved, f"{name}: {found.reason}"
        assert found.reaction == pytest.approx(reference.reaction, rel=1e-5, abs=1e-6), name
    presses = reference.reaction[:, 0] > 0
    assert presses.any() and ((reference.status != rc.contact.OPEN) == presses).all()


def test_a_solver_goes_on_from_its_last_solution():
    w, q = problem(8, 4)
    solver = rc.contact.Solver(w, 0.3)
    first = solver.solve(q)
    again = solver.solve(q)
    assert again.iterations <= first.iterations
    assert again.reaction == pytest.approx(first.reaction)
    assert solver.solve(2 * q).reaction == pytest.approx(2 * first.reaction)
    assert first.reaction == pytest.approx(again.reaction), "a solution does not change later"


def test_two_and_one_rows_per_point():
    found = rc.contact.solve(numpy.eye(2), [-1.0, 0.5], 0.2, dimension=2)
    assert found.reaction.tolist() == [[1.0, -0.2]] and found.status[0] == rc.contact.SLIP
    assert rc.contact.solve([[2.0]], [-1.0], 0.0, dimension=1).reaction.tolist() == [[0.5]]


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((numpy.eye(4), numpy.zeros(4), 0.3), "multiple of the 3 rows"),
        ((numpy.eye(3), numpy.zeros(4), 0.3), "q has 4 numbers"),
        ((numpy.zeros((3, 2)), numpy.zeros(3), 0.3), "square"),
        ((numpy.array([[1, 0.5, 0], [0, 1, 0], [0, 0, 1.0]]), numpy.zeros(3), 0.3), "not symmetric"),
        ((scipy.sparse.csr_matrix([[1, 0.5, 0], [0, 1, 0], [0, 0, 1.0]]), numpy.zeros(3), 0.3), "not symmetric"),
        ((numpy.eye(3), numpy.zeros(3), -0.3), "must be zero or positive"),
        ((numpy.eye(3), numpy.zeros(3), [0.1, 0.2]), "one for each of the 1 points"),
    ],
)
def test_what_is_wrong_is_said(arguments, message):
    with pytest.raises(rc.InputError, match=message):
        rc.contact.solve(*arguments)


def test_what_is_not_solved_is_raised():
    for q in (numpy.array([numpy.nan, 0, 0]), numpy.array([numpy.inf, 0, 0])):
        with pytest.raises(rc.NotConvergedError):
            rc.contact.solve(numpy.eye(3), q, 0.3)
    # W is zero, so no reaction changes the motion of the pressed point.
    found = rc.contact.solve(numpy.zeros((3, 3)), [-1.0, 0, 0], 0.3, check=False)
    assert not found.solved and found.reason
    with pytest.raises(rc.InputError, match="unknown"):
        rc.contact.solve(numpy.eye(3), numpy.zeros(3), 0.3, solver="nothing")


def test_errors_of_products_are_raised():
    def product(x):
        raise RuntimeError("mine")

    operator = scipy.sparse.linalg.LinearOperator((3, 3), matvec=product, dtype=float)
    with pytest.raises(RuntimeError, match="mine"):
        rc.contact.solve(operator, [-1.0, 0, 0], 0.3)


def test_what_is_no_number_is_refused():
    eye = numpy.eye(3)
    for w, q, friction in ((eye * 1j, [-1.0, 0, 0], 0.3), (scipy.sparse.identity(3) * 1j, [-1.0, 0, 0], 0.3), (eye, "abc", 0.3),
                           (eye, [None, 0, 0], 0.3), (eye, [-1.0, 0, 0], "a"), (eye, [-1.0, 0, 0], None)):
        with pytest.raises(rc.InputError, match="real numbers"):
            rc.contact.solve(w, q, friction)
    with pytest.raises(rc.InputError, match="real numbers"):
        rc.contact.solve(scipy.sparse.linalg.LinearOperator((3, 3), matvec=lambda x: x * (1 + 1j), dtype=complex), [-1.0, 0, 0], 0.3)
    with pytest.raises(rc.InputError, match="scipy.sparse, not a ndarray"):
        rc.mass.build(eye, numpy.zeros((3, 2)), [0])
    with pytest.raises(rc.InputError, match="contact nodes: numbers of nodes must be integers, not float64"):
        rc.mass.build(scipy.sparse.identity(3), numpy.random.rand(3, 2), [0.5])


def test_products_may_keep_their_arguments():
    kept, copies = [], []

    def product(x):
        kept.append(x)
        copies.append(x.copy())
        return 2.0 * x

    for _ in range(20):
        operator = scipy.sparse.linalg.LinearOperator((30, 30), matvec=product, dtype=float)
        rc.contact.solve(operator, numpy.tile([-1.0, 0.2, 0.0], 10), 0.3)
    assert all((a == b).all() for a, b in zip(kept, copies))


def test_a_solver_is_for_one_thread():
    size = 300
    solver = rc.contact.Solver(numpy.eye(size) + 0.1, 0.3)
    q = numpy.random.default_rng(1).normal(size=size)
    expected = solver.solve(q).reaction
    solved, refused = [], []

    def work():
        for _ in range(30):
            try:
                solved.append(abs(solver.solve(q).reaction - expected).max())
            except rc.UsageError:
                refused.append(True)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(solved) + len(refused) == 120 and max(solved) < 1e-8


def test_masses_without_inertia_on_contact_nodes(cases):
    consistent = rc.Session(cases / "puck/puck.toml", {"mass.type": "consistent"})
    scalar = consistent.mass[::2, ::2]
    bottom = numpy.argsort(consistent.points[:, 1])[:5]
    for name in ("equivalent", "equivalent-nodewise", "equivalent-nearest", "lumped", "consistent"):
        built = rc.mass.build(scalar, consistent.points, bottom, name)
        matrix = built.matrix
        assert abs(matrix - matrix.T).max() == 0
        ones, places = numpy.ones(len(consistent.points)), consistent.points
        # Mass, centre of mass and moments of inertia are those of the body.
        for a in (ones, places[:, 0], places[:, 1]):
            for b in (ones, places[:, 0], places[:, 1]):
                if name == "lumped" and not (a is ones or b is ones):
                    continue
                assert a @ matrix @ b == pytest.approx(a @ scalar @ b, rel=1e-9, abs=1e-12 * scalar.sum())
        if name.startswith("equivalent"):
            assert matrix[bottom].nnz == 0
    assert built.construction


def test_the_mass_of_a_session_is_the_one_that_is_built(cases):
    whole = rc.Session(cases / "puck/puck.toml", {"mass.type": "equivalent-nodewise"})
    consistent = rc.Session(cases / "puck/puck.toml", {"mass.type": "consistent"})
    skin = numpy.flatnonzero(numpy.asarray(whole.mass[::2, ::2].sum(axis=1)).reshape(-1) == 0)
    built = rc.mass.build(consistent.mass[::2, ::2], consistent.points, skin, "equivalent-nodewise")
    assert abs(built.matrix - whole.mass[::2, ::2]).max() < 1e-14 * abs(whole.mass).max()


def test_wrong_masses():
    eye = scipy.sparse.identity(4, format="csc")
    with pytest.raises(rc.InputError, match="4 x 2 or 3"):
        rc.mass.build(eye, numpy.zeros((3, 2)), [0])
    with pytest.raises(rc.InputError, match="contact node 7"):
        rc.mass.build(eye, numpy.zeros((4, 2)), [7])
    with pytest.raises(rc.InputError, match="unknown"):
        rc.mass.build(eye, numpy.random.rand(4, 2), [0], "nothing")
