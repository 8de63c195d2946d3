# A recipe for Spack. What was tried: its body runs, and what it says is consistent (tests/end_to_end/recipes_test.py). What was
# not: Spack itself. The versions are those of Debian 12, with which Ricochet is tested; newer ones of Basix have another
# interface. It builds the working copy: `spack develop --path REPOSITORY ricochet@0.3.0`.
from spack.package import *


class Ricochet(CMakePackage):
    """Elastodynamics with unilateral contact and friction by finite elements."""

    license("BSD-3-Clause AND GPL-3.0-or-later")

    version("0.3.0")

    variant("figures", default=True, description="Draw figures by Python's matplotlib (ricochet plot)")
    variant("meshes", default=True, description="Mesh geometries by Gmsh, and convert meshes of other formats by Python")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("eigen@3.4")
    depends_on("suite-sparse@5")
    depends_on("openblas")
    depends_on("fenics-basix@0.5")
    depends_on("hdf5~mpi")
    depends_on("tomlplusplus@3.3:")
    depends_on("muparser@2.3:")
    depends_on("cli11@2:")
    depends_on("fmt@9")
    depends_on("spdlog@1.10: +fmt_external")
    depends_on("nlohmann-json@3:")
    depends_on("zlib-api")

    # Started as programs.
    depends_on("gmsh", type="run", when="+meshes")
    depends_on("python@3.9:", type="run", when="+meshes")
    depends_on("python@3.9:", type="run", when="+figures")
    depends_on("py-meshio", type="run", when="+meshes")
    depends_on("py-h5py", type="run", when="+meshes")
    depends_on("py-netcdf4", type="run", when="+meshes")
    depends_on("py-matplotlib", type="run", when="+figures")

    generator("ninja")

    def setup_run_environment(self, env):
        # The Python that has meshio and matplotlib, also where the system has another.
        if self.spec.satisfies("^python"):
            env.set("RICOCHET_PYTHON", self.spec["python"].command.path)

    def cmake_args(self):
        return [
            self.define("RICOCHET_BUILD_TESTS", False),
            self.define("CMAKE_UNITY_BUILD", True),
        ]
