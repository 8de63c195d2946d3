"""Contents of a tutorial, and its execution as by its reader: blocks that name a file are written, commands are run in
their order, and their output is compared with that on the page.

A fenced block whose first line is a comment with nothing but a file's name is that file. In a block of `console`, lines
that begin with "$ " are commands; the lines below are their output. A line that is "…" stands for any lines, "…" within
a line for any text. Numbers agree if they do to the digits shown, give or take one of the last; whole numbers of one or
two digits, which count something, if they are equal.

"```console needs NAME" states that the commands of this block need NAME, a program or a module of Python: if it is not
installed they are left out."""

import dataclasses
import decimal
import functools
import os
import pathlib
import re
import shutil
import subprocess
import time

FENCE = re.compile(r"^```(\w*)(?: needs ([\w.-]+))?[^\n]*\n(.*?)^```$", re.S | re.M)
NAME = re.compile(r"^(?:#|//|\*\*)\s*([\w./-]+\.(?:toml|py|cpp|txt|geo|inp|csv|msh))\s*$")
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d[\d,]*\.?\d*(?:e[-+]?\d+)?")
ANYTHING = "…"


@dataclasses.dataclass
class Command:
    text: str
    shown: list[str]
    needs: str = ""


@dataclasses.dataclass
class File:
    name: str
    text: str


def read(page):
    """Returns the files and commands of a page, in their order."""
    steps = []
    for kind, needs, body in FENCE.findall(pathlib.Path(page).read_text(encoding="utf-8")):
        if kind == "console":
            steps += commands(body, needs)
            continue
        name = NAME.match(body.split("\n", 1)[0])
        if name:
            steps.append(File(name.group(1), body))
        elif kind in ("sh", "bash", "python", "toml", "cpp", "cmake"):
            raise AssertionError(f"{page}: no test runs this block of {kind}; name its file, or write it as console:\n{body}")
    return steps


def commands(body, needs):
    result = []
    lines = iter(body.splitlines())
    for line in lines:
        if line.startswith("$ "):
            text = line[2:]
            while text.endswith("\\"):
                text = text[:-1].rstrip() + " " + next(lines).strip()
            result.append(Command(text, [], needs))
        elif result:
            result[-1].shown.append(line)
        else:
            raise AssertionError(f"a console block begins without a command: {line}")
    return result


def same_number(shown, found):
    def value(text):
        return decimal.Decimal(text.replace(",", "").replace("−", "-"))

    a, b = value(shown), value(found)
    if re.fullmatch(r"[-+−]?\d{1,2}", shown) and re.fullmatch(r"[-+−]?\d+", found):
        return a == b
    if a == 0:
        return abs(b) < decimal.Decimal("1e-12") or a == b
    return abs(a - b) <= decimal.Decimal(1).scaleb(a.as_tuple().exponent) * decimal.Decimal("1.0000001")


def agrees(shown, found):
    """Returns whether a printed line agrees with one that the page shows."""
    shown, found = " ".join(shown.split()), " ".join(found.split())
    parts = [part for part in re.split(f"({ANYTHING}|{NUMBER.pattern})", shown) if part]

    @functools.cache
    def agree_from(number, at):
        if number == len(parts):
            return at == len(found)
        part = parts[number]
        if part == ANYTHING:
            return any(agree_from(number + 1, end) for end in range(at, len(found) + 1))
        if NUMBER.fullmatch(part):
            there = NUMBER.match(found, at)
            return there is not None and same_number(part, there.group(0)) and agree_from(number + 1, there.end())
        return found.startswith(part, at) and agree_from(number + 1, at + len(part))

    return agree_from(0, 0)


def difference(shown, printed):
    """Returns None if the lines printed are those that the page shows; else the difference."""
    at, free = 0, False
    for line in shown:
        if line.strip() == ANYTHING:
            free = True
            continue
        if not line.strip():
            continue
        while at < len(printed) and (not printed[at].strip() or free and not agrees(line, printed[at])):
            at += 1
        if at == len(printed) or not agrees(line, printed[at]):
            return f"the page shows\n    {line}\nwhere there is\n    " + (printed[at] if at < len(printed) else "nothing more")
        at, free = at + 1, False
    rest = [line for line in printed[at:] if line.strip()]
    return None if free or not rest else "the page does not show\n    " + "\n    ".join(rest[:5])


def is_installed(name, environment):
    import_it = ["python3", "-c", f"import {name}"]
    return shutil.which(name, path=environment["PATH"]) is not None or (
        name.isidentifier() and subprocess.run(import_it, env=environment, stderr=subprocess.DEVNULL).returncode == 0)


def run(page, folder, environment):
    """Runs a page in an empty folder. Yields (command, seconds, output, error: None if there is none)."""
    for step in read(page):
        if isinstance(step, File):
            path = folder / step.name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(step.text, encoding="utf-8")
            continue
        if step.needs and not is_installed(step.needs, environment):
            yield f"{step.text}   (left out: {step.needs} is not installed)", 0.0, "", None
            continue
        begin = time.monotonic()
        outcome = subprocess.run(["bash", "-c", step.text], cwd=folder, env=environment, stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, text=True)
        problem = f"ended with status {outcome.returncode}" if outcome.returncode else difference(step.shown, outcome.stdout.splitlines())
        yield step.text, time.monotonic() - begin, outcome.stdout, problem


def environment_of(program, build, folder):
    """Returns an environment in which `ricochet` is this program, `python3` is Debian's, and CMake finds the
    installation below the folder."""
    tools = folder / "tools"
    tools.mkdir()
    (tools / "ricochet").symlink_to(program)
    return {**os.environ, "PATH": f"{tools}:/usr/bin:/bin", "PYTHONPATH": str(pathlib.Path(build) / "python"), "MPLBACKEND": "Agg",
            "CMAKE_PREFIX_PATH": str(folder / "prefix"), "OPENBLAS_NUM_THREADS": "1", "COLUMNS": "120"}
