"""The project installs into a prefix of its own, and an external project finds it there, builds against nothing but
that prefix, and runs; so does the installed program."""

import os
import pathlib
import re
import subprocess

from harness import SOURCE, TestCase, block_case, run

BUILD = pathlib.Path(os.environ["RICOCHET_BUILD_DIR"])


class Installation(TestCase):
    def command(self, *arguments):
        process = subprocess.run(list(map(str, arguments)), text=True, capture_output=True, cwd=self.folder)
        return self.expect_status(0, process).stdout

    def documented_programs(self):
        """Returns the programs of docs/library.md: one that runs a case, one that steps, one that solves a contact
        problem."""
        text = (SOURCE / "docs" / "library.md").read_text(encoding="utf-8")
        programs = [block for block in re.findall(r"```cpp\n(.*?)```", text, re.S) if "int main" in block]
        self.assertEqual(len(programs), 3)
        return [self.write(f"example_{number}.cpp", program) for number, program in enumerate(programs)]

    def test_installed_prefix_is_enough(self):
        prefix = self.folder / "prefix"
        self.command("cmake", "--install", BUILD, "--prefix", prefix)
        case = self.write("block.toml", block_case())

        program = prefix / "bin" / "ricochet"
        self.assertEqual(self.command(program, "--version"), run("--version").stdout)
        self.assertIn("results in", self.command(program, "run", case, "-o", self.folder / "by-program", "--quiet"))
        figure = self.folder / "energy.svg"
        self.command(program, "plot", self.folder / "by-program", "--what", "energy", "-o", figure)
        self.assertIn("</svg>", figure.read_text(encoding="utf-8"))
        for script in ("figure.py", "scene.py", "show_in_paraview.py"):
            self.assertTrue((prefix / "share" / "ricochet" / script).is_file())
        self.command(program, "report", self.folder / "by-program")
        self.assertIn('id="ricochet-runs"', (self.folder / "by-program" / "report.html").read_text(encoding="utf-8"))
        linked = re.search(r"libricochet\S* => (\S+)", self.command("ldd", program))
        self.assertTrue(pathlib.Path(linked[1]).resolve().is_relative_to(prefix), linked[0])

        examples = self.documented_programs()
        build = self.folder / "build"
        # Users of a library with sanitizers need them as well.
        flags = re.search(r"^CMAKE_CXX_FLAGS:STRING=(.*)$", (BUILD / "CMakeCache.txt").read_text(encoding="utf-8"), re.M)[1]
        self.command("cmake", "-S", SOURCE / "tests" / "end_to_end" / "consumer", "-B", build, "-G", "Ninja",
                     f"-DDOCUMENTED={';'.join(map(str, examples))}", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_FLAGS={flags}",
                     "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")
        self.command("cmake", "--build", build)
        commands = (build / "compile_commands.json").read_text(encoding="utf-8")
        for foreign in (f"{BUILD}/", f"{SOURCE}/src"):
            self.assertNotIn(foreign, commands, "the consumer must not look into the build or source tree")
        said = self.command(build / "consumer", case, self.folder / "by-consumer")
        self.assertRegex(said, r"^ricochet \d+\.\d+\.\d+: done, 30 steps\n$")
        self.assertEqual((self.folder / "by-consumer" / "history.csv").read_bytes(),
                         (self.folder / "by-program" / "history.csv").read_bytes())
        whole, session, contact = (build / path.stem for path in examples)
        self.assertRegex(self.command(whole, case), r"^energy \S+ at the end of \d+ steps\n$")
        self.assertRegex(self.command(session, case), r"^done at t = \S+: the spring did \S+ J\n")
        self.assertTrue((self.folder / "out" / "spring" / "history.csv").is_file())
        self.assertEqual(self.command(contact), "reaction 1, friction -0.2\n")
        # A program that only solves contact problems needs no more.
        self.assertNotRegex(self.command("ldd", contact), r"libricochet\.so|libbasix|libtomlplusplus")

    def test_every_installed_header_stands_alone(self):
        """Each public header compiles by itself with nothing but Eigen beside the installed ones."""
        prefix = self.folder / "prefix"
        self.command("cmake", "--install", BUILD, "--prefix", prefix)
        include = prefix / "include"
        headers = sorted(path.relative_to(include) for path in include.rglob("*.hpp"))
        self.assertGreater(len(headers), 30)
        for header in headers:  # headers installed on this machine must not hide errors
            for foreign in re.findall(r"#include <([^>]*[/.][^>]*)>", (include / header).read_text(encoding="utf-8")):
                of_compiler = foreign in ("sys/types.h", "emmintrin.h")
                self.assertTrue(foreign.startswith("Eigen/") or of_compiler, f"{header} includes <{foreign}>")
        one = self.write("all.cpp", "".join(f'#include "{header}"\n' for header in headers))
        eigen = self.command("pkg-config", "--cflags-only-I", "eigen3").split()
        self.command("c++", "-std=c++20", "-fsyntax-only", f"-I{include}", *eigen, one)
