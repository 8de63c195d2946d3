#include "ricochet/hdf5/hdf5_rows.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>

namespace ricochet {

Hdf5Rows::Hdf5Rows(const Hdf5Reader& file, const std::string& name)
    : file_(file),
      name_(name),
      extents_(file.extents(name)),
      set_(H5Dopen2(file.file_, name.c_str(), H5P_DEFAULT), H5Dclose) {
  const Hdf5Handle type(set_ >= 0 ? H5Dget_type(set_) : -1, H5Tclose);
  const Hdf5Handle properties(set_ >= 0 ? H5Dget_create_plist(set_) : -1, H5Pclose);
  if (type < 0 || properties < 0) file_.fail(name_, "this dataset cannot be opened: the file is damaged");
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) file_.fail(name_, "does not hold numbers");
  // Counting the chunks loads their whole index into memory.
  const Hdf5Handle space(H5Dget_space(set_), H5Sclose);
  hsize_t chunks = 0;
  if (H5Pget_layout(properties) == H5D_CHUNKED && H5Dget_num_chunks(set_, space, &chunks) < 0)
    file_.fail(name_, "the index of this dataset cannot be read: the file is damaged");
}

std::size_t Hdf5Rows::entries(Index first, Index count) const {
  const auto [rows, columns] = extents_;
  if (first < 0 || count < 0 || first + count > rows)
    file_.fail(name_, fmt::format("has {} rows where {} are expected", rows, first + count));
  return std::size_t(count * std::max<Index>(columns, 1));
}

void Hdf5Rows::read(Index first, Index count, std::int64_t type, void* values) const {
  if (count == 0) return;
  const Index columns = extents_.second;
  const int rank = columns > 0 ? 2 : 1;
  const hsize_t begin[2] = {static_cast<hsize_t>(first), 0};
  const hsize_t size[2] = {static_cast<hsize_t>(count), static_cast<hsize_t>(columns)};
  const Hdf5Handle in_file(H5Dget_space(set_), H5Sclose);
  const Hdf5Handle in_memory(H5Screate_simple(rank, size, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(in_file, H5S_SELECT_SET, begin, nullptr, size, nullptr) < 0 ||
      H5Dread(set_, type, in_memory, in_file, H5P_DEFAULT, values) < 0)
    file_.fail(name_, "cannot be read: the file is damaged");
}

void Hdf5Rows::read(Index first, Index count, std::vector<float>& values) const {
  values.resize(entries(first, count));
  read(first, count, H5T_NATIVE_FLOAT, values.data());
}

void Hdf5Rows::read(Index first, Index count, std::vector<double>& values) const {
  values.resize(entries(first, count));
  read(first, count, H5T_NATIVE_DOUBLE, values.data());
}

}  // namespace ricochet
