#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

/// Data up to this size go into the header of their data set, which has a checksum; larger data into checked chunks.
constexpr std::size_t header_limit = 32768;
constexpr hsize_t chunk_entries = 1 << 17;

}  // namespace

bool write_hdf5_text_attribute(std::int64_t object, const char* name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size());
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, text.c_str()) >= 0;
}

Hdf5Writer::Hdf5Writer(std::string path) : path_(std::move(path)), temporary_(path_ + ".part") {
  quiet_hdf5();
  // This format puts a checksum on everything but the data themselves.
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_FILE_CREATE);
  errno = 0;
  file_ = H5Fcreate(temporary_.c_str(), H5F_ACC_TRUNC, properties, access);
  if (file_ < 0) {
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot be written{}{}", path_, errno != 0 ? ": " : "",
                                                    errno != 0 ? std::strerror(errno) : ""));
  }
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ < 0) return;
  H5Fclose(file_);
  std::error_code problem;
  fs::remove(temporary_, problem);
}

void Hdf5Writer::check(bool good, const std::string& what) const {
  if (!good) throw Error(ErrorKind::file_access, fmt::format("{}: cannot write {} (is the disk full?)", path_, what));
}

void Hdf5Writer::group(const std::string& name) { check(make_hdf5_group(file_, name.c_str()), name); }

void Hdf5Writer::numbers(const std::string& name, bool real, const void* values, Index size) {
  const hid_t type = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT;
  const auto count = static_cast<hsize_t>(size);
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_DATASET_CREATE);
  if (count * H5Tget_size(type) <= header_limit) {
    H5Pset_layout(properties, H5D_COMPACT);
  } else {
    const hsize_t chunk = std::min(count, chunk_entries);
    H5Pset_chunk(properties, 1, &chunk);
    H5Pset_fletcher32(properties);
  }
  const Hdf5Handle set(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  check(set >= 0 && (size == 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0), name);
}

void Hdf5Writer::integer(const std::string& name, int value) { numbers(name, false, &value, 1); }

void Hdf5Writer::integers(const std::string& name, const int* values, Index size) {
  numbers(name, false, values, size);
}

void Hdf5Writer::reals(const std::string& name, const double* values, Index size) { numbers(name, true, values, size); }

void Hdf5Writer::text(const std::string& name, const std::string& value) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.size() + 1);
  H5Tset_strpad(type, H5T_STR_NULLTERM);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_DATASET_CREATE);
  if (value.size() < header_limit) H5Pset_layout(properties, H5D_COMPACT);
  const Hdf5Handle set(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  check(set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.c_str()) >= 0, name);
}

void Hdf5Writer::close() {
  const bool good = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = H5Fclose(file_) >= 0;
  file_ = -1;
  std::error_code problem;
  if (good && closed) {
    fs::rename(temporary_, path_, problem);
    if (!problem) return;
  }
  fs::remove(temporary_, problem);
  check(false, "the file");
}

}  // namespace ricochet
