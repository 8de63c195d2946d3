#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/file_change_detector.hpp"
#include "ricochet/io/frame_arrangement.hpp"

/// @file HDF5 file of frames that survives interruptions: fixed datasets, followed by any number of frames.
///
/// The file is closed between frames: it is complete after each of them for every reader, and its bytes after k frames
/// depend on the data alone. A file that was left in any state after its first k frames can thus be restored to its
/// earlier bytes: the values of these frames are never overwritten, and the rest is reproduced by writing k empty
/// frames to an auxiliary file.
namespace ricochet {

class FrameFile {
 public:
  /// Creates a file with the groups and datasets that all frames share; with `saved`, continues a file that held so
  /// many frames when persist() was called, and may have been changed by an interrupted run since. Throws
  /// Error(file_access), with the file unchanged, if it is not that file or the values of these frames differ.
  FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
            const FrameFileOptions& options = {}, const std::optional<SnapshotVisitor>& saved = {});
  void persist(const SnapshotVisitor& visit);
  /// Throws what continuing would throw, and changes nothing: for several files, before the first is changed.
  static void check(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
                    const FrameFileOptions& options, const SnapshotVisitor& saved);

  /// Appends a frame: the values of its datasets, in the order of the layout (const double*, const int*), and its time
  /// (stored by VTKHDF only). If the disk is full or another program has changed the file, throws Error(file_access)
  /// before the file is modified.
  void append(const std::vector<const void*>& values, double time);
  [[nodiscard]] long frames() const { return frames_; }
  void require_unchanged() const { change_detector_->require_unchanged(); }

 private:
  FrameFile(std::string path, std::vector<DatasetLayout> frame, const FrameFileOptions& options,
            const std::vector<FixedDataset>& fixed);
  void create(const std::string& path, const std::vector<FixedDataset>& fixed) const;
  std::vector<FrameExtent> write_frame(const std::string& path, const FrameToWrite& frame) const;
  [[nodiscard]] FrameExtent count_extent(const std::string& path) const;
  [[nodiscard]] std::uint32_t checksum(const std::vector<FrameExtent>& extents,
                                       const std::vector<const void*>* values) const;
  void require_same(const std::vector<FrameExtent>& extents) const;
  enum class Repair { verify, write };
  void repair(const std::vector<FixedDataset>& fixed, Repair repair) const;
  [[nodiscard]] std::int64_t frame_bytes() const;

  std::string path_;
  std::vector<DatasetLayout> layout_;
  FrameFileOptions options_;
  std::unique_ptr<const FrameArrangement> arrangement_;
  std::optional<FileChangeDetector> change_detector_;
  long frames_ = 0;
  std::vector<double> times_;               ///< of the frames, if the arrangement stores them
  std::vector<std::int64_t> checksums_;     ///< of each frame's values, as stored in the file
  std::vector<std::int64_t> stored_sizes_;  ///< of the datasets of all frames, if compressed
};

}  // namespace ricochet
