"""Executes packaging/Containerfile in a minimal Debian 12, and uses the result: a case, a report, a figure, a mesh.

usage: try_containerfile.py FOLDER    FOLDER: with the .deb files
"""

import json
import pathlib
import shutil
import sys

from minimal_root import MinimalRoot, Steps, fail, require_root

SOURCE = pathlib.Path(__file__).resolve().parent.parent
KNOWN = ("FROM", "COPY", "RUN", "ENV", "WORKDIR", "ENTRYPOINT", "CMD")


def instructions():
    text = (SOURCE / "packaging" / "Containerfile").read_text(encoding="utf-8").replace("\\\n", " ")
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    found = [tuple(line.split(None, 1)) for line in lines]
    unknown = [word for word, _ in found if word not in KNOWN]
    if unknown or found[0] != ("FROM", "debian:bookworm-slim"):
        fail(f"packaging/Containerfile has an instruction that this program does not support: {unknown or found[0]}")
    return found


def copy(root, context, rest):
    *patterns, target = rest.split()
    folder = root.path / target.lstrip("/")
    folder.mkdir(parents=True, exist_ok=True)
    for pattern in patterns:
        files = sorted(context.glob(pattern))
        if not files:
            fail(f"{context} has no {pattern}: run ./dev package to make them")
        for file in files:
            shutil.copy(file, folder)


def build(root, context, steps):
    """Returns the initial state of the container: variables, folder, program."""
    variables, folder, program = {}, "/", []
    for word, rest in instructions():
        if word == "COPY":
            copy(root, context, rest)
        elif word == "RUN":
            steps(f"RUN {rest[:60]} ...", lambda: root.run(rest, folder, variables) and None)
        elif word == "ENV":
            variables |= dict([rest.split("=", 1)])
        elif word == "WORKDIR":
            folder = rest
            (root.path / rest.lstrip("/")).mkdir(exist_ok=True)
        elif word == "ENTRYPOINT":
            program = json.loads(rest)
    return variables, folder, " ".join(program)


def use(root, steps, variables, folder, program):
    for name in ("cases/incline/block.geo", "cases/puck/puck.toml", "cases/puck/puck.msh"):
        shutil.copy(SOURCE / name, root.path / folder.lstrip("/"))

    def do(text, command):
        steps(text, lambda: root.run(command, folder, variables) and None)

    do("the program", f"{program} --version")
    do("a case", f"{program} run puck.toml -o out/puck --set time.end=2e-5 --quiet")
    do("a report", f"{program} report out/puck && test -s out/puck/report.html")
    do("a figure", f"{program} plot out/puck --what energy -o energy.pdf && test -s energy.pdf")
    do("a geometry and a mesh of another format",
       f"gmsh -2 -format vtk -o block.vtk block.geo >/dev/null && {program} info block.vtk && ls $RICOCHET_CACHE | grep -q .")


def main():
    if len(sys.argv) != 2:
        fail("usage: try_containerfile.py FOLDER")
    require_root()
    steps = Steps()
    root = MinimalRoot()
    steps("a minimal Debian 12", lambda: root.__enter__() and None)
    try:
        use(root, steps, *build(root, pathlib.Path(sys.argv[1]), steps))
    finally:
        root.__exit__()
    steps.end()


main()
