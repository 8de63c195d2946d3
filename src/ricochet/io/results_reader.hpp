#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/io/result_frames.hpp"
#include "ricochet/io/results_format.hpp"
#include "ricochet/mesh/mesh.hpp"

/// @file Reader for the files of ResultsWriter: mesh, contact boundary and the fields of each frame.
namespace ricochet {

/// Nodes have the order of the files (that of the mesh file), cells Basix's order, as everywhere in the program.
class ResultsReader {
 public:
  /// Opens the run in a directory whose body has this dimension and displacements of this degree (both are in its
  /// summary). Throws Error(file_access) if files are missing, Error(invalid_input) if they are damaged.
  ResultsReader(const std::string& directory, int dimension, int degree);
  ~ResultsReader();
  ResultsReader(const ResultsReader&) = delete;
  ResultsReader& operator=(const ResultsReader&) = delete;

  [[nodiscard]] const ResultsFormat& format() const { return format_; }
  /// Closes the file until the next read: a process that has a file open for reading cannot write to it. Later reads
  /// throw Error(invalid_input) if the file has been replaced.
  void release();

  [[nodiscard]] const Points& nodes() const { return nodes_; }  ///< 3 × nodes
  [[nodiscard]] const std::vector<CellBlock>& cells() const { return cells_; }
  [[nodiscard]] const std::vector<CellBlock>& contact_facets() const { return contact_facets_; }  ///< may be empty
  [[nodiscard]] Index cell_count() const;
  [[nodiscard]] const std::vector<double>& times() const;
  [[nodiscard]] const std::vector<ResultField>& fields() const;
  /// Returns nullptr if there is no such field.
  [[nodiscard]] const ResultField* find_field(const std::string& name) const;
  /// Values of a field in a frame, row by row; symmetric tensors as xx, xy, xz, yy, yz, zz in every format. Throws
  /// Error(invalid_input) if they are missing.
  void read(Index frame, const ResultField& field, std::vector<float>& values) const;
  void read(Index frame, const ResultField& field, std::vector<double>& values) const;

 private:
  [[nodiscard]] Index rows_of(const ResultField& field) const;

  ResultsFormat format_;
  std::unique_ptr<ResultsStorage> storage_;
  int dimension_, degree_;
  Points nodes_;
  std::vector<CellBlock> cells_, contact_facets_;
};

}  // namespace ricochet
