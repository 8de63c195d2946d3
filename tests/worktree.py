"""A worktree of the repository below its root, in which another revision, or a changed copy, is built."""

import fcntl
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[1]


class Worktree:
    """The folder build-NAME/source. Errors begin with the command of ./dev that uses it."""

    def __init__(self, name):
        self.command = f"./dev {name}"
        self.folder = ROOT / f"build-{name}"
        self.source = self.folder / "source"

    def git(self, *arguments, root=ROOT):
        done = subprocess.run(["git", *arguments], cwd=root, check=False, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{self.command}: git {' '.join(arguments)}: {done.stderr.strip()}")
        return done.stdout.strip()

    def lock(self):
        """Stops if another process uses the folder. The lock ends with this process."""
        self.folder.mkdir(exist_ok=True)
        self.locked = (self.folder / "lock").open("w", encoding="utf-8")
        try:
            fcntl.flock(self.locked, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SystemExit(f"{self.command}: another one is running in {self.folder}; wait for its end") from None

    def check_out(self, revision):
        """Checks out this commit. Identical files keep their times, so that little is recompiled."""
        if not (self.source / ".git").exists():
            self.git("worktree", "prune")
            self.git("worktree", "add", "--detach", "--force", str(self.source), revision)
        self.git("checkout", "--detach", "--force", revision, root=self.source)
        return self.source
