#!/usr/bin/env python3
"""Draws the pictures of the gallery: runs all examples, or those named, and stores their pictures with a reduced number of colours.

    PYTHONPATH=build/python python3 examples/pictures.py [NAME...]
"""

import os
import pathlib
import subprocess
import sys

from PIL import Image

FOLDER = pathlib.Path(__file__).resolve().parent
COLOURS = 256


def run_notebook(path, directory):
    import nbclient
    import nbformat

    directory.mkdir(parents=True, exist_ok=True)
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(directory)}}).execute()
    return directory / "out" / path.stem / "picture.png"


def run_script(path, directory):
    subprocess.run([sys.executable, str(path), str(directory)], check=True)
    return directory / "picture.png"


def main(names):
    os.environ.setdefault("MPLBACKEND", "Agg")
    for path in sorted([*FOLDER.glob("[0-9]*.py"), *FOLDER.glob("*.ipynb")]):
        if names and path.stem not in names:
            continue
        directory = pathlib.Path("out/examples").resolve() / path.stem
        made = run_script(path, directory) if path.suffix == ".py" else run_notebook(path, directory)
        kept = FOLDER / "pictures" / f"{path.stem}.png"
        kept.parent.mkdir(exist_ok=True)
        Image.open(made).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(kept, optimize=True)
        print(f"{kept.relative_to(FOLDER)}: {kept.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
