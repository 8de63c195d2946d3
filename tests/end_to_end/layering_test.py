"""Includes are one-way: each folder of src/ricochet includes only itself and those before it; and headers of other
projects stay inside a few source files."""

import collections
import graphlib
import re
import unittest

from harness import SOURCE

LAYERS = ["base", "linear_algebra", "hdf5", "mesh", "rigid", "fem", "contact", "mass", "problem", "step", "scheme", "solver",
          "fclib", "simulation", "io", "case", "model", "run", "study", "report", "distributed"]
# The library ricochet_contact: solvers of the contact problem and its files, without finite elements or time.
CONTACT_LIBRARY = ("base", "linear_algebra", "hdf5", "solver/contact", "fclib")
# linear_algebra serves the layers from mass on: meshes, obstacles, elements and contact do without it.
WITHOUT_LINEAR_ALGEBRA = {"mesh", "rigid", "fem", "contact"}
# Schemes and step solvers share the stages in step/: neither depends on the other.
STRANGERS = {("scheme", "solver"), ("solver", "scheme")}

# Headers of other projects are confined to these folders, with the number of source files that may include them there.
CONFINED = {
    "Basix": (r"basix/", {"src/ricochet/fem": 1}),
    "HDF5": (r"hdf5\.h|H5", {"src/ricochet/hdf5": 4, "src/ricochet/io": 4}),
    "toml++": (r"toml\+\+/|toml\.hpp", {"src/ricochet/case": 1}),
    "CLI11": (r"CLI/", {"apps/ricochet": 2, "apps/ricochet-mpi": 1}),
    "nlohmann": (r"nlohmann/", {"src/ricochet/base": 1}),
    "Eigen's eigenvalues": (r"Eigen/(Dense|Eigenvalues|SVD)", {"src/ricochet/base": 1}),
    "CBLAS": (r"cblas", {"src/ricochet/base": 1, "src/ricochet/linear_algebra": 1}),
    "zlib": (r"zlib\.h", {"src/ricochet/base": 1, "src/ricochet/io": 1, "src/ricochet/report": 1}),
    "CHOLMOD": (r"cholmod|suitesparse/", {"src/ricochet/linear_algebra": 1}),
    "spdlog": (r"spdlog/", {"src/ricochet/base": 1}),
    "MPI": (r"mpi\.h", {"src/ricochet/distributed": 1}),
    "PETSc": (r"petsc", {"src/ricochet/distributed": 3}),
    "PT-Scotch": (r"ptscotch", {"src/ricochet/distributed": 1}),
    "muParser": (r"muParser", {"src/ricochet/base": 1}),
}
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def sources():
    return sorted(path for folder in ("src", "apps") for path in (SOURCE / folder).rglob("*.[ch]pp"))


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def own_includes(path):
    """Includes of headers of the library that are not generated."""
    return [include for include in includes(path)
            if include.startswith("ricochet/") and include != "ricochet/version.hpp"]


class Layering(unittest.TestCase):
    def test_every_folder_is_a_layer(self):
        folders = sorted(path.name for path in (SOURCE / "src" / "ricochet").iterdir() if path.is_dir())
        self.assertEqual(folders, sorted(LAYERS))
        self.assertGreater(len(sources()), 60)

    def test_includes_go_one_way(self):
        wrong = []
        for path in sources():
            if not path.is_relative_to(SOURCE / "src" / "ricochet"):
                continue
            layer = path.relative_to(SOURCE / "src" / "ricochet").parts[0]
            for include in own_includes(path):
                parts = include.split("/")
                backwards = LAYERS.index(parts[1]) > LAYERS.index(layer)
                forbidden = (layer, parts[1]) in STRANGERS
                if backwards or forbidden or (parts[1] == "linear_algebra" and layer in WITHOUT_LINEAR_ALGEBRA):
                    wrong.append(f"{path.relative_to(SOURCE)} includes {include}")
        self.assertEqual(wrong, [])

    def test_folders_of_a_layer_have_an_order(self):
        """Each folder can be read after those that it includes: no two of them depend on each other."""
        needs = collections.defaultdict(set)
        for path in sources():
            if path.is_relative_to(SOURCE / "src"):
                folder = str(path.parent.relative_to(SOURCE / "src"))
                needs[folder] |= {include.rpartition("/")[0] for include in own_includes(path)} - {folder}
        self.assertGreater(len(needs), 40)
        try:
            list(graphlib.TopologicalSorter(needs).static_order())
        except graphlib.CycleError as error:
            circle = error.args[1]
            self.fail(f"these folders include each other, each the one before it: {', '.join(circle)}")

    def test_contact_matrices_are_read_by_contact_and_solvers_alone(self):
        """Other code uses ContactRows and ContactBoundary: rows may follow the motion."""
        raw = re.compile(r"\b(gap_operator|tangential_trace|pressure_recovery)\b|\bcontact_?(?:\.|->)trace\b")
        readers = {}
        for path in sources():
            if found := raw.findall(path.read_text(encoding="utf-8")):
                readers.setdefault(str(path.relative_to(SOURCE).parent), []).append((path.name, found))
        inside = {folder for folder in readers if re.match(r"src/ricochet/(contact|solver)(/|$)", folder)}
        self.assertTrue(inside, "nobody reads them: this test looks for something else")
        self.assertEqual({folder: readers[folder] for folder in readers if folder not in inside}, {})

    def test_contact_solvers_know_nothing_of_finite_elements_or_time(self):
        allowed = tuple(f"ricochet/{folder}/" for folder in CONTACT_LIBRARY)
        paths = [path for folder in CONTACT_LIBRARY for path in (SOURCE / "src" / "ricochet" / folder).glob("*.[ch]pp")]
        self.assertGreater(len(paths), 100)
        wrong = [f"{path.name} includes {include}" for path in sorted(paths) for include in own_includes(path)
                 if not include.startswith(allowed)]
        self.assertEqual(wrong, [])

    def test_own_headers_are_included_by_their_full_path(self):
        """A relative include would escape the check above."""
        wrong = [f"{path.relative_to(SOURCE)} includes {include}" for path in sources() for include in includes(path)
                 if (path.parent / include).exists() and path.is_relative_to(SOURCE / "src")]
        self.assertEqual(wrong, [])

    def test_headers_of_other_projects_stay_inside(self):
        for name, (pattern, places) in CONFINED.items():
            found = collections.Counter()
            for path in sources():
                if any(re.match(pattern, include) for include in includes(path)):
                    self.assertNotEqual(path.suffix, ".hpp", f"{path} passes {name} on to whoever includes it")
                    found[str(path.relative_to(SOURCE).parent)] += 1
            self.assertTrue(found, f"{name} is included nowhere: this test looks for something else")
            self.assertEqual(found, places, f"{name}: docs/developers/architecture.md must have the same numbers of files")
