#include "ricochet/io/vtkhdf_frames.hpp"

#include <fmt/format.h>
#include <hdf5.h>

namespace ricochet {

namespace {

constexpr const char* root_name = "/VTKHDF";
constexpr const char* steps_name = "/VTKHDF/Steps";
/// Chunk length of the tables of steps.
constexpr hsize_t steps_per_chunk = 64;

/// Table of integers with one entry per step, which increases by a constant from step to step.
struct StepTable {
  std::string name;
  std::int64_t first, increment;
};

/// Name of the table with the first rows of the steps of a dataset.
std::string offsets_name(const std::string& dataset) {
  const std::size_t slash = dataset.find('/');
  if (slash == std::string::npos) return "PointOffsets";
  return dataset.substr(0, slash) + "Offsets" + dataset.substr(slash);
}

bool write_attribute(std::int64_t object, const char* name, std::int64_t type_in_file, std::int64_t type,
                     const std::vector<std::int64_t>& values) {
  const hsize_t count = values.size();
  const Hdf5Handle space(count > 1 ? H5Screate_simple(1, &count, nullptr) : H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(object, name, type_in_file, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, values.data()) >= 0;
}

/// Creates a dataset without rows and without a limit on their number.
bool make_growing(std::int64_t group, const std::string& name, std::int64_t type, Index columns,
                  std::int64_t properties) {
  const hsize_t extents[2] = {0, static_cast<hsize_t>(columns)};
  const hsize_t limits[2] = {H5S_UNLIMITED, static_cast<hsize_t>(columns)};
  const Hdf5Handle space(H5Screate_simple(columns > 0 ? 2 : 1, extents, limits), H5Sclose);
  const Hdf5Handle set(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  return set >= 0;
}

/// Extends a dataset by rows, and writes them if there are values.
bool write_rows(std::int64_t set, Index first, Index rows, Index columns, std::int64_t type, const void* values) {
  const hsize_t extents[2] = {static_cast<hsize_t>(first + rows), static_cast<hsize_t>(columns)};
  if (H5Dset_extent(set, extents) < 0) return false;
  if (values == nullptr || rows == 0) return true;
  const hsize_t begin[2] = {static_cast<hsize_t>(first), 0};
  const hsize_t count[2] = {static_cast<hsize_t>(rows), static_cast<hsize_t>(columns)};
  const Hdf5Handle in_file(H5Dget_space(set), H5Sclose);
  const Hdf5Handle in_memory = hdf5_space(rows, columns);
  return H5Sselect_hyperslab(in_file, H5S_SELECT_SET, begin, nullptr, count, nullptr) >= 0 &&
         H5Dwrite(set, type, in_memory, in_file, H5P_DEFAULT, values) >= 0;
}

class VtkHdfFrames : public FrameArrangement {
 public:
  VtkHdfFrames(const std::vector<FixedDataset>& fixed, std::vector<DatasetLayout> layout,
               const FrameFileOptions& options)
      : layout_(std::move(layout)), options_(options) {
    tables_ = {{"NumberOfParts", 1, 0}, {"PartOffsets", 0, 0}, {"CellOffsets", 0, 0}, {"ConnectivityIdOffsets", 0, 0}};
    bool points_move = false;
    for (const DatasetLayout& each : layout_) {
      tables_.push_back({offsets_name(each.name), 0, each.rows});
      points_move = points_move || each.name == "Points";
    }
    if (!points_move) tables_.push_back({"PointOffsets", 0, 0});
    // Fields that are constant over all steps have a constant offset.
    for (const FixedDataset& each : fixed) {
      for (const std::string group : {"/VTKHDF/PointData/", "/VTKHDF/CellData/"}) {
        if (each.name.starts_with(group))
          tables_.push_back({offsets_name(each.name.substr(std::string(root_name).size() + 1)), 0, 0});
      }
    }
  }

  void begin(std::int64_t file, const std::string& path) const override {
    const Hdf5Handle root(H5Gopen2(file, root_name, H5P_DEFAULT), H5Gclose);
    check_written(path,
                  root >= 0 && write_attribute(root, "Version", H5T_STD_I64LE, H5T_NATIVE_INT64, {2, 0}) &&
                      write_hdf5_text_attribute(root, "Type", "UnstructuredGrid") && make_hdf5_group(file, steps_name),
                  root_name);
    for (const char* group :
         {"/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/Steps/PointDataOffsets", "/VTKHDF/Steps/CellDataOffsets"}) {
      check_written(path, H5Lexists(file, group, H5P_DEFAULT) > 0 || make_hdf5_group(file, group), group);
    }
    for (const DatasetLayout& each : layout_) {
      const Hdf5Handle properties = timeless_hdf5_properties(H5P_DATASET_CREATE);
      set_hdf5_frame_properties(properties, each, options_, true);
      check_written(path, make_growing(root, each.name, hdf5_type(each, options_), each.columns, properties),
                    each.name);
    }
    const Hdf5Handle steps(H5Gopen2(file, steps_name, H5P_DEFAULT), H5Gclose);
    check_written(path, steps >= 0 && write_attribute(steps, "NSteps", H5T_STD_I64LE, H5T_NATIVE_INT64, {0}), "NSteps");
    const Hdf5Handle properties = timeless_hdf5_properties(H5P_DATASET_CREATE);
    const std::int64_t nothing = 0;
    H5Pset_chunk(properties, 1, &steps_per_chunk);
    H5Pset_fill_value(properties, H5T_NATIVE_INT64, &nothing);
    check_written(path, make_growing(steps, "Values", H5T_IEEE_F64LE, 0, properties), "Values");
    for (const StepTable& table : tables_)
      check_written(path, make_growing(steps, table.name, H5T_STD_I64LE, 0, properties), table.name);
  }

  [[nodiscard]] std::vector<FrameExtent> write(std::int64_t file, const std::string& path,
                                               const FrameToWrite& frame) const override {
    std::vector<FrameExtent> extents;
    {
      const Hdf5Handle root(H5Gopen2(file, root_name, H5P_DEFAULT), H5Gclose);
      check_written(path, root >= 0, root_name);
      for (std::size_t i = 0; i < layout_.size(); ++i) extents.push_back(write_dataset(root, path, frame, i));
    }
    const Hdf5Handle steps(H5Gopen2(file, steps_name, H5P_DEFAULT), H5Gclose);
    check_written(path, steps >= 0, steps_name);
    for (const StepTable& table : tables_) {
      const std::int64_t value = table.first + frame.number * table.increment;
      write_entry(steps, path, table.name, frame.number, H5T_NATIVE_INT64, &value);
    }
    const auto write_time = [&] { write_entry(steps, path, "Values", frame.number, H5T_NATIVE_DOUBLE, &frame.time); };
    // The step is counted once all its data are in the file, even if the run is killed in between. The following writes
    // are in place: a chunk for further times is allocated before.
    const bool needs_chunk = frame.number % long(steps_per_chunk) == 0;
    if (needs_chunk) write_time();
    check_written(path, H5Fflush(file, H5F_SCOPE_LOCAL) >= 0, name(frame.number));
    if (!needs_chunk) write_time();
    const Hdf5Handle attribute(H5Aopen(steps, "NSteps", H5P_DEFAULT), H5Aclose);
    const std::int64_t count = frame.number + 1;
    check_written(path, attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT64, &count) >= 0, "NSteps");
    return extents;
  }

  /// Extent of the header of the group of steps, which has the attribute NSteps.
  [[nodiscard]] FrameExtent count_extent(std::int64_t file) const override {
    H5O_info_t info{};
    if (H5Oget_info_by_name2(file, steps_name, &info, H5O_INFO_BASIC | H5O_INFO_HDR, H5P_DEFAULT) < 0) return {};
    return {std::int64_t(info.addr), std::int64_t(info.hdr.space.total)};
  }
  [[nodiscard]] std::string name(long frame) const override { return fmt::format("step {} of /VTKHDF", frame); }
  [[nodiscard]] bool keeps_times() const override { return true; }

 private:
  [[nodiscard]] FrameExtent write_dataset(std::int64_t root, const std::string& path, const FrameToWrite& frame,
                                          std::size_t i) const {
    const DatasetLayout& layout = layout_[i];
    const Hdf5Handle set(H5Dopen2(root, layout.name.c_str(), H5P_DEFAULT), H5Dclose);
    const Index first = layout.rows * frame.number;
    bool good = set >= 0 && write_rows(set, first, layout.rows, layout.columns,
                                       layout.is_integer ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE,
                                       frame.values != nullptr ? (*frame.values)[i] : nullptr);
    if (good && frame.values == nullptr && is_compressed(layout, options_)) {
      const std::vector<char> nothing(static_cast<std::size_t>(frame.stored_sizes[i]));
      const hsize_t origin[2] = {static_cast<hsize_t>(first), 0};
      good = H5Dwrite_chunk(set, H5P_DEFAULT, 0, origin, nothing.size(), nothing.data()) >= 0;
    }
    // HDF5 searches all chunks for one, so the address is determined only if required.
    FrameExtent extent{0, entries_of(layout) * (layout.is_integer || options_.single ? 4 : 8)};
    const bool is_requested = frame.values == nullptr || !is_as_in_memory(layout, options_);
    if (layout.rows > 0 && is_requested) extent = hdf5_chunk_extent(set, first, good);
    check_written(path, good, name(frame.number) + "/" + layout.name);
    return extent;
  }

  static void write_entry(std::int64_t steps, const std::string& path, const std::string& table, long step,
                          std::int64_t type, const void* value) {
    const Hdf5Handle set(H5Dopen2(steps, table.c_str(), H5P_DEFAULT), H5Dclose);
    check_written(path, set >= 0 && write_rows(set, step, 1, 0, type, value), table);
  }

  std::vector<DatasetLayout> layout_;
  FrameFileOptions options_;
  std::vector<StepTable> tables_;
};

}  // namespace

std::unique_ptr<const FrameArrangement> make_vtkhdf_frames(const std::vector<FixedDataset>& fixed,
                                                           const std::vector<DatasetLayout>& layout,
                                                           const FrameFileOptions& options) {
  return std::make_unique<VtkHdfFrames>(fixed, layout, options);
}

}  // namespace ricochet
