#include "ricochet/hdf5/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"
#include "ricochet/hdf5/hdf5_trial.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

const char* kind_name(H5T_class_t kind) {
  switch (kind) {
    case H5T_INTEGER:
      return "whole numbers";
    case H5T_FLOAT:
      return "numbers";
    case H5T_STRING:
      return "text";
    default:
      return "data of another type";
  }
}

}  // namespace

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);  // in hdf5_handle.hpp

void quiet_hdf5() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Handle timeless_hdf5_properties(std::int64_t of_class) {
  const std::int64_t properties = H5Pcreate(of_class);
  H5Pset_obj_track_times(properties, false);
  return {properties, H5Pclose};
}

bool make_hdf5_group(std::int64_t file, const char* name) {
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_GROUP_CREATE);
  const Hdf5Handle made(H5Gcreate2(file, name, H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose);
  return made >= 0;
}

bool is_hdf5_file(const std::string& path) {
  quiet_hdf5();
  return fs::is_regular_file(path) && H5Fis_hdf5(path.c_str()) > 0;
}

struct Hdf5Reader::Dataset {
  std::string name;
  Hdf5Handle set, type, space;
  Dataset(const Hdf5Reader& reader, const std::string& which)
      : Dataset(reader, reader.has_dataset(which) ? 1 : 0, reader.file_, which, which) {}
  /// Opens a data set in a group that is open.
  Dataset(const Hdf5Reader& reader, std::int64_t group, const std::string& which, std::string full_name)
      : Dataset(reader, H5Lexists(group, which.c_str(), H5P_DEFAULT), group, which, std::move(full_name)) {}

 private:
  /// `exists`: negative if it cannot be looked up.
  Dataset(const Hdf5Reader& reader, int exists, std::int64_t group, const std::string& which, std::string full_name)
      : name(std::move(full_name)),
        set(exists > 0 ? H5Dopen2(group, which.c_str(), H5P_DEFAULT) : -1, H5Dclose),
        type(set >= 0 ? H5Dget_type(set) : -1, H5Tclose),
        space(set >= 0 ? H5Dget_space(set) : -1, H5Sclose) {
    if (exists == 0) reader.fail(name, "there is no such dataset");
    if (set < 0 || type < 0 || space < 0) reader.fail(name, "this dataset cannot be opened: the file is damaged");
  }
};

Hdf5Reader::Hdf5Reader(std::string path) : path_(std::move(path)) {
  quiet_hdf5();
  std::error_code problem;
  if (!fs::exists(path_, problem)) throw Error(ErrorKind::file_access, fmt::format("{}: no such file", path_));
  if (fs::is_directory(path_, problem))
    throw Error(ErrorKind::file_access, fmt::format("{}: is a directory, not a file", path_));
  if (!fs::is_regular_file(path_, problem))
    throw Error(ErrorKind::file_access, fmt::format("{}: is not a regular file, but a pipe or a device", path_));
  if (access(path_.c_str(), R_OK) != 0)
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot be read: {}", path_, std::strerror(errno)));
  if (H5Fis_hdf5(path_.c_str()) <= 0)
    throw Error(ErrorKind::invalid_input, fmt::format("{}: is not an HDF5 file", path_));
  try_hdf5_file(path_);
  file_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: cannot be opened as an HDF5 file: it is truncated or damaged", path_));
  }
}

Hdf5Reader::~Hdf5Reader() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Reader::fail(const std::string& name, const std::string& message) const {
  throw Error(ErrorKind::invalid_input, fmt::format("{}: {}: {}", path_, name, message));
}

bool Hdf5Reader::has(const std::string& name, bool group) const {
  // Every group on the way must exist: HDF5 treats a missing one as an error.
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    const htri_t exists = H5Lexists(file_, part.c_str(), H5P_DEFAULT);
    if (exists == 0) return false;
    if (exists < 0) fail(part, "cannot be looked up: the file is damaged");
    if (end == std::string::npos) break;
  }
  const Hdf5Handle object(H5Oopen(file_, name.c_str(), H5P_DEFAULT), H5Oclose);
  if (object < 0) fail(name, "cannot be opened: the file is damaged");
  return H5Iget_type(object) == (group ? H5I_GROUP : H5I_DATASET);
}

