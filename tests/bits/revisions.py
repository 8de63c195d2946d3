"""Revisions of the project: the two that are compared, and the worktree in which the earlier one is built."""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build-bits"
SOURCE = FOLDER / "source"


def git(*arguments, root=ROOT):
    done = subprocess.run(["git", *arguments], cwd=root, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"./dev bits: git {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout.strip()


def is_dirty():
    """Returns whether the working tree has changes. New files count, as CMake compiles them."""
    return bool(git("status", "--porcelain"))


def commit(revision):
    """Returns the hash of a revision; by default of the commit that the working tree changes: HEAD, or the one
    before."""
    return git("rev-parse", "--verify", f"{revision or ('HEAD' if is_dirty() else 'HEAD~')}^{{commit}}")


def cases(revision):
    """Returns the case files of a commit."""
    paths = git("ls-tree", "-r", "--name-only", revision, "cases").splitlines()
    return {path for path in paths if path.count("/") == 2 and path.endswith(".toml")}


def check_out(revision):
    """Checks out this commit in the worktree. Identical files keep their times, so that little is recompiled."""
    if not (SOURCE / ".git").exists():
        git("worktree", "prune")
        git("worktree", "add", "--detach", "--force", str(SOURCE), revision)
    git("checkout", "--detach", "--force", revision, root=SOURCE)
    return SOURCE


def compile_programs(root, with_ranks):
    """Compiles build/ricochet and, if PETSc is available, build/ricochet-mpi."""
    options = ["-DRICOCHET_WITH_PETSC=ON"] if with_ranks else []
    targets = ["ricochet_program", *(["ricochet_mpi"] if with_ranks else [])]
    for command in (["cmake", "--preset", "release", *options],
                    ["cmake", "--build", "--preset", "release", "--target", *targets]):
        done = subprocess.run(command, cwd=root, check=False, capture_output=True, text=True)
        if done.returncode != 0:
            sys.stderr.write(done.stdout + done.stderr)
            raise SystemExit(f"./dev bits: {' '.join(command)} failed in {root}")
