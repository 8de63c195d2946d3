"""Revisions of the project: the two that are compared, and the worktree in which the earlier one is built."""

import hashlib
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from worktree import ROOT, Worktree

WORKTREE = Worktree("bits")
FOLDER = WORKTREE.folder
git = WORKTREE.git
check_out = WORKTREE.check_out
lock = WORKTREE.lock


def is_dirty():
    """Returns whether the working tree has changes. New files count, as CMake compiles them."""
    return bool(git("status", "--porcelain"))


def state():
    """Returns what the working tree contains: its commit and its changes, with the contents of new files."""
    new = hashlib.sha256()
    for name in filter(None, git("ls-files", "-z", "--others", "--exclude-standard").split("\0")):
        new.update(name.encode() + (ROOT / name).read_bytes())
    return git("rev-parse", "HEAD"), git("status", "--porcelain"), git("diff", "HEAD"), new.hexdigest()


def commit(revision):
    """Returns the hash of a revision; by default of the commit that the working tree changes: HEAD, or the one
    before."""
    return git("rev-parse", "--verify", f"{revision or ('HEAD' if is_dirty() else 'HEAD~')}^{{commit}}")


def cases(revision):
    """Returns the case files of a commit."""
    paths = git("ls-tree", "-r", "--name-only", revision, "cases").splitlines()
    return {path for path in paths if path.count("/") == 2 and path.endswith(".toml")}


def compile_programs(root, with_ranks):
    """Compiles build/ricochet and, if PETSc is available, build/ricochet-mpi."""
    options = ["-DRICOCHET_WITH_PETSC=ON"] if with_ranks else []
    if not (root / "build" / "CMakeCache.txt").exists():
        options.append("-DRICOCHET_BUILD_TESTS=OFF")  # GoogleTest may be missing
    targets = ["ricochet_program", *(["ricochet_mpi"] if with_ranks else [])]
    for command in (["cmake", "--preset", "release", *options],
                    ["cmake", "--build", "--preset", "release", "--target", *targets]):
        done = subprocess.run(command, cwd=root, check=False, capture_output=True, text=True)
        if done.returncode != 0:
            sys.stderr.write(done.stdout + done.stderr)
            raise SystemExit(f"./dev bits: {' '.join(command)} failed in {root}")
