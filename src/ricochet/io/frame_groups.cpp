#include "ricochet/io/frame_groups.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <list>

namespace ricochet {

namespace {

class FrameGroups : public FrameArrangement {
 public:
  FrameGroups(std::vector<DatasetLayout> layout, const FrameFileOptions& options)
      : layout_(std::move(layout)), options_(options) {
    for (const DatasetLayout& each : layout_) datasets_.emplace_back(each, options_);
  }

  void begin(std::int64_t file, const std::string& path) const override {
    check_written(path, make_hdf5_group(file, "/frames"), "/frames");
  }

  [[nodiscard]] std::vector<FrameExtent> write(std::int64_t file, const std::string& path,
                                               const FrameToWrite& frame) const override {
    std::vector<FrameExtent> extents;
    const std::string group_name = name(frame.number);
    const Hdf5Handle group(H5Gcreate2(file, group_name.c_str(), H5P_DEFAULT, group_properties_, H5P_DEFAULT), H5Gclose);
    check_written(path, group >= 0, group_name);
    auto prepared = datasets_.begin();
    for (std::size_t i = 0; i < layout_.size(); ++i, ++prepared)
      extents.push_back(write_dataset(group, path, frame, i, *prepared));
    return extents;
  }

  [[nodiscard]] std::string name(long frame) const override { return frame_group_name(frame); }
  [[nodiscard]] bool keeps_times() const override { return false; }

 private:
  /// HDF5 objects of a dataset, created once: creating them takes as long as writing a small dataset.
  struct Prepared {
    Hdf5Handle space, properties;
    Prepared(const DatasetLayout& layout, const FrameFileOptions& options)
        : space(hdf5_space(layout.rows, layout.columns)), properties(timeless_hdf5_properties(H5P_DATASET_CREATE)) {
      set_hdf5_frame_properties(properties, layout, options, false);
    }
  };

  [[nodiscard]] FrameExtent write_dataset(std::int64_t group, const std::string& path, const FrameToWrite& frame,
                                          std::size_t i, const Prepared& prepared) const {
    const DatasetLayout& layout = layout_[i];
    const std::string full_name = name(frame.number) + "/" + layout.name;
    const Hdf5Handle set(H5Dcreate2(group, layout.name.c_str(), hdf5_type(layout, options_), prepared.space,
                                    H5P_DEFAULT, prepared.properties, H5P_DEFAULT),
                         H5Dclose);
    check_written(path, set >= 0, full_name);
    const bool chunked = is_compressed(layout, options_);
    bool good = true;
    if (frame.values != nullptr) {
      good = H5Dwrite(set, layout.is_integer ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                      (*frame.values)[i]) >= 0;
    } else if (chunked) {
      const std::vector<char> nothing(static_cast<std::size_t>(frame.stored_sizes[i]));
      const hsize_t origin[2] = {0, 0};
      good = H5Dwrite_chunk(set, H5P_DEFAULT, 0, origin, nothing.size(), nothing.data()) >= 0;
    }
    FrameExtent extent;
    if (chunked) {
      extent = hdf5_chunk_extent(set, 0, good);
    } else if (layout.rows > 0) {
      extent = {std::int64_t(H5Dget_offset(set)), std::int64_t(H5Dget_storage_size(set))};
    }
    check_written(path, good, full_name);
    return extent;
  }

  std::vector<DatasetLayout> layout_;
  FrameFileOptions options_;
  Hdf5Handle group_properties_ = timeless_hdf5_properties(H5P_GROUP_CREATE);
  std::list<Prepared> datasets_;
};

}  // namespace

std::string frame_group_name(long frame) { return fmt::format("/frames/{:06d}", frame); }

std::unique_ptr<const FrameArrangement> make_frame_groups(const std::vector<DatasetLayout>& layout,
                                                          const FrameFileOptions& options) {
  return std::make_unique<FrameGroups>(layout, options);
}

}  // namespace ricochet
