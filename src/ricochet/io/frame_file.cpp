#include "ricochet/io/frame_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

/// Bytes of a frame in addition to its values, for names, extents and indices: in total, and per dataset.
constexpr std::int64_t administration = 65536, administration_of_a_set = 8192;

Hdf5Handle file_access(const FrameFileOptions& options) {
  const std::int64_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110);
  // Readers of existing frames must not stop the run.
  H5Pset_file_locking(access, false, true);
  // If a frame is flushed before its end, HDF5 records the length of the file including the space it reserves. It
  // releases this space when the file is closed, by truncating the file before it records the new length: if killed in
  // between, a run would leave a file that is shorter than recorded and cannot be opened. So no space is reserved.
  if (options.vtkhdf) {
    H5Pset_meta_block_size(access, 0);
    H5Pset_small_data_block_size(access, 0);
  }
  return {access, H5Pclose};
}

/// Copies the gaps between extents, which are in order, and the part before the first. Interruption is safe: the number
/// of frames comes first, so that discarded frames no longer count.
void copy_gaps(const std::string& from_path, const std::string& to_path, const std::vector<FrameExtent>& extents,
               const FrameExtent& count) {
  std::ifstream from(from_path, std::ios::binary);
  std::fstream to(to_path, std::ios::binary | std::ios::in | std::ios::out);
  std::vector<char> bytes;
  const auto copy = [&](std::int64_t begin, std::int64_t end) {
    bytes.resize(std::size_t(std::max<std::int64_t>(end - begin, 0)));
    from.seekg(begin);
    from.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    to.seekp(begin);
    to.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  };
  copy(count.address, count.address + count.size);
  to.flush();
  std::int64_t at = 0;
  for (const FrameExtent& extent : extents) {
    copy(at, extent.address);
    at = std::max(at, extent.address + extent.size);
  }
  to.flush();
  check_written(to_path, from && to, "the file");
}

/// Creates the groups above a name ("/mesh" of "/mesh/nodes").
void make_parent(std::int64_t file, const std::string& path, const std::string& name) {
  const std::string parent = name.substr(0, name.rfind('/'));
  if (parent.empty() || H5Lexists(file, parent.c_str(), H5P_DEFAULT) > 0) return;
  check_written(path, make_hdf5_group(file, parent.c_str()), parent);
}

void write_fixed(std::int64_t file, const std::string& path, const FixedDataset& fixed) {
  make_parent(file, path, fixed.name);
  if (!fixed.same_as.empty()) {
    check_written(path,
                  H5Lcreate_hard(file, fixed.same_as.c_str(), file, fixed.name.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0,
                  fixed.name);
    return;
  }
  const bool real = fixed.integers.empty();
  const Hdf5Handle space = hdf5_space(fixed.rows, fixed.columns);
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_DATASET_CREATE);
  const hid_t type = real ? H5T_IEEE_F64LE : fixed.bytes ? H5T_STD_U8LE : H5T_STD_I64LE;
  const Hdf5Handle set(H5Dcreate2(file, fixed.name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                       H5Dclose);
  const void* const values = real ? static_cast<const void*>(fixed.reals.data()) : fixed.integers.data();
  check_written(path,
                set >= 0 && H5Dwrite(set, real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                     values) >= 0,
                fixed.name);
}

}  // namespace

FrameFile::FrameFile(std::string path, std::vector<DatasetLayout> frame, const FrameFileOptions& options,
                     const std::vector<FixedDataset>& fixed)
    : path_(std::move(path)),
      layout_(std::move(frame)),
      options_(options),
      arrangement_(make_frame_arrangement(fixed, layout_, options_)) {}

FrameFile::FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
                     const FrameFileOptions& options, const std::optional<SnapshotVisitor>& saved)
    : FrameFile(std::move(path), std::move(frame), options, fixed) {
  if (saved) {
    persist(*saved);
    repair(fixed, Repair::write);
  } else {
    create(path_, fixed);
  }
  change_detector_.emplace(path_);
}

void FrameFile::check(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
                      const FrameFileOptions& options, const SnapshotVisitor& saved) {
  FrameFile file(std::move(path), std::move(frame), options, fixed);
  file.persist(saved);
  file.repair(fixed, Repair::verify);
}

void FrameFile::persist(const SnapshotVisitor& visit) {
  visit("frames", frames_);
  visit("stored_sizes", stored_sizes_, {0, std::int64_t{1} << 40});
  visit("checksums", checksums_, {0, 0xffffffff});
  const std::size_t expected = options_.compression > 0 ? std::size_t(frames_) * layout_.size() : 0;
  visit.require(
      stored_sizes_.size() == expected, "stored_sizes",
      fmt::format("has {} sizes for {} frames of {} datasets", stored_sizes_.size(), frames_, layout_.size()));
  visit.require(long(checksums_.size()) == frames_, "checksums", "does not have one checksum per frame");
  if (!arrangement_->keeps_times()) return;
  if (visit.loads()) times_.resize(checksums_.size());
  visit.numbers("times", times_);
}

