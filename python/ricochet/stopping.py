"""SIGTERM and SIGHUP, which would end Python at once, end a run that a session writes as they end the program's: with a
checkpoint, and with the status 128 + their number."""

import os
import signal
import threading
import weakref

SIGNALS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]

_writing: weakref.WeakSet = weakref.WeakSet()


def attend(session):
    """From here on a signal ends what this session writes with a checkpoint. Handlers of the program's own stay, and only
    Python's main thread may have some."""
    _writing.add(session)
    if threading.current_thread() is threading.main_thread():
        for number in SIGNALS:
            if signal.getsignal(number) is signal.SIG_DFL:
                signal.signal(number, _stop)


def forget(session):
    """The session writes no more. After the last one signals do again what they did."""
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
    # One that is in the middle of a step writes its checkpoint after it, as after Ctrl-C.
    for session in list(_writing):
        session._keep_if_idle()
    raise SystemExit(128 + number)
