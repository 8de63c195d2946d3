#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/frame_arrangement.hpp"
#include "ricochet/io/sole_writer.hpp"

/// @file An HDF5 file of frames that survives interruptions: fixed data sets, then a frame again and again.
///
/// The file is closed between frames: it is complete after each of them, whoever reads it then, and its bytes after k
/// frames depend on the data alone. So a file that was left in any state after its first k frames can be given back the
/// bytes it had: the numbers of these frames are never written over, and where everything else lies is found by writing
/// k empty frames into a file beside it.
namespace ricochet {

class FrameFile {
 public:
  /// A new file with the groups and data sets that all frames share. Throws Error(file_access).
  FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
            const FrameFileOptions& options = {});
  /// Goes on with a file that held so many frames when save() was called, and may have been changed by an interrupted
  /// run since. Throws Error(file_access) where it is not that file, or where numbers of these frames are others now:
  /// then nothing has happened to it.
  FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
            const FrameFileOptions& options, const Snapshot& snapshot, const std::string& name);
  void save(Snapshot& snapshot, const std::string& name) const;
  /// Throws what going on would throw, and changes nothing: where there are several files, before the first is changed.
  static void check(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
                    const FrameFileOptions& options, const Snapshot& snapshot, const std::string& name);

  /// One frame: the values of its data sets, in the order of the layout (const double*, const int*), and its time (only
  /// VTKHDF keeps it). On a full disk, and where another program has changed the file, throws Error(file_access) before
  /// the file is touched.
  void append(const std::vector<const void*>& values, double time);
  [[nodiscard]] long frames() const { return frames_; }
  void require_untouched() const { sole_->require_untouched(); }

 private:
  FrameFile(std::string path, std::vector<DatasetLayout> frame, const FrameFileOptions& options)
      : path_(std::move(path)), layout_(std::move(frame)), options_(options) {}
  void load(const Snapshot& snapshot, const std::string& name);
  void create(const std::string& path, const std::vector<FixedDataset>& fixed) const;
  std::vector<FrameExtent> write_frame(const std::string& path, const FrameToWrite& frame) const;
  [[nodiscard]] FrameExtent count_extent(const std::string& path) const;
  [[nodiscard]] std::uint32_t checksum(const std::vector<FrameExtent>& extents,
                                       const std::vector<const void*>* values) const;
  void require_same(const std::vector<FrameExtent>& extents) const;
  enum class Repair { look, write };
  void repair(const std::vector<FixedDataset>& fixed, Repair repair) const;
  [[nodiscard]] std::int64_t frame_bytes() const;

  std::string path_;
  std::vector<DatasetLayout> layout_;
  FrameFileOptions options_;
  std::unique_ptr<const FrameArrangement> arrangement_;
  std::optional<SoleWriter> sole_;
  long frames_ = 0;
  std::vector<double> times_;               ///< of the frames, where the arrangement keeps them
  std::vector<std::int64_t> checksums_;     ///< of the numbers of every frame as they are in the file
  std::vector<std::int64_t> stored_sizes_;  ///< of the data sets of all frames, when compressed
};

}  // namespace ricochet
