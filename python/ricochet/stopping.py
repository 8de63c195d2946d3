"""SIGTERM and SIGHUP, which would end Python at once, end a run that a session writes in the same way as a run of the program:
with a checkpoint, and with the status 128 + their number."""

import os
import signal
import threading
import weakref

SIGNALS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]

_writing: weakref.WeakSet = weakref.WeakSet()


def attend(session):
    """From now on a signal ends the run that this session writes with a checkpoint. Handlers that a program has set stay in effect;
    only Python's main thread may set handlers."""
    _writing.add(session)
    if threading.current_thread() is threading.main_thread():
        for number in SIGNALS:
            if signal.getsignal(number) is signal.SIG_DFL:
                signal.signal(number, _stop)


def forget(session):
    """Called when the session has ended its writing. After the last such session, signals have their former effect."""
    _writing.discard(session)
    if not _writing and threading.current_thread() is threading.main_thread():
        for number in SIGNALS:
            if signal.getsignal(number) is _stop:
                signal.signal(number, signal.SIG_DFL)


def _stop(number, _frame):
    if not _writing:
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
        return
    # A session in the middle of a step writes its checkpoint after the step, as after Ctrl-C.
    for session in list(_writing):
        session._keep_if_idle()
    raise SystemExit(128 + number)
