"""Does what a newcomer does: clones HEAD into a separate minimal Debian 12, and runs the commands of `./dev` there.

Prints one line for each part, with its time and result. A part that fails does not stop the others; the status is then 1.
The output of each part goes into FOLDER; without --logs, its end is printed if the part fails. Nothing else is left behind.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time

from minimal_root import MinimalRoot, Steps, fail, require_root

SOURCE = pathlib.Path(__file__).resolve().parent.parent
# The README's two commands first, as it has them.
PARTS = {"demo": "./dev demo", "test": "./dev test", "mpi": "./dev test --mpi", "package": "./dev package --try"}
CLONE = "/root/ricochet"
LINES_SHOWN = 60
GIGABYTES = 10


def git(*arguments):
    """Returns git's output for this checkout, as bytes. It works for the owner alone, who need not be root."""
    owner = SOURCE.stat()
    process = subprocess.run(["git", "-C", SOURCE, *arguments], user=owner.st_uid, group=owner.st_gid, extra_groups=[],
                             env={**os.environ, "HOME": "/nonexistent"}, capture_output=True)
    if process.returncode != 0:
        fail(f"git {arguments[0]}: {process.stderr.decode(errors='replace').strip()}")
    return process.stdout


def clone(root):
    """Clones HEAD, as a newcomer would; returns its commit and a note about uncommitted changes."""
    target = root.path / CLONE.lstrip("/")
    bundle = root.folder / "head.bundle"
    bundle.write_bytes(git("bundle", "create", "--quiet", "-", "HEAD"))
    subprocess.run(["git", "-c", "advice.detachedHead=false", "clone", "--quiet", bundle, target], check=True)
    changed = git("status", "--porcelain").splitlines()
    note = f"; {len(changed)} files here have uncommitted changes, which are not tested" if changed else ""
    return git("log", "-1", "--format=%h %s").decode(errors="replace").strip() + note


def attempt(root, name, logs):
    """Runs a part and returns its exit status."""
    before = time.monotonic()
    process = root.attempt(PARTS[name], directory=CLONE, shell=("bash", "-c"))
    outcome = "done" if process.returncode == 0 else f"FAILED with status {process.returncode}"
    if logs:
        log = logs / f"{name}.log"
        log.write_text(process.stdout, encoding="utf-8")
        outcome += f", see {log}"
    print(f"{time.monotonic() - before:7.1f} s  {PARTS[name]}: {outcome}", flush=True)
    if process.returncode != 0 and not logs:
        print("\n".join(process.stdout.splitlines()[-LINES_SHOWN:]), file=sys.stderr, flush=True)
    return process.returncode


def main():
    parser = argparse.ArgumentParser(prog="./dev fresh", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help="demo, test, mpi or package (default: all)")
    parser.add_argument("--logs", type=pathlib.Path, metavar="FOLDER", help="folder for the output of each part")
    parser.add_argument("--check", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if unknown := [part for part in arguments.parts if part not in PARTS]:
        parser.error(f"there is no part {unknown[0]}; available: {', '.join(PARTS)}")
    if arguments.check:
        return 0
    require_root()
    if arguments.logs:
        arguments.logs.mkdir(parents=True, exist_ok=True)
    steps = Steps()
    root = MinimalRoot()
    steps("a minimal Debian 12", lambda: root.__enter__() and None)
    try:
        if shutil.disk_usage(root.path).free < GIGABYTES * 1e9:
            fail(f"{root.path} needs {GIGABYTES} GB of free disk: set TMPDIR to a folder with more room")
        steps("a clean clone", lambda: clone(root))
        chosen = [part for part in PARTS if part in arguments.parts] or list(PARTS)
        failed = [name for name in chosen if attempt(root, name, arguments.logs) != 0]
    finally:
        root.__exit__()
    steps.end()
    return 1 if failed else 0


sys.exit(main())