void FrameFile::create(const std::string& path, const std::vector<FixedDataset>& fixed) const {
  quiet_hdf5();
  std::int64_t bytes = administration;
  for (const FixedDataset& set : fixed) bytes += 8 * std::int64_t(set.reals.size() + set.integers.size());
  { std::ofstream(path, std::ios::binary | std::ios::trunc); }
  reserve_space(path, bytes);
  const Hdf5Handle access = file_access(options_);
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_FILE_CREATE);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, properties, access);
  check_written(path, file >= 0, "the file");
  try {
    check_written(path, write_hdf5_text_attribute(file, version_attribute, version), version_attribute);
    for (const FixedDataset& set : fixed) write_fixed(file, path, set);
    // The indices of HDF5 1.10 grow without a change of existing data. Older ones split their nodes in place: if killed
    // in between, a run would leave a file whose steps cannot be found. (The file itself keeps the format of 1.8, since
    // files of 1.10 record that they are open for writing, and cannot be opened if this mark is never removed.)
    if (options_.vtkhdf) H5Fset_libver_bounds(file, H5F_LIBVER_V110, H5F_LIBVER_V110);
    arrangement_->begin(file, path);
  } catch (const Error&) {
    H5Fclose(file);
    throw;
  }
  check_written(path, H5Fclose(file) >= 0, "the file");
}

std::int64_t FrameFile::frame_bytes() const {
  std::int64_t bytes = administration;
  // Incompressible data grow by some bytes in a thousand.
  for (const DatasetLayout& set : layout_) bytes += 8 * entries_of(set) * 101 / 100 + administration_of_a_set;
  return bytes;
}

void FrameFile::append(const std::vector<const void*>& values, double time) {
  change_detector_->require_unchanged();
  reserve_space(path_, frame_bytes());
  const std::vector<FrameExtent> extents = write_frame(path_, {frames_, time, &values, nullptr});
  change_detector_->expect_present_size();
  if (options_.compression > 0) {
    for (const FrameExtent& extent : extents) stored_sizes_.push_back(extent.size);
  }
  checksums_.push_back(checksum(extents, &values));
  if (arrangement_->keeps_times()) times_.push_back(time);
  ++frames_;
}

/// Checksum of a frame's values as stored in the file. Those with the same form in memory, `values`, are not read back.
std::uint32_t FrameFile::checksum(const std::vector<FrameExtent>& extents,
                                  const std::vector<const void*>* values) const {
  Checksum sum;
  std::ifstream file;
  std::vector<char> bytes;
  for (std::size_t i = 0; i < layout_.size(); ++i) {
    const FrameExtent& extent = extents[i];
    if (values != nullptr && is_as_in_memory(layout_[i], options_)) {
      sum.add_bytes((*values)[i], std::size_t(extent.size));
      continue;
    }
    if (!file.is_open()) file.open(path_, std::ios::binary);
    bytes.resize(std::size_t(extent.size));
    file.seekg(extent.address);
    if (!file.read(bytes.data(), extent.size)) throw_file_error(path_, "read", errno);
    sum.add_bytes(bytes.data(), bytes.size());
  }
  return sum.value();
}

/// `extents`: those of all frames, one after the other.
void FrameFile::require_same(const std::vector<FrameExtent>& extents) const {
  for (long frame = 0; frame < frames_; ++frame) {
    const auto first = extents.begin() + frame * long(layout_.size());
    if (checksum({first, first + long(layout_.size())}, nullptr) == checksums_[std::size_t(frame)]) continue;
    throw Error(
        ErrorKind::file_access,
        fmt::format(
            "{}: {} differs from the data written before the checkpoint; restore the file, or start anew with --force",
            path_, arrangement_->name(frame)));
  }
}

std::vector<FrameExtent> FrameFile::write_frame(const std::string& path, const FrameToWrite& frame) const {
  const Hdf5Handle access = file_access(options_);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
  check_written(path, file >= 0, "the file");
  std::vector<FrameExtent> extents;
  try {
    extents = arrangement_->write(file, path, frame);
  } catch (const Error&) {
    H5Fclose(file);
    throw;
  }
  check_written(path, H5Fclose(file) >= 0, arrangement_->name(frame.number));
  return extents;
}

FrameExtent FrameFile::count_extent(const std::string& path) const {
  const Hdf5Handle access = file_access(options_);
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  check_written(path, file >= 0, "the file");
  return arrangement_->count_extent(file);
}

/// See the comment of frame_file.hpp: all bytes except the values of the frames that are kept come from a file of empty
/// frames.
void FrameFile::repair(const std::vector<FixedDataset>& fixed, Repair repair) const {
  const std::string pattern = path_ + ".pattern";
  const auto remove_pattern = [&] {
    std::error_code ignored;
    std::filesystem::remove(pattern, ignored);
  };
  try {
    create(pattern, fixed);
    std::vector<FrameExtent> retained;
    for (long frame = 0; frame < frames_; ++frame) {
      const std::int64_t* sizes =
          options_.compression > 0 ? stored_sizes_.data() + std::size_t(frame) * layout_.size() : nullptr;
      const double time = times_.empty() ? 0.0 : times_[std::size_t(frame)];
      const std::vector<FrameExtent> extents = write_frame(pattern, {frame, time, nullptr, sizes});
      retained.insert(retained.end(), extents.begin(), extents.end());
    }
    const auto size = std::int64_t(std::filesystem::file_size(pattern));
    require_length(path_, size);
    require_same(retained);
    if (repair == Repair::verify) {
      remove_pattern();
      return;
    }
    std::ranges::sort(retained, {}, &FrameExtent::address);
    retained.push_back({size, 0});
    copy_gaps(pattern, path_, retained, count_extent(pattern));
    // Truncation is last: if it is interrupted, the file is longer than recorded, which HDF5 can open, unlike a shorter
    // one.
    truncate_file(path_, size);
  } catch (const Error&) {
    remove_pattern();
    throw;
  }
  remove_pattern();
}

}  // namespace ricochet
