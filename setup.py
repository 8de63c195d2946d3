"""Builds the library, the program and the module with CMake, and puts them into the package.

RICOCHET_BUILD names a CMake build folder, configured with RICOCHET_BUILD_PYTHON, that is to be taken as it is; without it
one is made.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent.resolve()
VERSION = re.search(r"project\(ricochet VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def run(*command):
    subprocess.run([str(part) for part in command], check=True)


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        given = os.environ.get("RICOCHET_BUILD")
        build = pathlib.Path(given).resolve() if given else pathlib.Path(self.build_temp).resolve() / "cmake"
        if not given:
            run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                "-DRICOCHET_BUILD_TESTS=OFF", "-DRICOCHET_BUILD_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}",
                "-DCMAKE_INSTALL_LIBDIR=lib")
            run("cmake", "--build", build)
        package = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent
        package.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            prefix = pathlib.Path(folder)
            for component in ("library", "program", "python"):
                run("cmake", "--install", build, "--prefix", prefix, "--component", component, "--strip")
            (module,) = prefix.glob("**/ricochet/_core.*.so")
            shutil.copy2(module, package)
            (package / "lib").mkdir(exist_ok=True)
            for library in prefix.glob("lib/**/libricochet*.so.?"):  # by the names that the linker looks for
                shutil.copy2(library.resolve(), package / "lib" / library.name)
            for part in ("bin", "share/ricochet"):
                shutil.copytree(prefix / part, package / part, dirs_exist_ok=True)


setup(version=VERSION, ext_modules=[Extension("ricochet._core", sources=[])], cmdclass={"build_ext": BuildByCMake}, zip_safe=False)
