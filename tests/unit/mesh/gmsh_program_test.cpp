#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "ricochet/mesh/gmsh_process.hpp"
#include "support.hpp"

namespace ricochet::test_support {
namespace {

/// Sets an environment variable for the lifetime of the object.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name); old != nullptr) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

class GmshProgram : public testing::Test {
 protected:
  std::ptrdiff_t cached() const {
    if (!std::filesystem::exists(cache_.path())) return 0;
    return std::distance(std::filesystem::directory_iterator(cache_.path()), {});
  }

  TemporaryDirectory files_;
  TemporaryDirectory cache_;
  Variable cache_variable_{"RICOCHET_CACHE", cache_.path().string()};
};

constexpr const char* square_geo =
    "Point(1) = {0, 0, 0, 0.5}; Point(2) = {1, 0, 0, 0.5}; Point(3) = {1, 1, 0, 0.5}; Point(4) = {0, 1, 0, 0.5};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
    "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Physical Surface(\"body\") = {1}; Physical Curve(\"low\") = "
    "{1};\n";

TEST_F(GmshProgram, MeshesPlaneAndSolidGeometry) {
  const Mesh plane = read_mesh(mesh_file(mesh_path("triangle.geo")));
  EXPECT_EQ(plane.dimension, 2);
  EXPECT_FALSE(plane.group("bottom", 1).members.empty());
  const Mesh solid = read_mesh(mesh_file(mesh_path("tetrahedron.geo")));
  EXPECT_EQ(solid.dimension, 3);
  EXPECT_FALSE(solid.group("top", 2).members.empty());
  EXPECT_EQ(cached(), 2);
}

TEST_F(GmshProgram, SizeAndDegreeRule) {
  // The file requests other values in each of the possible ways.
  MeshFile file = mesh_file(files_.write(
      "square.geo",
      std::string("Mesh.MeshSizeMax = 3; Mesh.ElementOrder = 3; Mesh.MeshSizeFactor = 2;\n") + square_geo));
  file.size = 0.1;
  file.geometry_degree = 2;
  const Mesh fine = read_mesh(file);
  EXPECT_EQ(fine.degree, 2);
  EXPECT_EQ(fine.group("low", 1).members.size(), 10u);
  file.size = 0.5;
  EXPECT_EQ(read_mesh(file).group("low", 1).members.size(), 2u);
  file.scale = 0.25;
  EXPECT_EQ(read_mesh(file).nodes.maxCoeff(), 0.25);
  EXPECT_EQ(cached(), 2);  // the scale is not part of the key
}

TEST_F(GmshProgram, CadFilesGetGroupsByEntity) {
  for (const char* name : {"box.step", "box.brep"}) {
    MeshFile file = mesh_file(mesh_path(name));
    file.size = 0.5;
    const Mesh mesh = read_mesh(file);
    EXPECT_EQ(mesh.dimension, 3);
    EXPECT_EQ(mesh.group("body", 3).members.size(), std::size_t(mesh.cell_count()));
    std::size_t facets = 0;
    for (int i = 1; i <= 6; ++i) facets += mesh.group("surface " + std::to_string(i), 2).members.size();
    EXPECT_EQ(facets, std::size_t(mesh.facet_count()));
  }
}

TEST_F(GmshProgram, MeshesAreCachedByContent) {
  const std::string path = files_.write("square.geo", std::string("Include \"size.geo\";\n") + square_geo);
  files_.write("size.geo", "// nothing\n");
  const Mesh first = read_mesh(mesh_file(path));
  EXPECT_EQ(cached(), 1);
  {
    // A program that only reports its version: the mesh must come from the cache.
    TemporaryDirectory programs;
    const std::string program =
        programs.write("gmsh", "#!/bin/sh\n[ \"$1\" = -version ] && echo " + gmsh::program_version("") +
                                   " && exit 0\necho 'Error   : must not run'\nexit 1\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const Variable search("PATH", programs.path().string() + ":" + std::getenv("PATH"));
    EXPECT_EQ(read_mesh(mesh_file(path)).node_tags, first.node_tags);
    // The key is the content, not the name.
    EXPECT_EQ(read_mesh(mesh_file(path)).cell_count(), first.cell_count());
    files_.write("size.geo", "// changed\n");
    const std::string message = message_of([&] { (void)read_mesh(mesh_file(path)); });
    EXPECT_TRUE(has(message, "must not run"));
    EXPECT_TRUE(has(message, "status 1"));
  }
  (void)read_mesh(mesh_file(path));
  EXPECT_EQ(cached(), 2);  // the failed run leaves nothing behind
}

TEST_F(GmshProgram, FailuresQuoteGmsh) {
  const std::string message =
      message_of([&] { (void)read_mesh(mesh_file(files_.write("bad.geo", "Point(1) = {0, 0\n"))); });
  EXPECT_TRUE(has(message, "bad.geo"));
  EXPECT_TRUE(has(message, "syntax error"));
  EXPECT_EQ(cached(), 0);
  const std::string nothing =
      message_of([&] { (void)read_mesh(mesh_file(files_.write("empty.geo", "// nothing\n"))); });
  EXPECT_TRUE(has(nothing, "empty.geo"));
}

TEST_F(GmshProgram, ItsAbsenceIsExplained) {
  const Variable search("PATH", files_.path().string());
  const std::string message = message_of([&] { (void)read_mesh(mesh_file(mesh_path("triangle.geo"))); });
  EXPECT_TRUE(has(message, "apt-get install gmsh"));
}

TEST_F(GmshProgram, OddNamesReachItUnchanged) {
  const std::string path = files_.write("a b;$(touch x)'\".geo", square_geo);
  EXPECT_EQ(read_mesh(mesh_file(path)).dimension, 2);
}

TEST_F(GmshProgram, AnUnusableCacheFallsBackToATemporaryDirectory) {
  const Variable cache("RICOCHET_CACHE", "/dev/null/cache");
  const Variable temporary("TMPDIR", files_.path().string());
  EXPECT_EQ(read_mesh(mesh_file(mesh_path("triangle.geo"))).dimension, 2);
}

TEST(Fnv1a, HasTheReferenceValues) {
  EXPECT_EQ(gmsh::fnv1a_128(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(gmsh::fnv1a_128("a"), "d228cb696f1a8caf78912b704e4a8964");
}

TEST(GmshProgramNeeded, ForGeometryOnly) {
  for (const char* name : {"a.geo", "a.STEP", "a.stp", "a.iges", "a.igs", "a.brep"})
    EXPECT_TRUE(needs_gmsh_program(name));
  for (const char* name : {"a.msh", "a", "geo", "a.vtk"}) EXPECT_FALSE(needs_gmsh_program(name));
}

TEST_F(GmshProgram, MayRunCommandsOfScriptsAndOptionsFiles) {
  for (const char* name : {"a.geo", "a.GEO"}) EXPECT_TRUE(may_run_commands(name));
  for (const char* name : {"a.STEP", "a.msh", "geo"}) EXPECT_FALSE(may_run_commands(name));
  (void)files_.write("part.step.opt", "Mesh.MeshSizeMax = 1;\n");
  EXPECT_TRUE(may_run_commands((files_.path() / "part.step").string()));
  EXPECT_FALSE(may_run_commands((files_.path() / "other.step").string()));
}

}  // namespace
}  // namespace ricochet::test_support
