#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/io/frame_file.hpp"

/// @file Fields over time: results.h5 and its XDMF 3.0 side-file results.xdmf, one dataset per frame and field.
///
/// results.h5:  /mesh/nodes (nodes × 3), /mesh/cells (cells × nodes in VTK's order, or XDMF's mixed list),
///   /mesh/contact_facets likewise where there are any, /frames/NNNNNN/… the fields (see fields/field_source.hpp and
///   docs/results.md).
///
/// Beside them, where there are obstacles, obstacles.xdmf with their surfaces, which results.xdmf includes.
namespace ricochet {

struct ResultsOptions {
  std::vector<std::string> fields;  ///< names, also "all"; empty: the usual ones
  FrameFileOptions file = {};
};

class ResultsWriter {
 public:
  /// Opens DIRECTORY/results.h5 and results.xdmf. Keeps references to body and problem. Throws Error(file_access).
  ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                const ResultsOptions& options);
  /// Goes on after the frames that were there when save() was called; the files will have the bytes of a run that was
  /// never interrupted. Throws Error(file_access) where they are not those files.
  ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                const ResultsOptions& options, const Snapshot& snapshot, const std::string& name);
  ~ResultsWriter();
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;

  /// Both files are complete afterwards.
  void write(const State& state);
  [[nodiscard]] long frames() const;
  void save(Snapshot& snapshot, const std::string& name) const;
  /// Waits until both files are on the disk.
  void sync() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
