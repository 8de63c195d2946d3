#include <fmt/format.h>

#include <cstring>
#include <set>

#include "ricochet/mesh/msh_sections.hpp"

/// Sections of a .msh file common to all versions.
namespace ricochet::gmsh {

namespace {

enum class Version { unknown, v22, v41 };

Version read_format(Cursor& cursor) {
  TextReader text(cursor);
  text.begin_record();
  const double version = text.number("the format's version");
  if (version != 2.2 && version != 4.1) {
    cursor.fail(
        fmt::format("this is version {} of Gmsh's format; save the mesh as version 4.1 or 2.2 (gmsh FILE -save "
                    "-format msh41 -o NEW.msh)",
                    version));
  }
  const int binary = text.integer("the file type (0: ASCII, 1: binary)");
  const int data_size = text.integer("the data size");
  if (binary != 0 && binary != 1)
    cursor.fail(fmt::format("the file type is {}, which is neither 0 (ASCII) nor 1 (binary)", binary));
  if (data_size != 8) cursor.fail(fmt::format("the data size is {}; only 8 is supported", data_size));
  text.end_record();
  if (binary == 1) {
    cursor.set_binary();
    const int one = BinaryReader(cursor).integer("the number 1 that shows the byte order");
    if (one == 1 << 24)
      cursor.fail("the file was written on a machine with the opposite byte order; save it as ASCII there");
    if (one != 1) cursor.fail(fmt::format("the number that shows the byte order is {} instead of 1", one));
  }
  return version == 2.2 ? Version::v22 : Version::v41;
}

void read_physical_names(Cursor& cursor, RawMesh& mesh) {
  TextReader text(cursor);
  text.begin_record();
  const std::size_t count = text.count("the number of physical names", 7, 7);
  text.end_record();
  for (std::size_t i = 0; i < count; ++i) {
    text.begin_record();
    const int dimension = text.integer("the dimension of a physical group");
    const int tag = text.integer("the tag of a physical group");
    if (dimension < 0 || dimension > 3)
      cursor.fail(fmt::format("a physical group has the invalid dimension {}", dimension));
    const char* start = cursor.position();
    const std::string_view line = cursor.line();
    const std::size_t first = line.find('"');
    const std::size_t last = line.rfind('"');
    if (first == std::string_view::npos || first == last ||
        line.find_first_not_of(" \t", last + 1) != std::string_view::npos) {
      cursor.move_to(start);
      cursor.fail(fmt::format("the name of physical group {} should be here, in double quotes", tag));
    }
    const std::string name(line.substr(first + 1, last - first - 1));
    if (!mesh.physical_names.try_emplace({dimension, tag}, name).second) {
      cursor.move_to(start);
      cursor.fail(fmt::format("physical group {} of dimension {} is named twice", tag, dimension));
    }
  }
}

/// Reads one section at a time and records which ones were present.
class Reader {
 public:
  Reader(std::string_view content, const std::string& source) : cursor_(content, source) {}

  RawMesh read() {
    check_start();
    for (cursor_.skip_space(); cursor_.remaining() > 0; cursor_.skip_space()) read_section();
    for (const char* needed : {"MeshFormat", "Nodes", "Elements"}) {
      if (!read_sections_.contains(needed))
        cursor_.fail(fmt::format("the file ends without a ${} section; it is truncated", needed));
    }
    return std::move(mesh_);
  }

 private:
  void check_start() {
    cursor_.skip_space();
    if (cursor_.remaining() == 0) cursor_.fail("the file is empty");
    if (cursor_.rest().starts_with("$NOD")) {
      cursor_.fail("this is version 1 of Gmsh's format; save the mesh as version 4.1 or 2.2");
    }
    if (!cursor_.rest().starts_with("$")) {
      cursor_.fail(
          "this is not a Gmsh .msh file, which would start with $MeshFormat; convert other formats with "
          "\"gmsh FILE -save -o NEW.msh\"");
    }
  }

  void read_section() {
    const char* start = cursor_.position();
    std::string name(cursor_.line());
    while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.pop_back();
    if (name.size() < 2 || name[0] != '$' || name.size() > 100) {
      cursor_.move_to(start);
      cursor_.fail("a section ($Name) should start here");
    }
    name.erase(0, 1);
    const bool known = read_known_section(name, start);
    if (known) {
      expect_end(name);
    } else {
      skip_section(name, start);
    }
  }

  bool read_known_section(const std::string& name, const char* start) {
    const bool known = name == "MeshFormat" || name == "PhysicalNames" || name == "Nodes" || name == "Elements" ||
                       name == "Entities" || name == "PartitionedEntities" || name == "ParametricNodes";
    if (!known) return false;
    const char* content = cursor_.position();
    cursor_.move_to(start);
    if (!read_sections_.insert(name).second) cursor_.fail(fmt::format("the section ${} occurs twice", name));
    if (name != "MeshFormat" && version_ == Version::unknown) {
      cursor_.fail(fmt::format("${} precedes $MeshFormat", name));
    }
    if (name == "PartitionedEntities") {
      cursor_.fail("the mesh is partitioned; save it unpartitioned (in Gmsh: Mesh > Unpartition)");
    }
    if (name == "ParametricNodes")
      cursor_.fail("nodes with parametric coordinates are not supported; save the mesh with Mesh.SaveParametric = 0");
    if (name == "Entities" && read_sections_.contains("Elements"))
      cursor_.fail("$Entities should come before $Elements");
    cursor_.move_to(content);
    read_content(name);
    return true;
  }

  void read_content(const std::string& name) {
    const bool v22 = version_ == Version::v22;
    if (name == "MeshFormat") version_ = read_format(cursor_);
    if (name == "PhysicalNames") read_physical_names(cursor_, mesh_);
    if (name == "Nodes") v22 ? read_nodes_22(cursor_, mesh_) : read_nodes_41(cursor_, mesh_);
    if (name == "Elements") v22 ? read_elements_22(cursor_, mesh_) : read_elements_41(cursor_, entities_, mesh_);
    if (name == "Entities" && !v22) read_entities_41(cursor_, entities_);
  }

  void expect_end(const std::string& name) {
    cursor_.skip_space();
    const char* start = cursor_.position();
    const std::string end_marker = "$End" + name;
    std::string_view line = cursor_.line();
    while (line.ends_with(' ') || line.ends_with('\t')) line.remove_suffix(1);
    if (line == end_marker) return;
    cursor_.move_to(start);
    if (cursor_.remaining() == 0) cursor_.fail(fmt::format("the file ends before {}; it is truncated", end_marker));
    cursor_.fail(fmt::format("{} should be here; the content of the section does not match its counts", end_marker));
  }

  /// Skips sections (results, comments, periodicity and others) that do not describe the mesh itself.
  void skip_section(const std::string& name, const char* start) {
    const std::string end_marker = "$End" + name;
    const std::size_t found = cursor_.rest().find(end_marker);
    if (found == std::string_view::npos) {
      cursor_.move_to(start);
      cursor_.fail(fmt::format("${} is not followed by {}; the file is truncated", name, end_marker));
    }
    cursor_.move_to(cursor_.position() + found);
    expect_end(name);
  }

  Cursor cursor_;
  Version version_ = Version::unknown;
  std::set<std::string> read_sections_;
  Entities entities_;
  RawMesh mesh_;
};

}  // namespace

RawMesh read_msh(std::string_view content, const std::string& source) { return Reader(content, source).read(); }

}  // namespace ricochet::gmsh
