"""A worktree of the repository below its root, in which another revision, or a changed copy, is built."""

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

    def check_out(self, revision):
        """Checks out this commit. Identical files keep their times, so that little is recompiled."""
        if not (self.source / ".git").exists():
            self.git("worktree", "prune")
            self.git("worktree", "add", "--detach", "--force", str(self.source), revision)
        self.git("checkout", "--detach", "--force", revision, root=self.source)
        return self.source
