#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/io/xdmf_reader.hpp"
#include "ricochet/mesh/mesh.hpp"

/// @file Reads back what ResultsWriter has written: the mesh, the contact boundary and the fields of each frame.
namespace ricochet {

/// Nodes are those of the files (numbers for people), cells have Basix's order, as everywhere in the program.
class ResultsReader {
 public:
  /// Of the run in a directory, whose body has this dimension and displacements of this degree (both are in its
  /// summary). Throws Error(file_access) where files are missing, Error(invalid_input) where they are damaged.
  ResultsReader(const std::string& directory, int dimension, int degree);
  ~ResultsReader();
  ResultsReader(const ResultsReader&) = delete;
  ResultsReader& operator=(const ResultsReader&) = delete;

  /// Closes the file until something is read again: a process that has a file open to read cannot write to it. What is
  /// read later throws Error(invalid_input) where another file is in its place by then.
  void release();

  [[nodiscard]] const Points& nodes() const { return nodes_; }  ///< 3 × nodes
  [[nodiscard]] const std::vector<CellBlock>& cells() const { return cells_; }
  [[nodiscard]] const std::vector<CellBlock>& contact_facets() const { return contact_facets_; }  ///< empty: none
  [[nodiscard]] Index cell_count() const;
  [[nodiscard]] const std::vector<double>& times() const { return frames_.times; }
  [[nodiscard]] const std::vector<XdmfField>& fields() const { return frames_.fields; }
  /// nullptr: there is no such field.
  [[nodiscard]] const XdmfField* find_field(const std::string& name) const;
  /// The values of a field in a frame, row by row. Throws Error(invalid_input) where they are not there.
  void read(Index frame, const XdmfField& field, std::vector<float>& values) const;
  void read(Index frame, const XdmfField& field, std::vector<double>& values) const;

 private:
  template <class Number>
  void read_numbers(Index frame, const XdmfField& field, std::vector<Number>& values) const;

  struct File;  ///< and the frames in it
  std::unique_ptr<File> file_;
  int dimension_, degree_;
  Points nodes_;
  std::vector<CellBlock> cells_, contact_facets_;
  XdmfFrames frames_;
};

}  // namespace ricochet
