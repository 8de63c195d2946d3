#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/mesh/mesh_cache.hpp"
#include "ricochet/mesh/raw_mesh.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "support/errors.hpp"
#include "support/paths.hpp"

/// @file Helpers for the tests of meshes.
namespace ricochet::test_support {

inline std::string mesh_path(const std::string& name) { return data_path("meshes/" + name); }

inline std::string mesh_content(const std::string& name) { return gmsh::read_whole_file(mesh_path(name)); }

inline MeshFile mesh_file(const std::string& path) {
  MeshFile file;
  file.path = path;
  return file;
}

inline Mesh read_test_mesh(const std::string& name) { return read_mesh(mesh_file(mesh_path(name))); }

/// Reads a mesh as read_mesh does, but from a string.
inline Mesh mesh_of(const std::string& content, double scale = 1.0, bool bodies_may_touch = false) {
  gmsh::BuildOptions options{"test.msh", scale, bodies_may_touch, false};
  return gmsh::build_mesh(gmsh::read_msh(content, "test.msh"), options);
}

/// Returns `text` with the first `what` replaced; an absent `what` is an error of the test.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t found = text.find(what);
  if (found == std::string::npos) throw std::logic_error("nothing to replace: " + what);
  return text.replace(found, what.size(), by);
}

/// A directory that is removed with its contents.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "ricochet-test-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = pattern;
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace ricochet::test_support
