#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/io/frame_file.hpp"

/// @file The files that frames go into, in one of the formats. CONTRIBUTING.md says what else a further format needs:
/// reading it (results_storage.hpp) most of all.
namespace ricochet {

struct FrameOutputContext {
  const std::string& directory;
  const Body& body;
  const SemidiscreteProblem& problem;
  const std::vector<Field>& fields;  ///< their values are looked at when a frame is written
  const FrameFileOptions& options;
  const Snapshot* snapshot;  ///< of the run that goes on; nullptr: new files
  const std::string& name;   ///< of what is saved in it
};

class FrameOutput {
 public:
  virtual ~FrameOutput() = default;
  /// All files are complete afterwards, and hold no frame that is not whole if the run is killed meanwhile.
  virtual void write(const State& state) = 0;
  [[nodiscard]] virtual long frames() const = 0;
  virtual void save(Snapshot& snapshot, const std::string& name) const = 0;
  /// Throws Error(file_access) where another program has changed a file since it was written.
  virtual void require_untouched() const = 0;
  /// Of all files.
  [[nodiscard]] virtual std::vector<std::string> paths() const = 0;
};

[[nodiscard]] std::unique_ptr<FrameOutput> make_xdmf_output(const FrameOutputContext& context);
[[nodiscard]] std::unique_ptr<FrameOutput> make_vtkhdf_output(const FrameOutputContext& context);

}  // namespace ricochet
