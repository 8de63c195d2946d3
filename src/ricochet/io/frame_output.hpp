#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/io/frame_file.hpp"

/// @file Files of frames in one of the formats (results_format.hpp).
namespace ricochet {

struct FrameOutputContext {
  const std::string& directory;
  const Body& body;
  const SemidiscreteProblem& problem;
  const std::vector<Field>& fields;  ///< their values are read when a frame is written
  const FrameFileOptions& options;
  const std::optional<SnapshotVisitor>& saved;  ///< loads the output of the resumed run; none: new files

  [[nodiscard]] std::optional<SnapshotVisitor> saved_part(const std::string& key) const {
    return saved ? std::optional(saved->part(key)) : std::nullopt;
  }
};

class FrameOutput {
 public:
  virtual ~FrameOutput() = default;
  /// Writes a frame. All files are complete afterwards, and contain no partial frame if the run is killed meanwhile.
  virtual void write(const State& state) = 0;
  [[nodiscard]] virtual long frames() const = 0;
  virtual void save(const SnapshotVisitor& visit) = 0;
  /// Throws Error(file_access) if another program has changed a file since it was written.
  virtual void require_unchanged() const = 0;
  /// Paths of all files.
  [[nodiscard]] virtual std::vector<std::string> paths() const = 0;
};

/// ResultsFormat::write of a class.
template <class Output>
[[nodiscard]] std::unique_ptr<FrameOutput> write_as(const FrameOutputContext& context) {
  return std::make_unique<Output>(context);
}

}  // namespace ricochet
