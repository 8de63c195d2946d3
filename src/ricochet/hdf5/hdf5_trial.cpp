#include "ricochet/hdf5/hdf5_trial.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <cstdint>
#include <ctime>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/trial.hpp"
#include "ricochet/hdf5/hdf5_handle.hpp"

namespace ricochet {

namespace {

/// Number of bytes of values that are read; for the others, readers compare sizes first.
constexpr std::int64_t most_bytes = 16 << 20;
/// Opening a data set takes some 20 µs; these limits are several times what a file of the smallest ones needs.
constexpr double least_seconds = 10.0, seconds_per_byte = 2e-7;

/// State of a visit of all objects.
struct Visit {
  std::int64_t bytes_left = most_bytes;
};

herr_t open_attribute(hid_t object, const char* name, const H5A_info_t* /*info*/, void* /*visit*/) {
  const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(attribute >= 0 ? H5Aget_type(attribute) : -1, H5Tclose);
  const Hdf5Handle space(attribute >= 0 ? H5Aget_space(attribute) : -1, H5Sclose);
  return 0;
}

/// Reads texts of variable length, which are stored apart from their data set.
void read_texts(hid_t set, hid_t type, std::size_t count) {
  std::vector<char*> values(count, nullptr);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
  for (char* value : values) H5free_memory(value);
}

void read_values(hid_t set, hid_t type, hid_t space, Visit& visit) {
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const bool is_number = H5Tget_class(type) == H5T_INTEGER || H5Tget_class(type) == H5T_FLOAT;
  const auto size = std::int64_t(is_number ? sizeof(double) : H5Tget_size(type));
  if (count <= 0 || size <= 0 || count > visit.bytes_left / size) return;
  visit.bytes_left -= count * size;
  if (H5Tis_variable_str(type) > 0) return read_texts(set, type, std::size_t(count));
  if (!is_number && H5Tget_class(type) != H5T_STRING) return;
  std::vector<char> values(static_cast<std::size_t>(count * size));
  static_cast<void>(H5Dread(set, is_number ? H5T_NATIVE_DOUBLE : type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void open_dataset(hid_t set, Visit& visit) {
  const Hdf5Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  const Hdf5Handle properties(H5Dget_create_plist(set), H5Pclose);
  if (type < 0 || space < 0 || properties < 0) return;
  hsize_t chunks = 0;
  if (H5Pget_layout(properties) == H5D_CHUNKED && H5Dget_num_chunks(set, space, &chunks) < 0) return;
  if (H5Dget_storage_size(set) > 0) read_values(set, type, space, visit);
}

herr_t open_object(hid_t file, const char* name, const H5O_info_t* info, void* visit) {
  const Hdf5Handle object(H5Oopen(file, name, H5P_DEFAULT), H5Oclose);
  if (object < 0) return 0;
  static_cast<void>(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, open_attribute, visit));
  if (info->type == H5O_TYPE_DATASET) open_dataset(object, *static_cast<Visit*>(visit));
  return 0;
}

bool open_all(const std::string& path) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  Visit visit;
  return file >= 0 && H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, open_object, &visit, H5O_INFO_BASIC) >= 0;
}

/// Identity of a file and time of its last change.
struct Stamp {
  dev_t device = 0;
  ino_t number = 0;
  off_t size = 0;
  time_t changed = 0;
  long changed_part = 0;  ///< nanoseconds
  bool operator==(const Stamp&) const = default;

  /// Returns whether the stamp is old enough: a change right after it would leave the same stamp, since clocks of file
  /// systems tick every few milliseconds.
  [[nodiscard]] bool is_settled() const {
    constexpr double longest_tick = 0.1;
    struct timespec now {};
    clock_gettime(CLOCK_REALTIME, &now);
    return double(now.tv_sec - changed) + 1e-9 * double(now.tv_nsec - changed_part) > longest_tick;
  }
};

std::optional<Stamp> stamp_of(const std::string& path) {
  struct stat file {};
  if (stat(path.c_str(), &file) != 0) return std::nullopt;
  return Stamp{file.st_dev, file.st_ino, file.st_size, file.st_mtim.tv_sec, file.st_mtim.tv_nsec};
}

}  // namespace

void try_hdf5_file(const std::string& path) {
  static std::mutex one_at_a_time;
  static std::map<std::string, Stamp> tried;
  const std::lock_guard lock(one_at_a_time);
  const std::optional<Stamp> stamp = stamp_of(path);
  if (const auto found = tried.find(path); stamp && found != tried.end() && found->second == *stamp) return;
  const double size = stamp ? double(stamp->size) : 0.0;
  const TrialResult outcome = try_in_child([&path] { return open_all(path); }, least_seconds + seconds_per_byte * size);
  if (!outcome.succeeded) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: cannot be read as an HDF5 file: reading it {}: it is truncated or damaged", path,
                            outcome.description()));
  }
  if (stamp && stamp->is_settled()) tried[path] = *stamp;
}

}  // namespace ricochet