bool Hdf5Reader::has_group(const std::string& name) const { return has(name, true); }

bool Hdf5Reader::has_dataset(const std::string& name) const { return has(name, false); }

std::int64_t Hdf5Reader::size(const std::string& name) const {
  const Dataset set(*this, name);
  const int rank = H5Sget_simple_extent_ndims(set.space);
  const hssize_t count = H5Sget_simple_extent_npoints(set.space);
  if (rank < 0 || count < 0) fail(name, "the size of this dataset cannot be read: the file is damaged");
  // Vectors are also written as matrices of one column or one row.
  std::vector<hsize_t> extents(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(set.space, extents.data(), nullptr);
  if (std::ranges::count_if(extents, [](hsize_t n) { return n != 1; }) > 1)
    fail(name, fmt::format("has {} dimensions where one is expected", rank));
  return count;
}

void Hdf5Reader::check_size(const Dataset& set, std::int64_t expected_size, std::size_t bytes_per_entry) const {
  const std::int64_t found = size(set.name);
  if (found != expected_size) fail(set.name, fmt::format("has {} entries where {} are expected", found, expected_size));
  if (found > 0 && H5Dget_storage_size(set.set) == 0)
    accept_fill_value(set, found, bytes_per_entry);
  else
    check_stored(set, found, bytes_per_entry);
}

void Hdf5Reader::accept_fill_value(const Dataset& set, std::int64_t entries, std::size_t bytes_per_entry) const {
  const Hdf5Handle properties(H5Dget_create_plist(set.set), H5Pclose);
  H5D_fill_time_t time = H5D_FILL_TIME_NEVER;
  H5D_fill_value_t value = H5D_FILL_VALUE_UNDEFINED;
  if (H5Pget_fill_time(properties, &time) < 0 || H5Pfill_value_defined(properties, &value) < 0 ||
      time == H5D_FILL_TIME_NEVER || value == H5D_FILL_VALUE_UNDEFINED)
    fail(set.name, "was never written and has no fill value");
  // Nothing in the file shows that it is really meant to be so large.
  if (std::uint64_t(entries) * bytes_per_entry > file_size())
    fail(set.name,
         fmt::format("was never written, and its {} entries would need more space than the whole file", entries));
  log::warning(fmt::format("{}: {}: was never written; its fill value is read instead", path_, set.name));
}

std::uint64_t Hdf5Reader::file_size() const {
  std::error_code problem;
  const std::uint64_t size = fs::file_size(path_, problem);
  return problem ? 0 : size;
}

void Hdf5Reader::check_stored(const Dataset& set, std::int64_t entries, std::size_t bytes_per_entry) const {
  // A damaged header may claim more than the file holds; this is reported before memory is allocated for it.
  const Hdf5Handle properties(H5Dget_create_plist(set.set), H5Pclose);
  const bool filtered = properties < 0 || H5Pget_nfilters(properties) > 0;
  const auto stored = std::uint64_t(H5Dget_storage_size(set.set));
  const auto needed = std::uint64_t(entries) * bytes_per_entry;
  if (entries > 0 && (stored == 0 || (!filtered && (stored < needed || needed > file_size()))))
    fail(set.name, fmt::format("the file does not hold its {} entries: it is truncated or damaged", entries));
}

void Hdf5Reader::check_numbers(const Dataset& set) const {
  const H5T_class_t kind = H5Tget_class(set.type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT)
    fail(set.name, fmt::format("holds {} where numbers are expected", kind_name(kind)));
}

Vector Hdf5Reader::numbers(const Dataset& set, std::int64_t expected_size) const {
  check_numbers(set);
  check_size(set, expected_size, H5Tget_size(set.type));
  Vector result(expected_size);
  if (result.size() > 0 && H5Dread(set.set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.data()) < 0)
    fail(set.name, "cannot be read: the file is damaged");
  return result;
}

std::int64_t Hdf5Reader::integer(const std::string& name) const {
  const std::int64_t found = size(name);
  if (found != 1) fail(name, fmt::format("has {} entries where one number is expected", found));
  return integers(name, 1).front();
}

std::int64_t Hdf5Reader::attribute(const std::string& group, const std::string& name) const {
  const Hdf5Handle found(H5Aopen_by_name(file_, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(found >= 0 ? H5Aget_space(found) : -1, H5Sclose);
  std::int64_t value = 0;
  if (space < 0 || H5Sget_simple_extent_npoints(space) != 1 || H5Aread(found, H5T_NATIVE_INT64, &value) < 0)
    fail(group, fmt::format("has no numeric attribute \"{}\"", name));
  return value;
}

std::string Hdf5Reader::text_attribute(const std::string& group, const std::string& name) const {
  if (H5Aexists_by_name(file_, group.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return "";
  const Hdf5Handle found(H5Aopen_by_name(file_, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(found >= 0 ? H5Aget_type(found) : -1, H5Tclose);
  const Hdf5Handle space(found >= 0 ? H5Aget_space(found) : -1, H5Sclose);
  if (type < 0 || space < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 ||
      H5Sget_simple_extent_npoints(space) != 1)
    fail(group, fmt::format("has no attribute \"{}\" that is a text of fixed length", name));
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(found, type, text.data()) < 0) fail(group, "cannot be read: the file is damaged");
  return text.substr(0, text.find('\0'));
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& name, std::int64_t expected_size) const {
  const Dataset set(*this, name);
  std::vector<std::int64_t> result;
  if (H5Tget_class(set.type) != H5T_INTEGER) {
    for (const double value : numbers(set, expected_size)) {
      if (!(std::abs(value) < 0x1p53) || value != std::trunc(value))
        fail(name, fmt::format("entry {} is {}, which is not a whole number", result.size(), value));
      result.push_back(std::int64_t(value));
    }
    return result;
  }
  check_size(set, expected_size, H5Tget_size(set.type));
  result.resize(std::size_t(expected_size));
  if (!result.empty() && H5Dread(set.set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.data()) < 0)
    fail(name, "cannot be read: the file is damaged");
  return result;
}

Vector Hdf5Reader::reals(const std::string& name, std::int64_t expected_size) const {
  return leading_reals(name, expected_size, expected_size);
}

Vector Hdf5Reader::leading_reals(const std::string& name, std::int64_t used, std::int64_t expected_size) const {
  const Dataset set(*this, name);
  Vector values = numbers(set, expected_size);
  values.conservativeResize(used);
  const auto bad = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  if (bad != values.end()) fail(name, fmt::format("entry {} is {}, which is not finite", bad - values.begin(), *bad));
  return values;
}

std::pair<Index, Index> Hdf5Reader::extents(const std::string& name) const { return extents(Dataset(*this, name)); }

std::pair<Index, Index> Hdf5Reader::extents(const Dataset& set) const {
  const int rank = H5Sget_simple_extent_ndims(set.space);
  if (rank != 1 && rank != 2) fail(set.name, fmt::format("has {} dimensions where one or two are expected", rank));
  hsize_t sizes[2] = {0, 0};
  H5Sget_simple_extent_dims(set.space, sizes, nullptr);
  return {Index(sizes[0]), Index(sizes[1])};
}

void Hdf5Reader::check_table(const Dataset& set, Index rows, Index columns) const {
  const auto [found_rows, found_columns] = extents(set);
  if (found_rows != rows || found_columns != columns) {
    fail(set.name, fmt::format("has {} rows and {} columns where {} and {} are expected", found_rows, found_columns,
                               rows, columns));
  }
  check_numbers(set);
  check_stored(set, rows * std::max<Index>(columns, 1), H5Tget_size(set.type));
}

template <class Number>
void Hdf5Reader::read_table(const Hdf5Member& group, const std::string& name, Index rows, Index columns,
                            std::int64_t type, std::vector<Number>& values) const {
  const Hdf5Handle object(H5Oopen_by_addr(file_, group.address), H5Oclose);
  if (object < 0 || H5Iget_type(object) != H5I_GROUP) fail(group.name, "cannot be opened: the file is damaged");
  const Dataset set(*this, object, name, group.name + "/" + name);
  check_table(set, rows, columns);
  values.resize(std::size_t(rows * std::max<Index>(columns, 1)));
  if (!values.empty() && H5Dread(set.set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(set.name, "cannot be read: the file is damaged");
}

void Hdf5Reader::table(const Hdf5Member& group, const std::string& name, Index rows, Index columns,
                       std::vector<float>& values) const {
  read_table(group, name, rows, columns, H5T_NATIVE_FLOAT, values);
}

void Hdf5Reader::table(const Hdf5Member& group, const std::string& name, Index rows, Index columns,
                       std::vector<double>& values) const {
  read_table(group, name, rows, columns, H5T_NATIVE_DOUBLE, values);
}

std::vector<Hdf5Member> Hdf5Reader::members(const std::string& group) const {
  struct Found {
    const std::string& group;
    std::vector<Hdf5Member> members;
  } found{group, {}};
  if (!has_group(group)) fail(group, "there is no such group");
  const Hdf5Handle object(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose);
  const auto add = [](hid_t, const char* name, const H5L_info_t* info, void* data) -> herr_t {
    auto* own = static_cast<Found*>(data);
    if (info->type == H5L_TYPE_HARD) own->members.push_back({own->group + "/" + name, info->u.address});
    return 0;
  };
  if (object < 0 || H5Literate(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &found) < 0)
    fail(group, "its members cannot be read: the file is damaged");
  return std::move(found.members);
}

Matrix Hdf5Reader::real_table(const std::string& name, Index rows, Index columns) const {
  const Dataset set(*this, name);
  check_table(set, rows, columns);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(rows, std::max<Index>(columns, 1));
  if (values.size() > 0 && H5Dread(set.set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(name, "cannot be read: the file is damaged");
  if (!values.allFinite()) fail(name, "holds numbers that are not finite");
  return values;
}

std::vector<std::int64_t> Hdf5Reader::whole_table(const std::string& name, Index rows, Index columns) const {
  const Dataset set(*this, name);
  check_table(set, rows, columns);
  if (H5Tget_class(set.type) != H5T_INTEGER) fail(name, "does not hold whole numbers");
  std::vector<std::int64_t> values(static_cast<std::size_t>(rows * std::max<Index>(columns, 1)));
  if (!values.empty() && H5Dread(set.set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(name, "cannot be read: the file is damaged");
  return values;
}

std::string Hdf5Reader::text(const std::string& name) const {
  const Dataset set(*this, name);
  const H5T_class_t kind = H5Tget_class(set.type);
  if (kind != H5T_STRING) fail(name, fmt::format("holds {} where text is expected", kind_name(kind)));
  const hssize_t count = H5Sget_simple_extent_npoints(set.space);
  if (count < 0) fail(name, "the size of this dataset cannot be read: the file is damaged");
  std::string result;
  for (const std::string& entry : texts(set, std::size_t(count)))
    result += result.empty() || entry.empty() ? entry : "\n" + entry;
  return result;
}

std::vector<std::string> Hdf5Reader::texts(const Dataset& set, std::size_t count) const {
  std::vector<std::string> result;
  if (count == 0) return result;
  const std::size_t length = H5Tget_size(set.type);
  if (H5Dget_storage_size(set.set) == 0)
    accept_fill_value(set, std::int64_t(count), length);
  else
    check_stored(set, std::int64_t(count), length);
  if (H5Tis_variable_str(set.type) > 0) {
    std::vector<char*> values(count, nullptr);
    if (H5Dread(set.set, set.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      fail(set.name, "cannot be read: the file is damaged");
    for (char* value : values) {
      result.emplace_back(value != nullptr ? value : "");
      H5free_memory(value);
    }
    return result;
  }
  std::string whole(count * length, '\0');
  if (H5Dread(set.set, set.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, whole.data()) < 0)
    fail(set.name, "cannot be read: the file is damaged");
  for (std::size_t k = 0; k < count; ++k) {
    std::string value = whole.substr(k * length, length);
    value.resize(std::min(value.find('\0'), value.size()));
    if (H5Tget_strpad(set.type) == H5T_STR_SPACEPAD) value.resize(value.find_last_not_of(' ') + 1);
    result.push_back(std::move(value));
  }
  return result;
}

}  // namespace ricochet
