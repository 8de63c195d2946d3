#include "ricochet/io/frame_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <list>
#include <numeric>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

namespace {

/// What a frame takes besides its numbers: names, extents, index.
constexpr std::int64_t administration = 65536;
/// Bytes of a data set from which on it is compressed.
constexpr Index least_compressed = 16384;

void check(const std::string& path, bool good, const std::string& what) {
  if (!good) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: cannot write {}: is the disk full, or has another program changed the file?", path, what));
  }
}

Hdf5Handle file_access() {
  const std::int64_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110);
  // Someone who looks at the frames that are there must not stop the run.
  H5Pset_file_locking(access, false, true);
  return {access, H5Pclose};
}

Hdf5Handle data_space(Index rows, Index columns) {
  const hsize_t extents[2] = {static_cast<hsize_t>(rows), static_cast<hsize_t>(columns)};
  return {H5Screate_simple(columns > 0 ? 2 : 1, extents, nullptr), H5Sclose};
}

Index entries(Index rows, Index columns) {
  return rows * std::max<Index>(columns, 1);
}

/// The groups above a name ("/mesh" of "/mesh/nodes").
void make_parent(std::int64_t file, const std::string& path, const std::string& name) {
  const std::string parent = name.substr(0, name.rfind('/'));
  if (parent.empty() || H5Lexists(file, parent.c_str(), H5P_DEFAULT) > 0) return;
  check(path, make_hdf5_group(file, parent.c_str()), parent);
}

void write_fixed(std::int64_t file, const std::string& path, const FixedDataset& fixed) {
  make_parent(file, path, fixed.name);
  const bool real = fixed.integers.empty();
  const Hdf5Handle space = data_space(fixed.rows, fixed.columns);
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_DATASET_CREATE);
  const Hdf5Handle set(H5Dcreate2(file, fixed.name.c_str(), real ? H5T_IEEE_F64LE : H5T_STD_I64LE, space, H5P_DEFAULT,
                                  properties, H5P_DEFAULT),
                       H5Dclose);
  const void* const values = real ? static_cast<const void*>(fixed.reals.data()) : fixed.integers.data();
  check(path,
        set >= 0 &&
            H5Dwrite(set, real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0,
        fixed.name);
}

}  // namespace

/// What HDF5 wants to know of the data sets of a frame, made once: that takes as long as to write a small one.
struct FrameFile::Prepared {
  struct Dataset {
    Hdf5Handle space, properties;
    std::int64_t type;

    Dataset(const DatasetLayout& layout, const FrameFileOptions& options)
        : space(data_space(layout.rows, layout.columns)),
          properties(timeless_hdf5_properties(H5P_DATASET_CREATE)),
          type(layout.whole     ? H5T_STD_I32LE
               : options.single ? H5T_IEEE_F32LE
                                : H5T_IEEE_F64LE) {
      // Its place in the file does not depend on its numbers, but for the size of compressed ones.
      H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);
      if (is_compressed(layout, options)) {
        const hsize_t chunk[2] = {static_cast<hsize_t>(layout.rows), static_cast<hsize_t>(layout.columns)};
        H5Pset_chunk(properties, layout.columns > 0 ? 2 : 1, chunk);
        H5Pset_shuffle(properties);
        H5Pset_deflate(properties, static_cast<unsigned>(options.compression));
      } else {
        H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
      }
    }
  };
  Hdf5Handle access = file_access();
  Hdf5Handle group = timeless_hdf5_properties(H5P_GROUP_CREATE);
  std::list<Dataset> datasets;

  Prepared(const std::vector<DatasetLayout>& layout, const FrameFileOptions& options) {
    for (const DatasetLayout& each : layout) datasets.emplace_back(each, options);
  }
  /// Small sets would grow: the index of a compressed one takes some 2 kB.
  static bool is_compressed(const DatasetLayout& layout, const FrameFileOptions& options) {
    const Index bytes = entries(layout.rows, layout.columns) * (layout.whole || options.single ? 4 : 8);
    return options.compression > 0 && bytes >= least_compressed;
  }
};

std::string FrameFile::frame_name(long frame) {
  return fmt::format("/frames/{:06d}", frame);
}

FrameFile::FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
                     const FrameFileOptions& options)
    : path_(std::move(path)), layout_(std::move(frame)), options_(options) {
  prepared_ = std::make_shared<Prepared>(layout_, options_);
  create(path_, fixed);
}

