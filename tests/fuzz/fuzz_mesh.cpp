#include <cstdint>
#include <string_view>

#include "ricochet/base/error.hpp"
#include "ricochet/mesh/build_mesh.hpp"

/// @file Any bytes as a .msh file (in a dialect set by the corpus) yield a mesh without invalid numbers, or an error of
/// the library.

namespace {

void require(bool condition) {
  if (!condition) __builtin_trap();
}

void require_valid(const ricochet::Mesh& mesh) {
  require(mesh.dimension == 2 || mesh.dimension == 3);
  require(mesh.nodes.rows() == mesh.dimension && mesh.nodes.allFinite() && mesh.cell_count() > 0);
  for (const auto* blocks : {&mesh.cells, &mesh.facets}) {
    for (const ricochet::CellBlock& block : *blocks) {
      require(static_cast<ricochet::Index>(block.nodes.size()) == block.size() * block.nodes_per_cell);
      for (const ricochet::Index node : block.nodes) require(node >= 0 && node < mesh.node_count());
    }
  }
  for (const ricochet::Group& group : mesh.groups) {
    const ricochet::Index count = group.dimension == mesh.dimension ? mesh.cell_count() : mesh.facet_count();
    for (const ricochet::Index member : group.members) require(member >= 0 && member < count);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  try {
    ricochet::gmsh::BuildOptions options;
    options.source = "mesh.msh";
    options.bodies_may_touch = size % 2 == 0;
    options.name_entities = size % 3 == 0;
    require_valid(ricochet::gmsh::build_mesh(ricochet::gmsh::read_msh(content, options.source), options));
  } catch (const ricochet::Error& error) {
    require(std::string_view(error.what()).size() > 0);
  }
  return 0;
}
