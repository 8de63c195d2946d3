"""A tutorial is run as its reader does: the files that it names are written, the commands run, and their output
compared.

    tutorials_test.py PAGE.md                 # the test
    tutorials_test.py PAGE.md --pictures      # also puts the pictures of the page into docs/figures/tutorials
    tutorials_test.py PAGE.md --print         # prints the output of every command, for authors

RICOCHET_PROGRAM and RICOCHET_BUILD_DIR select the build; without them the installed program is used.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from tutorial_pages import environment_of, run


def environment(root, text):
    build = os.environ.get("RICOCHET_BUILD_DIR")
    if build is None:
        return {**os.environ, "MPLBACKEND": "Agg"}
    if "find_package(ricochet" in text:
        subprocess.run(["cmake", "--install", build, "--prefix", root / "prefix"], check=True, stdout=subprocess.DEVNULL)
    return environment_of(os.environ["RICOCHET_PROGRAM"], build, root)


def put_pictures(page, shown, folder):
    for name in shown:
        shutil.copy(folder / name, page.parents[1] / "figures/tutorials" / name)
        print(f"{page.name}: {name}")


def main(page, options):
    text = page.read_text(encoding="utf-8")
    shown = re.findall(r"\]\(\.\./figures/tutorials/([\w.-]+)\)", text)
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        folder = root / "work"
        folder.mkdir()
        count = 0
        for command, seconds, printed, problem in run(page, folder, environment(root, text)):
            count += 1
            print(f"$ {command}   # {seconds:.1f} s", flush=True)
            if problem or "--print" in options:
                print(printed)
            if problem:
                sys.exit(f"{page}: {problem}")
        if not count:
            sys.exit(f"{page}: holds no command")
        for picture in shown:
            if not (folder / picture).exists():
                sys.exit(f"{page}: shows {picture}, which no command makes")
        if "--pictures" in options:
            put_pictures(page, shown, folder)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:])
