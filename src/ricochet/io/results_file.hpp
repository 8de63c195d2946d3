#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/io/frame_file.hpp"

/// @file Fields over time, in one of the formats of results_format.hpp.
///
/// xdmf: results.h5 has the mesh (mesh_datasets.hpp) and the fields /frames/NNNNNN/… (fields/field_source.hpp and
/// docs/results.md); results.xdmf describes them to readers of XDMF 3.0. obstacles.xdmf has the surfaces of the
/// obstacles, if any, and results.xdmf includes it.
///
/// vtkhdf: results.vtkhdf has the mesh and the fields (vtkhdf_frames.hpp), obstacles.vtkhdf the surfaces.
namespace ricochet {

struct ResultsOptions {
  std::vector<std::string> fields;  ///< names, also "all"; empty: the default ones
  FrameFileOptions file = {};
  std::string format = "xdmf";  ///< a name of results_format_registry()
};

/// Whole body of which each rank has a part: the first rank writes it.
struct GlobalBody {
  const Body* body = nullptr;  ///< on the first rank: space and mesh of the whole
  const SemidiscreteProblem* problem = nullptr;
  std::vector<Index> node_rows, cell_rows;  ///< rows of this rank
  Index nodes = 0, cells = 0;               ///< of the whole
};

/// Estimated bytes of the fields without compression.
struct ResultsSize {
  double mesh = 0.0, frame = 0.0;
  [[nodiscard]] double of(long frames) const { return mesh + double(frames) * frame; }
};

/// Estimate for the whole body, of `nodes` and `cells`; `body` may be one rank's part.
[[nodiscard]] ResultsSize results_size(const Body& body, const SemidiscreteProblem& problem,
                                       const ResultsOptions& options, Index nodes, Index cells);

class ResultsWriter {
 public:
  /// Opens the files in the directory; with `saved`, continues after the frames that existed when save() was called,
  /// and the files will have the bytes of an uninterrupted run. Keeps references to body and problem. Throws
  /// Error(file_access), also if they are not those files. `global_body`: the whole body, on several ranks, which all
  /// write together.
  ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                const ResultsOptions& options, const std::optional<SnapshotVisitor>& saved,
                const GlobalBody& global_body = {});
  ~ResultsWriter();
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;

  /// Writes a frame. All files are complete afterwards.
  void write(const State& state);
  [[nodiscard]] long frames() const;
  void save(const SnapshotVisitor& visit);
  /// Throws Error(file_access) if another program has changed a file since it was written; so does write().
  void require_unchanged() const;
  /// Waits until all files are on the disk.
  void sync() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
