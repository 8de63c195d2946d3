#pragma once

#include <cstdint>
#include <string>

/// @file Functions that all HDF5 files of the program share. HDF5's own header stays in the .cpp files.
namespace ricochet {

/// An identifier (HDF5's hid_t), closed at the end of its scope; a negative one needs no closing.
class Hdf5Handle {
 public:
  Hdf5Handle(std::int64_t id, int (*close)(std::int64_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  operator std::int64_t() const { return id_; }  // NOLINT: used wherever HDF5 expects an identifier

 private:
  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// Stops HDF5 from printing errors, which we report ourselves, and from cleaning up at the program's exit, where it
/// crashes after a disk has run full; our files are closed by then.
void quiet_hdf5();

/// Returns creation properties of a file, group or data set (`of_class`: H5P_FILE_CREATE, …) without its time of
/// creation: the same data give the same file.
[[nodiscard]] Hdf5Handle timeless_hdf5_properties(std::int64_t of_class);

/// Writes an attribute of an object: a text of fixed length without a terminating zero, as VTK's reader requires.
/// Returns false if this failed.
[[nodiscard]] bool write_hdf5_text_attribute(std::int64_t object, const char* name, const std::string& text);

/// Returns false if the group could not be created.
[[nodiscard]] bool make_hdf5_group(std::int64_t file, const char* name);

}  // namespace ricochet
