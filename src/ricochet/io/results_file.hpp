#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/io/frame_file.hpp"
#include "ricochet/io/results_format.hpp"

/// @file Fields over time, in one of two formats.
///
/// xdmf: results.h5 has the mesh (mesh_datasets.hpp) and /frames/NNNNNN/…, the fields (fields/field_source.hpp and
/// docs/results.md); results.xdmf says so to those who read XDMF 3.0. obstacles.xdmf has the surfaces of the obstacles,
/// where there are some, and results.xdmf includes it.
///
/// vtkhdf: results.vtkhdf has the mesh and the fields (vtkhdf_frames.hpp), obstacles.vtkhdf the surfaces.
namespace ricochet {

struct ResultsOptions {
  std::vector<std::string> fields;  ///< names, also "all"; empty: the usual ones
  FrameFileOptions file = {};
  ResultsFormat format = ResultsFormat::xdmf;
};

/// What is written of a body of which each rank has a part: the first one writes the whole.
struct WholeBody {
  const Body* body = nullptr;  ///< on the first rank: space and mesh of all
  const SemidiscreteProblem* problem = nullptr;
  std::vector<Index> node_rows, cell_rows;  ///< where those of this rank are
  Index nodes = 0, cells = 0;               ///< of all
};

class ResultsWriter {
 public:
  /// Opens the files in the directory. Keeps references to body and problem. Throws Error(file_access). `whole`: where
  /// there are several ranks; all write together.
  ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                const ResultsOptions& options, const WholeBody& whole = {});
  /// Goes on after the frames that were there when save() was called; the files will have the bytes of a run that was
  /// never interrupted. Throws Error(file_access) where they are not those files.
  ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                const ResultsOptions& options, const Snapshot& snapshot, const std::string& name,
                const WholeBody& whole = {});
  ~ResultsWriter();
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;

  /// All files are complete afterwards.
  void write(const State& state);
  [[nodiscard]] long frames() const;
  void save(Snapshot& snapshot, const std::string& name) const;
  /// Throws Error(file_access) where another program has changed a file since it was written; so does write().
  void require_untouched() const;
  /// Waits until all files are on the disk.
  void sync() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