FrameFile::FrameFile(std::string path, const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> frame,
                     const FrameFileOptions& options, const Snapshot& snapshot, const std::string& name)
    : path_(std::move(path)), layout_(std::move(frame)), options_(options) {
  prepared_ = std::make_shared<Prepared>(layout_, options_);
  frames_ = snapshot.integer(name + ".frames");
  stored_sizes_ = snapshot.integers(name + ".stored_sizes", 0, std::int64_t{1} << 40);
  const std::size_t expected = options_.compression > 0 ? static_cast<std::size_t>(frames_) * layout_.size() : 0;
  if (stored_sizes_.size() != expected) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("the saved state does not fit: {} frames of {} data sets with {} sizes", frames_,
                            layout_.size(), stored_sizes_.size()));
  }
  checksums_ = snapshot.integers(name + ".checksums", 0, 0xffffffff);
  if (static_cast<long>(checksums_.size()) != frames_)
    throw Error(ErrorKind::invalid_input, "the saved state does not fit: a checksum per frame");
  repair(fixed);
}

void FrameFile::save(Snapshot& snapshot, const std::string& name) const {
  snapshot.save(name + ".frames", std::int64_t{frames_});
  snapshot.save(name + ".stored_sizes", stored_sizes_);
  snapshot.save(name + ".checksums", checksums_);
}

void FrameFile::create(const std::string& path, const std::vector<FixedDataset>& fixed) const {
  quiet_hdf5();
  std::int64_t bytes = administration;
  for (const FixedDataset& set : fixed) bytes += 8 * entries(set.rows, set.columns);
  { std::ofstream(path, std::ios::binary | std::ios::trunc); }
  reserve_space(path, bytes);
  const Hdf5Handle access = file_access();
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_FILE_CREATE);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, properties, access);
  check(path, file >= 0, "the file");
  try {
    for (const FixedDataset& set : fixed) write_fixed(file, path, set);
    make_parent(file, path, "/frames/");
  } catch (const Error&) {
    H5Fclose(file);
    throw;
  }
  check(path, H5Fclose(file) >= 0, "the file");
}

std::int64_t FrameFile::frame_bytes() const {
  std::int64_t bytes = administration;
  // What does not compress grows by some bytes in a thousand.
  for (const DatasetLayout& set : layout_) bytes += 8 * entries(set.rows, set.columns) * 101 / 100;
  return bytes;
}

void FrameFile::append(const std::vector<const void*>& values) {
  reserve_space(path_, frame_bytes());
  const std::vector<Extent> extents = write_frame(path_, frames_, &values, nullptr);
  if (options_.compression > 0) {
    for (const Extent& extent : extents) stored_sizes_.push_back(extent.size);
  }
  checksums_.push_back(checksum(extents, &values));
  ++frames_;
}

/// Of the numbers of a frame as they are in the file. Those that are there as they are in memory, `values`, are not
/// read again.
std::uint32_t FrameFile::checksum(const std::vector<Extent>& extents, const std::vector<const void*>* values) const {
  Checksum sum;
  std::ifstream file;
  std::vector<char> bytes;
  for (std::size_t i = 0; i < layout_.size(); ++i) {
    const Extent& extent = extents[i];
    const bool as_in_memory = !Prepared::is_compressed(layout_[i], options_) && (layout_[i].whole || !options_.single);
    if (values != nullptr && as_in_memory) {
      sum.add_bytes((*values)[i], static_cast<std::size_t>(extent.size));
      continue;
    }
    if (!file.is_open()) file.open(path_, std::ios::binary);
    bytes.resize(static_cast<std::size_t>(extent.size));
    file.seekg(extent.address);
    if (!file.read(bytes.data(), extent.size)) throw_file_error(path_, "read", errno);
    sum.add_bytes(bytes.data(), bytes.size());
  }
  return sum.value();
}

/// Extents of all frames, one after the other.
void FrameFile::require_same(const std::vector<Extent>& extents) const {
  for (long frame = 0; frame < frames_; ++frame) {
    const auto first = extents.begin() + frame * static_cast<long>(layout_.size());
    if (checksum({first, first + static_cast<long>(layout_.size())}, nullptr) ==
        checksums_[static_cast<std::size_t>(frame)])
      continue;
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: {} is not what the run wrote before its checkpoint; put the file back as it was, or start "
                    "anew with --force",
                    path_, frame_name(frame)));
  }
}

