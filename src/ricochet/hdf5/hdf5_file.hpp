#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Small data sets of an HDF5 file, with errors that name file and data set. HDF5's own header stays in the .cpp.
namespace ricochet {

/// Returns whether there is a file that begins with the HDF5 signature.
[[nodiscard]] bool is_hdf5_file(const std::string& path);

/// A member of a group, and its address in the file.
struct Hdf5Member {
  std::string name;  ///< with its group: "/frames/000012"
  std::uint64_t address = 0;
};

/// Reads from a file that may be damaged or written by other programs: sizes are compared before anything is allocated,
/// and numbers of any integer or floating type are converted. Every error says what is wrong in the file.
class Hdf5Reader {
 public:
  /// Throws Error(file_access) if there is no such file or it cannot be opened, Error(invalid_input) if it is not HDF5,
  /// is truncated, or is damaged so that the library crashes: a child process tries it first (hdf5_trial.hpp).
  explicit Hdf5Reader(std::string path);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  /// An object that exists but cannot be opened is an error here, too.
  [[nodiscard]] bool has_group(const std::string& name) const;
  [[nodiscard]] bool has_dataset(const std::string& name) const;
  /// All of these throw Error(invalid_input) if there is no such data set or it is of another type. HDF5 allocates no
  /// space for a data set that was never written: vectors and texts of this kind are read as their fill value, with a
  /// warning.
  [[nodiscard]] std::int64_t integer(const std::string& name) const;
  /// Value of an attribute of a group.
  [[nodiscard]] std::int64_t attribute(const std::string& group, const std::string& name) const;
  /// Attribute of a group that is a text of fixed length; empty if there is none.
  [[nodiscard]] std::string text_attribute(const std::string& group, const std::string& name) const;
  /// Number of entries of a data set of one dimension (1 for a scalar).
  [[nodiscard]] std::int64_t size(const std::string& name) const;
  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& name, std::int64_t expected_size) const;
  /// Also throws if a number is not finite.
  [[nodiscard]] Vector reals(const std::string& name, std::int64_t expected_size) const;
  /// Returns the first `used` numbers; the others are reserved space and may be anything.
  [[nodiscard]] Vector leading_reals(const std::string& name, std::int64_t used, std::int64_t expected_size) const;
  /// Rows and columns (0: one dimension) of a data set of one or two dimensions.
  [[nodiscard]] std::pair<Index, Index> extents(const std::string& name) const;
  /// Reads a data set of a group returned by members(), row by row in single precision, with exactly so many rows and
  /// columns (0: one dimension). NaN and infinities are accepted. The group is accessed by its address instead of from
  /// the root, so this also works while another process adds to the groups above.
  void table(const Hdf5Member& group, const std::string& name, Index rows, Index columns,
             std::vector<float>& values) const;
  /// Version in double precision.
  void table(const Hdf5Member& group, const std::string& name, Index rows, Index columns,
             std::vector<double>& values) const;
  /// Members of a group, in the order of their names.
  [[nodiscard]] std::vector<Hdf5Member> members(const std::string& group) const;
  [[nodiscard]] Matrix real_table(const std::string& name, Index rows, Index columns) const;
  [[nodiscard]] std::vector<std::int64_t> whole_table(const std::string& name, Index rows, Index columns) const;
  /// Several entries are joined as lines; the text is empty if there are none.
  [[nodiscard]] std::string text(const std::string& name) const;
  /// Throws Error(invalid_input): "PATH: NAME: message".
  [[noreturn]] void fail(const std::string& name, const std::string& message) const;

 private:
  friend class Hdf5Rows;
  struct Dataset;
  [[nodiscard]] bool has(const std::string& name, bool group) const;
  void check_size(const Dataset& set, std::int64_t expected_size, std::size_t bytes_per_entry) const;
  void accept_fill_value(const Dataset& set, std::int64_t entries, std::size_t bytes_per_entry) const;
  [[nodiscard]] std::uint64_t file_size() const;
  [[nodiscard]] std::vector<std::string> texts(const Dataset& set, std::size_t count) const;
  void check_stored(const Dataset& set, std::int64_t entries, std::size_t bytes_per_entry) const;
  void check_numbers(const Dataset& set) const;
  [[nodiscard]] std::pair<Index, Index> extents(const Dataset& set) const;
  void check_table(const Dataset& set, Index rows, Index columns) const;
  template <class Number>
  void read_table(const Hdf5Member& group, const std::string& name, Index rows, Index columns, std::int64_t type,
                  std::vector<Number>& values) const;
  [[nodiscard]] Vector numbers(const Dataset& set, std::int64_t expected_size) const;

  std::string path_;
  std::int64_t file_ = -1;
};

/// Writes a file under a temporary name and renames it when it is complete. Data sets have the types and shapes of
/// HDF5's H5LTmake_dataset_int, _double and _string. They carry checksums (HDF5 1.10 or later reads them), so that a
/// damaged file is noticed. Throws Error(file_access).
class Hdf5Writer {
 public:
  explicit Hdf5Writer(std::string path);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& name);
  void integer(const std::string& name, int value);
  void integers(const std::string& name, const int* values, Index size);
  void reals(const std::string& name, const double* values, Index size);
  void text(const std::string& name, const std::string& value);
  /// Completes the file. Without this call no file is left behind.
  void close();

 private:
  void numbers(const std::string& name, bool real, const void* values, Index size);
  void check(bool good, const std::string& what) const;

  std::string path_, temporary_;
  std::int64_t file_ = -1;
};

}  // namespace ricochet
