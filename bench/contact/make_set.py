"""Makes the benchmark's problems for run.py: meshes, case files, runs with --export-contact, rescaled copies.

DIRECTORY/problems/NAME-sSTEP.hdf5 are the problems, DIRECTORY/sequences/NAME/step-*.hdf5 the time sequences. A case is
run again only if its file or the program has changed.
"""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

import fclib
from case_table import CASES, DENSITY, MESHES, POISSON, YOUNG

ROOT = pathlib.Path(__file__).resolve().parents[2]


def make_mesh(name, directory):
    path = directory / f"{name}.msh"
    source, dimension, values = MESHES[name]
    arguments = []
    if source.endswith(".geo"):
        geometry = ROOT / source
        for key, value in values.items():
            arguments += ["-setnumber", key, repr(value)]
    else:
        geometry = directory / f"{name}.geo"
        text = source.format(**values)
        if not geometry.exists() or geometry.read_text() != text:
            geometry.write_text(text)
            path.unlink(missing_ok=True)
    if not path.exists():
        command = ["gmsh", str(geometry), f"-{dimension}", *arguments, "-format", "msh41", "-bin", "-o", str(path)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0 or not path.exists():
            sys.exit(f"gmsh failed on {geometry}:\n{done.stdout}{done.stderr}")
    return path


def vector(values):
    return "[" + ", ".join(json.dumps(value) for value in values) + "]"


def case_text(case, mesh, steps):
    """Returns the case file, written by hand so that the set does not depend on a TOML writer."""
    dimension = case.dimension
    lines = [f'title = "{case.name}"', "[mesh]", f'file = "{mesh}"', f"degree = {case.degree}", "[[material]]"]
    group = "ball" if case.mesh.startswith("ball") else "body"
    lines += [f'group = "{group}"', f"density = {DENSITY}", f"young = {YOUNG}", f"poisson = {POISSON}"]
    contacts = case.contacts or [("base", "floor")]
    for obstacle in sorted({obstacle for _, obstacle in contacts}):
        up = [0.0] * (dimension - 1) + [1.0]
        point, normal = [0.0] * dimension, up
        if obstacle in ("left", "right"):  # planes of the groove, 0.1 mm from the disc
            side = -1.0 if obstacle == "left" else 1.0
            point, normal = [side * 0.0201 / 2**0.5, -0.0201 / 2**0.5], [-side, 1.0]
        lines += [f"[obstacle.{obstacle}]", 'type = "plane"', f"point = {vector(point)}", f"normal = {vector(normal)}"]
        if case.belt:
            lines.append(f"velocity = {vector(case.belt)}")
        if case.spin:
            lines.append(f"rotation_rate = {case.spin}")
    for group, obstacle in contacts:
        lines += ["[[contact]]", f'group = "{group}"', f'obstacle = "{obstacle}"', f"friction = {case.friction}",
                  f'multipliers = "{case.multipliers}"']
    if case.top:
        lines += ["[[traction]]", 'group = "top"', f"value = {vector(case.top)}"]
    if case.gravity:
        lines += ["[load]", f"gravity = {vector(case.gravity)}"]
    if case.velocity or case.displacement:
        lines.append("[initial]")
        if case.displacement:
            lines.append(f'displacement = "{case.displacement}"')
        if case.velocity:
            lines.append(f"velocity = {vector(case.velocity)}")
    lines += ["[mass]", f'type = "{case.mass}"', "[time]"]
    lines += [f"{key} = {json.dumps(value)}" for key, value in case.time.items()]
    lines += [f"end = {case.time['step'] * steps!r}", "[output]", "fields_every = 0", ""]
    return "\n".join(lines)


def run_case(case, program, directory, stamp):
    """Returns the error, or an empty text."""
    mesh = make_mesh(case.mesh, directory / "meshes")
    wanted = list(case.steps) + (list(range(case.sequence[0], case.sequence[1] + 1)) if case.sequence else [])
    text = case_text(case, mesh, max(wanted))
    runs, problems = directory / "runs" / case.name, directory / "problems"
    key = hashlib.sha256(f"{text}{sorted(set(wanted))}{case.rescaled}{stamp}".encode()).hexdigest()
    done = runs / "done"
    if done.exists() and done.read_text() == key:
        return ""
    for old in problems.glob(f"{case.name}-s*.hdf5"):
        old.unlink()
    shutil.rmtree(runs, ignore_errors=True)
    runs.mkdir(parents=True)
    (runs / "case.toml").write_text(text)
    ranges = ",".join(map(str, case.steps)) + (f",{case.sequence[0]}:{case.sequence[1]}" if case.sequence else "")
    command = [program, "run", str(runs / "case.toml"), "-o", str(runs / "out"), "--force", "--quiet", "--log-level", "error",
               "--export-contact", ranges, "--set", "solver.contact_points=all"]  # all problems of one size
    result = subprocess.run(command, capture_output=True, text=True)
    for step in case.steps:
        source = runs / "out" / "contact" / f"step-{step:06d}.hdf5"
        if not source.exists():
            return f"{case.name}: no problem of step {step}: {result.stderr.strip()}"
        target = problems / f"{case.name}-s{step}.hdf5"
        shutil.copyfile(source, target)
        for suffix, (of_offset, of_operator) in case.rescaled.items():
            problem = fclib.read(source)
            problem.offset = problem.offset * of_offset
            problem.operator = problem.operator * of_operator
            fclib.write(problems / f"{case.name}-s{step}-{suffix}.hdf5", problem, f"{case.name}, {suffix}")
    if case.sequence:
        target = directory / "sequences" / case.name
        shutil.rmtree(target, ignore_errors=True)
        target.mkdir(parents=True)
        for step in range(case.sequence[0], case.sequence[1] + 1):
            source = runs / "out" / "contact" / f"step-{step:06d}.hdf5"
            if not source.exists():
                return f"{case.name}: no problem of step {step} of the sequence: {result.stderr.strip()}"
            os.replace(source, target / source.name)
    shutil.rmtree(runs / "out" / "contact")
    done.write_text(key)
    return ""


def make(program, directory, only=""):
    """Makes all missing problems of the cases with `only` in their name."""
    for name in ("meshes", "runs", "problems", "sequences"):
        (directory / name).mkdir(parents=True, exist_ok=True)
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    failures = []
    for case in CASES:
        if only not in case.name:
            continue
        begin = time.perf_counter()
        failure = run_case(case, program, directory, version)
        print(f"{time.perf_counter() - begin:6.1f} s  {case.name}", file=sys.stderr, flush=True)
        if failure:
            failures.append(failure)
    problems = list((directory / "problems").glob("*.hdf5"))
    size = sum(path.stat().st_size for path in directory.rglob("*") if path.is_file())
    print(f"{len(problems)} problems, {size / 1e6:.0f} MB in {directory}", file=sys.stderr)
    if failures:
        sys.exit("\n".join(failures))
