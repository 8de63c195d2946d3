#include "ricochet/io/frame_arrangement.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/io/frame_groups.hpp"
#include "ricochet/io/vtkhdf_frames.hpp"

namespace ricochet {

/// Size in bytes from which a dataset is compressed.
constexpr Index least_compressed = 16384;

std::unique_ptr<const FrameArrangement> make_frame_arrangement(const std::vector<FixedDataset>& fixed,
                                                               const std::vector<DatasetLayout>& layout,
                                                               const FrameFileOptions& options) {
  if (options.vtkhdf) return make_vtkhdf_frames(fixed, layout, options);
  return make_frame_groups(layout, options);
}

bool is_compressed(const DatasetLayout& layout, const FrameFileOptions& options) {
  const Index bytes = entries_of(layout) * (layout.is_integer || options.single ? 4 : 8);
  return options.compression > 0 && bytes >= least_compressed;
}

bool is_as_in_memory(const DatasetLayout& layout, const FrameFileOptions& options) {
  return !is_compressed(layout, options) && (layout.is_integer || !options.single);
}

void check_written(const std::string& path, bool good, const std::string& what) {
  if (!good) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: cannot write {}: is the disk full, or has another program changed the file?", path, what));
  }
}

Hdf5Handle hdf5_space(Index rows, Index columns) {
  const hsize_t extents[2] = {static_cast<hsize_t>(rows), static_cast<hsize_t>(columns)};
  return {H5Screate_simple(columns > 0 ? 2 : 1, extents, nullptr), H5Sclose};
}

std::int64_t hdf5_type(const DatasetLayout& layout, const FrameFileOptions& options) {
  return layout.is_integer ? H5T_STD_I32LE : options.single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
}

void set_hdf5_frame_properties(std::int64_t properties, const DatasetLayout& layout, const FrameFileOptions& options,
                               bool chunked) {
  H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);
  const bool compressed = is_compressed(layout, options);
  if (compressed || chunked) {
    const hsize_t chunk[2] = {static_cast<hsize_t>(std::max<Index>(layout.rows, 1)),
                              static_cast<hsize_t>(layout.columns)};
    H5Pset_chunk(properties, layout.columns > 0 ? 2 : 1, chunk);
  }
  if (compressed) {
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, unsigned(options.compression));
  } else {
    H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
  }
}

FrameExtent hdf5_chunk_extent(std::int64_t set, Index first_row, bool& good) {
  const hsize_t origin[2] = {static_cast<hsize_t>(first_row), 0};
  haddr_t address = 0;
  hsize_t size = 0;
  good = good && H5Dflush(set) >= 0 && H5Dget_chunk_info_by_coord(set, origin, nullptr, &address, &size) >= 0;
  return {std::int64_t(address), std::int64_t(size)};
}

}  // namespace ricochet
