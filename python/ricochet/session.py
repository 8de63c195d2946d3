"""Sessions, which compute a case step by step, and complete runs."""

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
    """An open case: compute its steps, read its state, change loads and motions, save and resume states. ::

        session = ricochet.Session("case.toml", {"time.step": 1e-4})
        while session.time < session.end:
            session.step()
            print(session.time, session.displacement[:, 1].min())

    `source`, `changes` and `mesh` are those of Case. Quantities are in the units of the case.

    The state, as views without copies. They always show the present state and are read-only; copy values to keep them.

    - `displacement`, `velocity`, `acceleration`: nodes x dimension, nodes in the order of `points`;
    - `reactions`: normal force at each contact point, positive in compression; `friction_reactions`: contact points x
      (dimension - 1), along the tangents of the point.

    The state, as copies:

    - `contact_status`: status of each contact point, numbered as in ricochet.contact: OPEN, CLOSED, STICK, SLIP;
    - `gaps`: gap of each contact point, positive if it is open;
    - `contact_force`: nodes x dimension, the force of all contacts on each node that acted over the last step;
    - `energies`: a dictionary of the parts of the energy account, with the names of history.csv;
    - `time`, `step_number`; `iterations`: iterations of the contact solver in the last step; `at_end`: whether no step is left.

    The problem:

    - `dimension`; `points`: nodes x dimension, undeformed; `node_numbers`: the row of each node in the arrays of Run and Frame;
      `contact_points`: positions of the contact points, undeformed;
    - `mass_built`: type of the mass that was built;
    - `end`: time at which the run ends; `steps`: number of steps until then, for adaptive steps if all were the longest;
    - `warnings`: all warnings of this session; `writes`: whether it writes a run; `is_complete_already`: whether the run that
      write_to was to resume was already complete.

    Errors: InputError for arrays that do not fit and names that the case does not have; UsageError for calls that come too late
    or while another thread uses the session; NotConvergedError for a step without a solution, where the state is then the one
    before the step.

    A session that writes (write_to) leaves a checkpoint if Ctrl-C, SIGTERM, SIGHUP or an exception in the `each` of run() ends
    it; `resume` continues from there. Close it with finish(), or use it as a context::

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
        """Computes all remaining steps and returns this session. `each` is called with this session after every step; the run
        stops if it returns False. An exception in `each` also stops the run, with a checkpoint if the session writes. `progress`:
        whether to show the progress; None: on a terminal and in a notebook."""
        # numpy.bool_, the result of comparing numpy's numbers, counts as False, too.
        call = None if each is None else lambda: not is_false(each(self))
        try:
            with progress_of(progress, self) as show:
                self._run(call, show)
        except BaseException:
            self._keep_if_idle()
            raise
        return self

    def _keep_if_idle(self):
        """Writes a checkpoint, unless the run has ended or is in the middle of a step. Failure to write it is not reported, since
        another error came first."""
        try:
            self._keep()
        except Error:
            pass

    def set_load(self, force):
        """Sets a force that acts in addition to the loads of the case until it is set again: nodes x dimension, or one vector for
        every node. Its work enters the energy account as load_work."""
        super().set_load(numbers(force, "set_load"))

    def set_velocity(self, velocity):
        """Changes the velocity at once, as an impulse does: nodes x dimension, or one vector for every node."""
        super().set_velocity(numbers(velocity, "set_velocity"))

    def set_obstacle_velocity(self, obstacle, velocity, rotation_rate=None):
        """Moves an obstacle from its present position, with a constant velocity and, if the case defines a rotation for it, a
        constant rate of its rotation vector. The first call must precede the start of the session."""
        rate = None if rotation_rate is None else numbers(rotation_rate, "set_obstacle_velocity: rotation_rate")
        super().set_obstacle_velocity(obstacle, numbers(velocity, "set_obstacle_velocity"), rate)

    def write_to(self, directory, *, force=False, resume=False, export_contact=""):
        """Starts to write the files of a run (history, fields, checkpoints, summary) to a directory. `force`: replaces an existing
        run. `resume`: continues it. `export_contact`: steps whose contact problems are written as FCLib files ("1:10")."""
        directory = library_path(directory, "write_to")
        kept = self.case.text is not None
        case_path = os.path.join(directory, "case.toml") if kept else ""
        if kept:
            self.case.refuse_to_replace(directory)
        self._write_to(directory, force, resume, True, export_contact, case_path, self.case.changes)
        self.directory = directory  # from now on the run must be finished
        stopping.attend(self)
        if kept and not self.is_complete_already:
            self.case.write(directory)

    def finish(self):
        """Ends the writing that write_to started, and returns the Run. Before the last step the run is interrupted, with a
        checkpoint from which it can continue."""
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
        """Returns the state, with loads and motions that were set, as bytes from which a session of the same case continues with
        the same bits. With `path`, also writes them to that file."""
        saved = self._save()
        if path is not None:
            write_whole(path_of(path, "save"), saved)
        return saved

    def resume(self, saved):
        """Continues from the result of save(), bytes or the path of a file. Must be called before the first step."""
        if not isinstance(saved, (bytes, bytearray, memoryview)):
            with file_access(), open(path_of(saved, "resume"), "rb") as file:
                saved = file.read()
        self._resume(bytes(saved))

    @property
    def mass(self):
        """Mass matrix M, dofs x dofs, as a scipy.sparse.csc_matrix: dof k of node i is i * dimension + k."""
        return csc(self.mass_parts)

    def stiffness(self, *, at_state=False):
        """Returns the tangent of the internal force at zero displacement, or at that of the state, in the form of `mass`."""
        return csc(self.stiffness_parts(at_state))

    def __repr__(self):
        return f"<Session of {self.case!r}>"


def is_false(answer):
    return isinstance(answer, (bool, numpy.bool_)) and not answer


def run(source, directory, changes=None, *, mesh=None, each=None, force=False, resume=False, export_contact="", progress=None):
    """Runs a case, as `ricochet run` does, with its results in a directory, and returns the Run.

    `source`, `changes`, `mesh`: see Case. `each`, `progress`: see Session.run. `force`, `resume`, `export_contact`: see
    Session.write_to. Ctrl-C, SIGTERM, SIGHUP and an exception in `each` leave an interrupted run with a checkpoint; `resume`
    continues it. Expectations of the case that do not hold cause warnings; Run.check() raises an error for them.
    """
    if directory is None:
        raise UsageError("run: a directory for the results is required")
    with Session(source, changes, mesh=mesh) as session:
        session.write_to(directory, force=force, resume=resume, export_contact=export_contact)
        session.run(each, progress=progress)
        finished = session.finish()
    finished._warn_of_expectations()
    return finished
