"""Tables of pages of docs/ that benchmarks and `ricochet schema` write, and the kernels of OpenBLAS, on which times depend."""

import os
import pathlib
import re
import subprocess
import sys


def write_parts(page, parts):
    """Puts each part of {name: text} between the marks <!-- name --> and <!-- end --> of the page."""
    text = page.read_text(encoding="utf-8")
    for name, content in parts.items():
        pattern = re.compile(f"(<!-- {name} -->\n).*?(<!-- end -->)", re.S)
        if not pattern.search(text):
            raise SystemExit(f"{page}: the mark <!-- {name} --> is missing")
        text = pattern.sub(lambda match: match[1] + content + "\n" + match[2], text)
    page.write_text(text, encoding="utf-8")


def documented_columns():
    """Returns [(name, components, unit, condition)] of the table of columns in docs/results.md, without links."""
    page = pathlib.Path(__file__).resolve().parents[1] / "docs" / "results.md"
    table = re.search(r"<!-- columns -->\n(.*?)<!-- end -->", page.read_text(encoding="utf-8"), re.S)[1]
    rows = re.findall(r"^\| `([^`]*?)(?:_[xz]`( …| \(in 3D three\))|`) \| ([^|]*) \| ([^|]*) \|", table, re.M)
    return [(name, {" …": "vector", "": "one"}.get(more, "axial"), unit, re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", condition))
            for name, more, unit, condition in rows]


def libraries(program):
    """Returns the second line of `ricochet --version`: libraries, and the kernels of OpenBLAS and of ours."""
    return subprocess.run([str(program), "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[1]


def blas_kernels(text):
    """Returns OpenBLAS' kernels from the text of `libraries`."""
    return re.match(r"OpenBLAS \S+ \((\w+)\)", text)[1]


def with_kernels(kernels):
    """Returns the environment in which another program's OpenBLAS uses these kernels."""
    return os.environ | {"OPENBLAS_CORETYPE": kernels}


def processor():
    """Returns the name of this machine's processor."""
    return next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown processor")


if __name__ == "__main__":  # PAGE NAME < TEXT
    write_parts(pathlib.Path(sys.argv[1]), {sys.argv[2]: sys.stdin.read().rstrip("\n")})