/// Without values: an empty frame of the same extents, given the stored sizes of compressed data sets.
std::vector<FrameFile::Extent> FrameFile::write_frame(const std::string& path, long frame,
                                                      const std::vector<const void*>* values,
                                                      const std::int64_t* stored_sizes) const {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, prepared_->access);
  check(path, file >= 0, "the file");
  std::vector<Extent> extents;
  const std::string name = frame_name(frame);
  const std::vector<char> nothing(
      stored_sizes != nullptr ? static_cast<std::size_t>(*std::max_element(stored_sizes, stored_sizes + layout_.size()))
                              : 0);
  try {
    const Hdf5Handle group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, prepared_->group, H5P_DEFAULT), H5Gclose);
    auto prepared = prepared_->datasets.begin();
    check(path, group >= 0, name);
    for (std::size_t i = 0; i < layout_.size(); ++i) {
      const Hdf5Handle set(H5Dcreate2(group, layout_[i].name.c_str(), prepared->type, prepared->space, H5P_DEFAULT,
                                      prepared->properties, H5P_DEFAULT),
                           H5Dclose);
      ++prepared;
      check(path, set >= 0, name + "/" + layout_[i].name);
      const bool chunked = Prepared::is_compressed(layout_[i], options_);
      const hsize_t origin[2] = {0, 0};
      bool good = true;
      if (values != nullptr) {
        good = H5Dwrite(set, layout_[i].whole ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                        (*values)[i]) >= 0;
      } else if (chunked) {
        good =
            H5Dwrite_chunk(set, H5P_DEFAULT, 0, origin, static_cast<std::size_t>(stored_sizes[i]), nothing.data()) >= 0;
      }
      Extent extent;
      if (chunked && good) {
        haddr_t address = 0;
        hsize_t size = 0;
        good = H5Dflush(set) >= 0 && H5Dget_chunk_info_by_coord(set, origin, nullptr, &address, &size) >= 0;
        extent = {static_cast<std::int64_t>(address), static_cast<std::int64_t>(size)};
      } else if (layout_[i].rows > 0) {
        extent = {static_cast<std::int64_t>(H5Dget_offset(set)), static_cast<std::int64_t>(H5Dget_storage_size(set))};
      }
      check(path, good, name + "/" + layout_[i].name);
      extents.push_back(extent);
    }
  } catch (const Error&) {
    H5Fclose(file);
    throw;
  }
  check(path, H5Fclose(file) >= 0, name);
  return extents;
}

/// See the file's comment: all bytes but the numbers of the frames that are to stay come from a file of empty frames.
void FrameFile::repair(const std::vector<FixedDataset>& fixed) const {
  const std::string pattern = path_ + ".pattern";
  const auto remove_pattern = [&] {
    std::error_code ignored;
    std::filesystem::remove(pattern, ignored);
  };
  try {
    create(pattern, fixed);
    std::vector<Extent> kept;
    for (long frame = 0; frame < frames_; ++frame) {
      const std::int64_t* sizes =
          options_.compression > 0 ? stored_sizes_.data() + static_cast<std::size_t>(frame) * layout_.size() : nullptr;
      const std::vector<Extent> extents = write_frame(pattern, frame, nullptr, sizes);
      kept.insert(kept.end(), extents.begin(), extents.end());
    }
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(pattern));
    require_length(path_, size);
    require_same(kept);
    std::sort(kept.begin(), kept.end(), [](const Extent& a, const Extent& b) { return a.address < b.address; });
    cut_back(path_, size);
    std::ifstream from(pattern, std::ios::binary);
    std::fstream to(path_, std::ios::binary | std::ios::in | std::ios::out);
    std::vector<char> bytes;
    std::int64_t at = 0;
    kept.push_back({size, 0});
    for (const Extent& extent : kept) {
      bytes.resize(static_cast<std::size_t>(std::max<std::int64_t>(extent.address - at, 0)));
      from.seekg(at);
      from.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      to.seekp(at);
      to.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      at = std::max(at, extent.address + extent.size);
    }
    to.flush();
    check(path_, from && to, "the file");
  } catch (const Error&) {
    remove_pattern();
    throw;
  }
  remove_pattern();
}

}  // namespace ricochet
