#!/usr/bin/env python3
"""Writes the table of columns in docs/results.md anew from the program:

    docs/history_columns.py build/ricochet"""

import pathlib
import re
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parent / "results.md"
TABLE = re.compile(r"(?<=<!-- columns -->\n).*?(?=<!-- end -->)", re.S)


def written_table():
    return TABLE.search(PAGE.read_text(encoding="utf-8"))[0]


def documented_columns():
    """Returns [(name, components, unit, condition)] of the table, without links."""
    rows = re.findall(r"^\| `([^`]*?)(?:_[xz]`( …| \(in 3D three\))|`) \| ([^|]*) \| ([^|]*) \|", written_table(), re.M)
    return [(name, {" …": "vector", "": "one"}.get(more, "axial"), unit, re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", condition))
            for name, more, unit, condition in rows]


if __name__ == "__main__":
    printed = subprocess.run([sys.argv[1], "schema", "--columns"], check=True, capture_output=True, text=True).stdout
    PAGE.write_text(TABLE.sub(lambda match: printed, PAGE.read_text(encoding="utf-8")), encoding="utf-8")
