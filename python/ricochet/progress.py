"""Progress of a run: a line on a terminal, a bar in a notebook, nothing elsewhere."""

import sys
import time
from contextlib import contextmanager


def in_notebook():
    shell = sys.modules.get("IPython")
    if shell is None or shell.get_ipython() is None:
        return False
    return type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"


def duration(seconds):
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = int(seconds / 60)
    return f"{minutes} min {int(seconds) % 60:02d} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60:02d} min"


class Progress:
    """Progress of a session from its present time."""

    def __init__(self, session):
        self.session, self.began, self.start = session, time.monotonic(), None
        self.open = self.silent = False

    def line(self, step, at):
        done = min(1.0, at / self.session.end) if self.session.end > 0 else 1.0
        if self.start is None:
            self.start = done
        seconds = time.monotonic() - self.began
        part = done - self.start
        left = f", {duration(seconds * (1 - done) / part)} left" if part > 0.02 and seconds > 1 else ""
        return done, f"step {step}, t = {at:.4g} of {self.session.end:.4g}{left}"

    def __call__(self, step, at):
        self.show(*self.line(step, at))

    def say(self, text):
        """Writes to stderr. If its terminal or the reader of its pipe is gone, the run continues silently."""
        if self.silent or sys.stderr is None:
            return
        try:
            sys.stderr.write(text)
            sys.stderr.flush()
        except (OSError, ValueError):
            self.silent = True

    def show(self, done, text):
        bar = "#" * int(20 * done)
        self.say(f"\r[{bar:<20}] {100 * done:3.0f} %  {text}\x1b[K")
        self.open = True

    def close(self):
        if self.open:
            self(self.session.step_number, self.session.time)
            self.say("\n")


class NotebookProgress(Progress):
    def __init__(self, session):
        super().__init__(session)
        self.display = None

    def show(self, done, text):
        from IPython.display import HTML, display

        page = HTML(f'<progress value="{done:.4f}" max="1" style="width: 20em"></progress> {100 * done:.0f} %, {text}')
        if self.display is None:
            self.display = display(page, display_id=True)
        else:
            self.display.update(page)
        self.open = True

    def close(self):
        if self.open:
            self(self.session.step_number, self.session.time)


def is_terminal(stream):
    try:
        return stream is not None and stream.isatty()
    except ValueError:  # the stream is closed
        return False


@contextmanager
def progress_of(wanted, session):
    """Yields the function that Session.run calls with step and time, or None."""
    notebook = in_notebook()
    if wanted is None:
        wanted = notebook or is_terminal(sys.stderr)
    if not wanted or session.is_complete_already:
        yield None
        return
    shown = NotebookProgress(session) if notebook else Progress(session)
    try:
        yield shown
    finally:
        shown.close()
