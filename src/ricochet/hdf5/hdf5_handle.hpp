#pragma once

#include <cstdint>

/// @file What all HDF5 files of the program have in common. HDF5's own header stays in the .cpp files.
namespace ricochet {

/// An identifier (HDF5's hid_t), closed at the end of its scope. Negative: there is nothing to close.
class Hdf5Handle {
 public:
  Hdf5Handle(std::int64_t id, int (*close)(std::int64_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  operator std::int64_t() const { return id_; }  // NOLINT: used wherever HDF5 wants an identifier

 private:
  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// Errors are reported by us, not printed by HDF5, which also must not tidy up at the program's end: after a disk has
/// run full it crashes then, and our files are closed.
void quiet_hdf5();

/// Properties of a file, group or data set to be made (`of_class`: H5P_FILE_CREATE, …) that does not carry the time at
/// which it was made: the same data give the same file.
[[nodiscard]] Hdf5Handle timeless_hdf5_properties(std::int64_t of_class);

/// False: it could not be made.
[[nodiscard]] bool make_hdf5_group(std::int64_t file, const char* name);

}  // namespace ricochet
