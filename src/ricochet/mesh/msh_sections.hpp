#pragma once

#include "ricochet/mesh/msh_cursor.hpp"
#include "ricochet/mesh/raw_mesh.hpp"

/// @file Sections whose layout depends on the version of the format. Each function is called behind the line that opens
/// the section and leaves the cursor before the one that closes it. Private to mesh/.
namespace ricochet::gmsh {

void read_nodes_22(Cursor& cursor, RawMesh& mesh);
void read_elements_22(Cursor& cursor, RawMesh& mesh);

/// Physical groups of the geometric entities, by dimension and tag. In 4.1 elements belong to groups only through
/// these.
struct Entities {
  bool present = false;
  std::map<std::pair<int, int>, std::vector<int>> groups;
};

void read_entities_41(Cursor& cursor, Entities& entities);
void read_nodes_41(Cursor& cursor, RawMesh& mesh);
void read_elements_41(Cursor& cursor, const Entities& entities, RawMesh& mesh);

}  // namespace ricochet::gmsh
