#include "ricochet/mesh/read_mesh.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "ricochet/base/error.hpp"
#include "ricochet/base/input_file.hpp"
#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/mesh/convert_process.hpp"
#include "ricochet/mesh/mesh_cache.hpp"
#include "ricochet/mesh/raw_mesh.hpp"

namespace ricochet {

namespace gmsh {

std::string read_whole_file(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) {
    throw Error(ErrorKind::file_access, fmt::format("cannot read {}: {}", path.string(), why));
  };
  std::error_code error;
  if (const std::string why = unreadable_reason(path); !why.empty()) fail(why);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (file == nullptr) fail(std::strerror(errno));
  std::string content;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error) content.resize(size);
  // The size may change meanwhile: only the data read before the end count.
  std::size_t done = 0;
  for (;;) {
    if (done == content.size()) content.resize(content.size() + (1u << 16));
    const std::size_t got = std::fread(content.data() + done, 1, content.size() - done, file.get());
    done += got;
    if (got == 0) break;
  }
  if (std::ferror(file.get()) != 0) fail(std::strerror(errno));
  content.resize(done);
  return content;
}

}  // namespace gmsh

namespace {

void check_request(const MeshFile& file, bool by_program) {
  const auto fail = [&](const std::string& message) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: {}", file.path, message));
  };
  if (!(file.scale > 0.0) || !std::isfinite(file.scale)) {
    fail(fmt::format("the scale of the mesh must be positive and finite, not {}", file.scale));
  }
  if (file.geometry_degree != 1 && file.geometry_degree != 2) {
    fail(fmt::format("the degree of the geometry must be 1 or 2, not {}", file.geometry_degree));
  }
  if (!file.size) return;
  if (!by_program)
    fail("a size can only be set for .geo and CAD files: the elements of a mesh already have their sizes");
  if (!(*file.size > 0.0) || !std::isfinite(*file.size)) {
    fail(fmt::format("the size of the elements must be positive and finite, not {}", *file.size));
  }
}

}  // namespace

bool is_mesh_cached(const MeshFile& file) {
  check_request(file, true);
  (void)gmsh::read_whole_file(file.path);  // reports a file that cannot be read
  return gmsh::meshed_before(file).has_value();
}

Mesh read_mesh(const MeshFile& file) {
  const bool by_program = needs_gmsh_program(file.path);
  check_request(file, by_program);
  gmsh::BuildOptions options{file.path, file.scale, file.bodies_may_touch, true};
  const bool converted = is_foreign_mesh(file.path);
  std::filesystem::path path = file.path;
  if (by_program || converted) {
    (void)gmsh::read_whole_file(path);  // reports a file that cannot be read
    path = by_program ? gmsh::meshed_file(file) : gmsh::converted_file(file.path);
  }
  const std::string content = gmsh::read_whole_file(path);
  if (converted) gmsh::repeat_notes(content, file.path);
  std::string shown = file.path;
  if (by_program || converted)
    shown += fmt::format(" ({} {})", by_program ? "meshed as" : "converted to", path.string());
  return gmsh::build_mesh(gmsh::read_msh(content, shown), options);
}

}  // namespace ricochet
