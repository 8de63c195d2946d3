#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/io/result_frames.hpp"
#include "ricochet/io/results_format.hpp"
#include "ricochet/mesh/mesh.hpp"

/// @file Reads back what ResultsWriter has written: the mesh, the contact boundary and the fields of each frame.
namespace ricochet {

/// Of the files in a directory; none: there are no files of fields.
[[nodiscard]] std::optional<ResultsFormat> find_results(const std::string& directory);
/// The names of the files, for messages.
[[nodiscard]] std::string files_of_results(ResultsFormat format);
[[nodiscard]] std::string file_of_obstacles(ResultsFormat format);
/// Of each frame; empty where there is no such file. Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] std::vector<ObstacleFrame> read_obstacle_frames(const std::string& directory, ResultsFormat format);

class ResultsStorage;

/// Nodes are those of the files (numbers for people), cells have Basix's order, as everywhere in the program.
class ResultsReader {
 public:
  /// Of the run in a directory, whose body has this dimension and displacements of this degree (both are in its
  /// summary). Throws Error(file_access) where files are missing, Error(invalid_input) where they are damaged.
  ResultsReader(const std::string& directory, int dimension, int degree);
  ~ResultsReader();
  ResultsReader(const ResultsReader&) = delete;
  ResultsReader& operator=(const ResultsReader&) = delete;

  [[nodiscard]] ResultsFormat format() const { return format_; }
  /// Closes the file until something is read again: a process that has a file open to read cannot write to it. What is
  /// read later throws Error(invalid_input) where another file is in its place by then.
  void release();

  [[nodiscard]] const Points& nodes() const { return nodes_; }  ///< 3 × nodes
  [[nodiscard]] const std::vector<CellBlock>& cells() const { return cells_; }
  [[nodiscard]] const std::vector<CellBlock>& contact_facets() const { return contact_facets_; }  ///< empty: none
  [[nodiscard]] Index cell_count() const;
  [[nodiscard]] const std::vector<double>& times() const;
  [[nodiscard]] const std::vector<ResultField>& fields() const;
  /// nullptr: there is no such field.
  [[nodiscard]] const ResultField* find_field(const std::string& name) const;
  /// The values of a field in a frame, row by row; symmetric tensors as xx, xy, xz, yy, yz, zz, whatever the format.
  /// Throws Error(invalid_input) where they are not there.
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
