"""A tutorial is run as its reader does: the files that it names are written, the commands run, what they print compared.

    tutorials_test.py PAGE.md                 # the test
    tutorials_test.py PAGE.md --pictures      # also puts the pictures that the page shows into docs/figures/tutorials
    tutorials_test.py PAGE.md --print         # shows what every command prints, for who writes one
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from harness import PROGRAM, SOURCE
from tutorial_pages import environment_of, run

BUILD_DIR = os.environ["RICOCHET_BUILD_DIR"]


def install(folder):
    subprocess.run(["cmake", "--install", BUILD_DIR, "--prefix", folder / "prefix"], check=True, stdout=subprocess.DEVNULL)


def put_pictures(page, text, folder):
    for name in re.findall(r"\]\(\.\./figures/tutorials/([\w.-]+)\)", text):
        shutil.copy(folder / name, SOURCE / "docs/figures/tutorials" / name)
        print(f"{page.name}: {name}")


def main(page, options):
    text = page.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        folder = root / "work"
        folder.mkdir()
        if "find_package(ricochet" in text:
            install(root)
        count = 0
        for command, seconds, printed, problem in run(page, folder, environment_of(PROGRAM, BUILD_DIR, root)):
            count += 1
            print(f"$ {command}   # {seconds:.1f} s", flush=True)
            if problem or "--print" in options:
                print(printed)
            if problem:
                sys.exit(f"{page}: {problem}")
        if not count:
            sys.exit(f"{page}: holds no command")
        for name in re.findall(r"\]\(\.\./figures/tutorials/([\w.-]+)\)", text):
            if not (folder / name).exists():
                sys.exit(f"{page}: shows {name}, which no command makes")
        if "--pictures" in options:
            put_pictures(page, text, folder)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2:])
