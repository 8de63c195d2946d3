"""Installs the packages of a build into a minimal Debian 12, uses each, and removes them: nothing must be left.

usage: try_packages.py FOLDER [--recommends]    FOLDER: with the .deb files; --recommends: with all that they recommend
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from minimal_root import MinimalRoot, Steps, fail, require_root

SOURCE = pathlib.Path(__file__).resolve().parent.parent
CASE = "/usr/share/ricochet/cases/puck/puck.toml"


def must(condition, text):
    if not condition:
        fail(text)


# --- what is looked at in the files themselves ---------------------------------------------------------------------------
def look_at_files(packages):
    """No file knows where it was built, and programs find their libraries beside them or nowhere special."""
    for name, path in packages.items():
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["dpkg-deb", "--extract", path, folder], check=True)
            for file in pathlib.Path(folder).rglob("*"):
                if not file.is_file() or file.is_symlink():
                    continue
                data = file.read_bytes()
                must(str(SOURCE).encode() not in data, f"{name}: {file.relative_to(folder)} names the folder in which it was built")
                if data[:4] != b"\x7fELF":
                    continue
                said = subprocess.run(["readelf", "--dynamic", file], text=True, capture_output=True, check=True).stdout
                paths = re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", said)
                must(all(entry.startswith("$ORIGIN") for entry in paths), f"{name}: {file.name} looks for libraries in {paths}")


# --- what is done with each package in the root --------------------------------------------------------------------------
def version(root):
    return root.run("ricochet --version").splitlines()[0]


def shipped_case(root):
    said = root.run(f"ricochet run {CASE} -o /tmp/out --set time.end=2e-5 --set output.checkpoint_every=10 --quiet && "
                    "ricochet info /tmp/out && ricochet report /tmp/out && test -s /tmp/out/report.html && "
                    "ricochet benchmark --list")
    return re.search(r"\d+ steps", said)[0]


def manual_page(root):
    said = root.run("man --warnings=w -P cat ricochet 2>/tmp/problems")
    problems = (root.path / "tmp" / "problems").read_text(encoding="utf-8")
    must("NAME" in said and "completion" in said and not problems, f"man ricochet shows:\n{problems}{said[:500]}")


def completion(root):
    """bash loads it from where packages put it."""
    said = root.run("""
        . /usr/share/bash-completion/bash_completion
        _completion_loader ricochet
        COMP_WORDS=(ricochet va) COMP_CWORD=1 COMP_LINE='ricochet va' COMP_POINT=11
        _ricochet
        echo "${COMPREPLY[@]}" """, shell=("bash", "-c"))
    must(said.strip() == "validate", f"the completion of \"ricochet va\" is {said!r}")
    return said.strip()


def library(root):
    """The programs of docs/library.md, against what is installed."""
    page = (SOURCE / "docs" / "library.md").read_text(encoding="utf-8")
    configuration = re.search(r"```cmake\n(.*?)```", page, re.S)[1]
    program = next(block for block in re.findall(r"```cpp\n(.*?)```", page, re.S) if "run_case(" in block)
    folder = root.path / "tmp" / "consumer"
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(configuration, encoding="utf-8")
    (folder / "main.cpp").write_text(program, encoding="utf-8")
    return root.run("cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null && cmake --build build >/dev/null && "
                    f"build/consumer {CASE}", directory="/tmp/consumer").splitlines()[-1]


def documentation(root):
    root.run("test -s /usr/share/doc/ricochet/docs/case-file.md")


def figures_and_meshes(root):
    """With what the program recommends: gmsh, meshio and matplotlib."""
    root.run("ricochet plot /tmp/out --what energy -o /tmp/energy.svg && test -s /tmp/energy.svg")
    (root.path / "tmp" / "square.geo").write_text((SOURCE / "cases/incline/block.geo").read_text(encoding="utf-8"), encoding="utf-8")
    root.run("gmsh -2 -format vtk -o square.vtk square.geo >/dev/null && ricochet info square.vtk",
             directory="/tmp")


def tutorial(root, page):
    """As a newcomer: every command of a page, with what is installed."""
    folder = root.path / "tmp" / "tests"
    folder.mkdir(exist_ok=True)
    for name in ("tutorials_test.py", "tutorial_pages.py"):
        shutil.copy(SOURCE / "tests/end_to_end" / name, folder)
    shutil.copy(page, folder)
    return f"{root.run(f'python3 -B tutorials_test.py {page.name}', directory='/tmp/tests').count('$ ')} commands"


def python_module(root):
    """The first program of docs/python.md, in a copy of the folder of its case."""
    page = (SOURCE / "docs" / "python.md").read_text(encoding="utf-8")
    program = re.search(r"```python\n(.*?)```", page, re.S)[1]
    (root.path / "tmp" / "first.py").write_text(program, encoding="utf-8")
    return root.run(f"cp -r {pathlib.PurePosixPath(CASE).parent} /tmp/puck && cd /tmp/puck && python3 /tmp/first.py").splitlines()[-1]


# The package, what its check is called, the check, and what the check needs. A package that was not made is not tried.
CHECKS = [("ricochet", "ricochet --version", version, []), ("ricochet", "a shipped case", shipped_case, []),
          ("ricochet", "man ricochet", manual_page, ["man-db"]), ("ricochet", "completion", completion, ["bash-completion"]),
          ("libricochet-dev", "a program of docs/library.md", library, ["g++", "ninja-build", "cmake"]),
          ("ricochet-doc", "the documentation", documentation, []),
          ("python3-ricochet", "import ricochet", python_module, [])]


def try_in(root, steps, packages, recommends):
    tools = sorted({tool for package, _, _, needed in CHECKS if package in packages for tool in needed})
    steps("tools: " + " ".join(tools), lambda: root.install(*tools))
    before = root.files()
    (root.path / "packages").mkdir()
    for path in packages.values():
        shutil.copy(path, root.path / "packages")
    files = [f"/packages/{path.name}" for path in packages.values()]
    steps("apt-get install of " + " ".join(packages), lambda: root.install(*files, recommends=recommends))
    for package, text, check, _ in CHECKS:
        if package in packages:
            steps(text, lambda: check(root))
    if recommends:
        steps("figures and meshes", lambda: figures_and_meshes(root))
        for page in sorted((SOURCE / "docs" / "tutorials").glob("[a-z]*.md")):
            steps(f"the tutorial {page.stem}", lambda page=page: tutorial(root, page))
    steps("apt-get purge and autoremove", lambda: root.run(
        f"apt-get purge -y -qq {' '.join(packages)} && apt-get autoremove --purge -y -qq") and None)
    left = root.files() - before
    own = sorted(path for path in left if "ricochet" in path)
    must(not own, f"the packages leave behind: {own}")
    known = root.run("dpkg-query -W -f '${Package} ${Status}\\n'")
    must("ricochet" not in known, f"dpkg still knows them:\n{known}")
    # Files left by Debian's packages (caches, states of alternatives) are not ours, and are reported.
    folders = sorted({"/".join(path.split("/")[:2]) for path in left})
    print(f"           left by packages of Debian: {f'{len(left)} files in ' + ', '.join(folders) if left else 'nothing'}")


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--recommends"]
    if len(arguments) != 1:
        fail("usage: try_packages.py FOLDER [--recommends]")
    require_root()
    packages = {path.name.split("_")[0]: path for path in sorted(pathlib.Path(arguments[0]).glob("*.deb"))}
    must({"ricochet", "libricochet0", "libricochet-dev", "ricochet-doc"} <= packages.keys(),
         f"{arguments[0]} has no packages: run ./dev package to make them")
    # The shared libraries have no use of their own: all others need them.
    unused = packages.keys() - {package for package, *_ in CHECKS} - {"libricochet0"}
    must(not unused, f"no check uses these packages: {', '.join(sorted(unused))}; add them to CHECKS")
    steps = Steps()
    steps("what is in the files", lambda: look_at_files(packages))
    root = MinimalRoot()
    steps("a minimal Debian 12", root.__enter__)
    try:
        try_in(root, steps, packages, "--recommends" in sys.argv)
    finally:
        root.__exit__()
    steps.end()


main()
