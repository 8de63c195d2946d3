"""A case that is open, step by step; and whole runs."""

import os

import numpy

from . import _core, stopping
from .arrays import numbers
from .case import Case
from .errors import Error, UsageError
from .files import file_access, library_path, path_of, write_whole
from .progress import progress_of
from .results import Run
from .sparse import csc


class Session(_core.Session):
    """A case that is open: step it, look at its state, change what acts, save and take up states. ::

        session = ricochet.Session("case.toml", {"time.step": 1e-4})
        while session.time < session.end:
            session.step()
            print(session.time, session.displacement[:, 1].min())

    `source`, `changes` and `mesh` are those of Case. Quantities are in the units of the case.

    The state, as views without copies: they always show the present state, and cannot be written to; copy what is to be kept.

    - `displacement`, `velocity`, `acceleration`: nodes x dimension, nodes in the order of `points`;
    - `reactions`: the normal force at each contact point, positive where it presses; `friction_reactions`: contact points x
      (dimension - 1), along the tangents of the point.

    The state, as copies:

    - `contact_status`: of each contact point, as ricochet.contact numbers it: OPEN, CLOSED, STICK, SLIP;
    - `gaps`: of each contact point, positive where it is open;
    - `contact_force`: nodes x dimension, the force of all contacts on each node;
    - `energies`: a dictionary of the parts of the energy account, by the names of history.csv;
    - `time`, `step_number`; `iterations`: of the contact solver in the last step; `at_end`: no step is left.

    The problem:

    - `dimension`; `points`: nodes x dimension, undeformed; `node_numbers`: the row of each node in the arrays of Run and Frame;
      `contact_points`: places of the contact points, undeformed;
    - `mass_built`: the type of the mass that was built;
    - `end`: the time at which the run ends; `steps`: until there, of adaptive steps if all were the longest;
    - `warnings`: all that were said for this session; `writes`: whether it writes a run; `is_complete_already`: whether the
      run that write_to was to go on with had come to its end.

    Errors: InputError for arrays that do not fit and names that the case does not have, UsageError for what comes too late or
    while another thread uses the session, NotConvergedError for a step without a solution; the state is then that before it.

    A session that writes (write_to) leaves a checkpoint, which `resume` goes on from, where Ctrl-C, SIGTERM, SIGHUP or an
    exception in the `each` of run() ends it. It is closed with finish(), or as a context::

        with ricochet.Session("case.toml") as session:
            session.write_to("out/a")
            session.run()
    """

    def __init__(self, source, changes=None, *, mesh=None):
        self.case = source if isinstance(source, Case) and changes is None and mesh is None else Case(source, changes, mesh=mesh)
        super().__init__(self.case._core, list(self.case.warnings))
        self.directory = None
        self._summary = None

    def run(self, each=None, *, progress=None):
        """Takes all steps that are left. `each` is called with this session after every one, and ends them where it returns
        False; what it raises ends them, too, with a checkpoint where the session writes. `progress`: None: where somebody looks; True, False."""
        # What comparisons of numpy's numbers give is False, too.
        call = None if each is None else lambda: not is_false(each(self))
        try:
            with progress_of(progress, self) as show:
                self._run(call, show)
        except BaseException:
            self._keep_if_idle()
            raise
        return self

    def _keep_if_idle(self):
        """A checkpoint, unless the run has ended or is in the middle of a step. What cannot be written is not told: something
        else has gone wrong first."""
        try:
            self._keep()
        except Error:
            pass

    def set_load(self, force):
        """A force that acts from now on besides the loads of the case, until it is set again: nodes x dimension, or one vector
        for all nodes. It enters the energy account as load_work."""
        super().set_load(numbers(force, "set_load"))

    def set_velocity(self, velocity):
        """Another velocity from now on, nodes x dimension, or one vector for all nodes, as an impulse at once would give."""
        super().set_velocity(numbers(velocity, "set_velocity"))

    def set_obstacle_velocity(self, obstacle, velocity, rotation_rate=None):
        """From now on this obstacle moves with a constant velocity, and a constant rate of its rotation vector where the case
        gives it a rotation, from where it is. The first call comes before the session starts."""
        rate = None if rotation_rate is None else numbers(rotation_rate, "set_obstacle_velocity: rotation_rate")
        super().set_obstacle_velocity(obstacle, numbers(velocity, "set_obstacle_velocity"), rate)

    def write_to(self, directory, *, force=False, resume=False, export_contact=""):
        """From here on the session writes what a run writes (history, fields, checkpoints, summary) into a directory.
        `force`: over a run that is there. `resume`: goes on with it. `export_contact`: steps whose contact problems are
        written as FCLib's files ("1:10")."""
        directory = library_path(directory, "write_to")
        kept = self.case.text is not None
        case_path = os.path.join(directory, "case.toml") if kept else ""
        if kept:
            self.case.refuse_to_replace(directory)
        self._write_to(directory, force, resume, True, export_contact, case_path, self.case.changes)
        self.directory = directory  # from here on it is to be finished
        stopping.attend(self)
        if kept and not self.is_complete_already:
            self.case.write(directory)

    def finish(self):
        """Ends what write_to has begun, and returns the Run. Before the last step the run is an interrupted one, with a
        checkpoint to go on from."""
        if self._summary is None:
            stopping.forget(self)
            self._summary = self._finish()
        return Run(self.directory)

    def __enter__(self):
        return self

    def __exit__(self, kind, problem, trace):
        if self.directory is None or self._summary is not None or not self.writes:
            return
        try:
            self.finish()
        except Error:
            if kind is None:
                raise

    def save(self, path=None):
        """The state, and what has been set, as bytes from which a session of the same case goes on with the same bits; with
        `path`, written to that file, too."""
        saved = self._save()
        if path is not None:
            write_whole(path_of(path, "save"), saved)
        return saved

    def resume(self, saved):
        """Before the first step: goes on from what save() gave, bytes or the path of a file."""
        if not isinstance(saved, (bytes, bytearray, memoryview)):
            with file_access(), open(path_of(saved, "resume"), "rb") as file:
                saved = file.read()
        self._resume(bytes(saved))

    @property
    def mass(self):
        """The mass matrix M, dofs x dofs, as a scipy.sparse.csc_matrix: dof k of node i is i * dimension + k."""
        return csc(self.mass_parts)

    def stiffness(self, *, at_state=False):
        """The tangent of the internal force at zero displacement, or at that of the state, as mass has it."""
        return csc(self.stiffness_parts(at_state))

    def __repr__(self):
        return f"<Session of {self.case!r}>"


def is_false(answer):
    return isinstance(answer, (bool, numpy.bool_)) and not answer


def run(source, directory, changes=None, *, mesh=None, each=None, force=False, resume=False, export_contact="", progress=None):
    """Runs a case into a directory, as `ricochet run` does, and returns the Run.

    `source`, `changes`, `mesh`: see Case. `each`, `progress`: see Session.run. `force`, `resume`, `export_contact`: see
    Session.write_to. Ctrl-C, SIGTERM, SIGHUP and an exception in `each` leave an interrupted run with a checkpoint, which `resume` goes on
    from. Expectations of the case that do not hold are warnings; Run.check() raises them.
    """
    if directory is None:
        raise UsageError("run: the directory of the results is needed")
    with Session(source, changes, mesh=mesh) as session:
        session.write_to(directory, force=force, resume=resume, export_contact=export_contact)
        session.run(each, progress=progress)
        finished = session.finish()
    finished._warn_of_expectations()
    return finished
