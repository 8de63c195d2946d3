"""The recipes of packaging/ for other packagers are well-formed and name all libraries that CMake searches for. Their
tools are not available here: no recipe is built. They, the citation and the pages name the version of the project."""

import re
import subprocess
import sys
import types

import jinja2
import yaml

from harness import SOURCE, TestCase

PACKAGING = SOURCE / "packaging"
# Packages that CMake searches for, as conda-forge and Spack call them.
CALLED = {"Eigen3": ("eigen", "eigen"), "Basix": ("fenics-libbasix", "fenics-basix"), "fmt": ("fmt", "fmt"),
          "spdlog": ("spdlog", "spdlog"), "tomlplusplus": ("tomlplusplus", "tomlplusplus"), "muparser": ("muparser", "muparser"),
          "CLI11": ("cli11", "cli11"), "nlohmann_json": ("nlohmann_json", "nlohmann-json"), "ZLIB": ("zlib", "zlib-api"),
          "BLAS": ("openblas", "openblas"), "cholmod": ("suitesparse", "suite-sparse"),
          "umfpack": ("suitesparse", "suite-sparse"), "HDF5": ("hdf5", "hdf5")}
STARTED = {"gmsh", "python", "meshio", "matplotlib"}


def wanted_libraries():
    text = (SOURCE / "cmake" / "Dependencies.cmake").read_text(encoding="utf-8")
    found = set(re.findall(r"find_package\((\w+)", text)) - {"Threads", "PkgConfig"}
    return found | set(re.findall(r"find_library\(\w+ (\w+)", text)) | set(re.findall(r"pkg_\w+_module\w*\((\w+)", text))


def version():
    return re.search(r"project\(ricochet VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


def conda_recipe():
    text = (PACKAGING / "conda" / "meta.yaml").read_text(encoding="utf-8")
    rendered = jinja2.Environment(undefined=jinja2.StrictUndefined).from_string(text).render(compiler=lambda language: f"{language}-compiler")
    return yaml.safe_load(rendered)


def spack_recipe():
    """Returns the class of the recipe, and the requirements in its body."""
    asked = {"depends_on": [], "version": [], "variant": []}
    fake = types.ModuleType("spack.package")
    fake.CMakePackage = type("CMakePackage", (), {"define": lambda self, name, value: (name, value)})
    for name in ("depends_on", "version", "variant"):
        setattr(fake, name, lambda *words, name=name, **more: asked[name].append((words, more)))
    fake.license = fake.generator = lambda *words: None
    sys.modules["spack"], sys.modules["spack.package"] = types.ModuleType("spack"), fake
    scope = {}
    exec(compile((PACKAGING / "spack" / "package.py").read_text(encoding="utf-8"), "package.py", "exec"), scope)
    return scope["Ricochet"], asked


class Recipes(TestCase):
    def test_the_list_of_libraries_is_that_of_cmake(self):
        self.assertEqual(wanted_libraries(), set(CALLED))

    def test_conda(self):
        recipe = conda_recipe()
        self.assertEqual((recipe["package"]["name"], recipe["package"]["version"]), ("ricochet", version()))
        needed = recipe["requirements"]
        host = {line.split()[0] for line in needed["host"]}
        self.assertEqual(host, {conda for conda, _ in CALLED.values()})
        self.assertLessEqual(STARTED, {line.split()[0].removesuffix("-base") for line in needed["run"]})
        commands = " ".join(recipe["test"]["commands"])
        for part in ("--version", "run", "report", "plot", "viewer.html", "ricochetConfig.cmake"):
            self.assertIn(part, commands)
        self.assertTrue((PACKAGING / "conda" / recipe["source"]["path"] / recipe["about"]["license_file"]).is_file())
        self.expect_status(0, subprocess.run(["bash", "-n", PACKAGING / "conda" / "build.sh"], text=True, capture_output=True))

    def test_spack(self):
        recipe, asked = spack_recipe()
        self.assertEqual([words for words, _ in asked["version"]], [(version(),)])
        libraries = {re.match(r"[\w-]+", words[0])[0] for words, more in asked["depends_on"] if "type" not in more}
        self.assertEqual(libraries, {spack for _, spack in CALLED.values()})
        started = {re.match(r"(?:py-)?([\w-]+)", words[0])[1] for words, more in asked["depends_on"] if more.get("type") == "run"}
        self.assertLessEqual(STARTED, started)
        variants = {words[0] for words, _ in asked["variant"]}
        for _, more in asked["depends_on"]:
            self.assertIn(more.get("when", "").lstrip("+"), variants | {""})
        known = set(re.findall(r"option\((\w+)", "".join((SOURCE / path).read_text(encoding="utf-8") for path in ("CMakeLists.txt", "cmake/Packages.cmake"))))
        for name, _ in recipe().cmake_args():
            self.assertTrue(name in known or name.startswith("CMAKE_"), name)

    def test_the_citation_names_the_version(self):
        self.assertEqual(yaml.safe_load((SOURCE / "CITATION.cff").read_text(encoding="utf-8"))["version"], version())

    def test_pages_require_the_version(self):
        """An installed package accepts only requests for its own minor version (cmake/Install.cmake)."""
        pages = [SOURCE / "README.md", *(SOURCE / "docs").rglob("*.md")]
        required = [(page.name, number) for page in pages
                    for number in re.findall(r"find_package\(ricochet ([\d.]+)", page.read_text(encoding="utf-8"))]
        self.assertGreaterEqual(len(required), 2)
        self.assertEqual({number for _, number in required}, {version().rpartition(".")[0]}, required)

    def test_container(self):
        """The packages installed besides are those that the package recommends or suggests (cmake/Packages.cmake)."""
        text = (PACKAGING / "Containerfile").read_text(encoding="utf-8")
        added = set(re.search(r"/packages/\*\.deb (.*?) &&", text)[1].split())
        packages = (SOURCE / "cmake" / "Packages.cmake").read_text(encoding="utf-8")
        program = re.search(r"ricochet_package\(program (.*?)\)\n", packages, re.S)[1]
        recommended = set(re.search(r"RECOMMENDS ([^\n]*)", program)[1].split())
        self.assertLessEqual(recommended, added)
        self.assertLessEqual(added - recommended, set(re.search(r"SUGGESTS ([^\n]*)", program)[1].rstrip(")").split()))
