"""Ricochet: dynamics of elastic bodies that strike, rest on, slide along and leave obstacles.

    import ricochet as rc
    run = rc.run("case.toml", "out/a", {"time.step": 1e-4})
    run.history["contact_force_y"], run.maximum("von_mises"), run.frame(t=5e-5)["von_mises"]
"""

from . import _core, contact, mass
from ._core import set_log_level, set_thread_count, thread_count
from .case import Case
from .errors import Error, ExpectationError, FileAccessError, InputError, NotConvergedError, Place, UsageError
from .figures import plot, write_report
from .mesh import Mesh
from .pictures import picture
from .results import Frame, History, Maximum, Run, open
from .session import Session, run
from .studies import Study, open_study, study

__version__ = _core.version
scheme_names = _core.scheme_names
mass_names = _core.mass_names
case_schema = _core.case_schema

__all__ = ["Case", "Error", "ExpectationError", "FileAccessError", "Frame", "History", "InputError", "Maximum", "Mesh",
           "NotConvergedError", "Place", "Run", "Session", "Study", "UsageError", "case_schema", "contact", "mass", "mass_names", "open",
           "open_study", "picture", "plot", "run", "scheme_names", "set_log_level", "set_thread_count", "study", "thread_count",
           "write_report"]
