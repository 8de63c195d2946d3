#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/io/result_frames.hpp"
#include "ricochet/io/results_format.hpp"

/// @file File with the mesh and the fields of a run, in any format: the part of reading that depends on the format.
namespace ricochet {

/// Longest time that a reader waits for the lock. A run in progress delays its next frame while readers hold it.
constexpr double longest_wait_of_a_reader = 10.0;  // seconds

class ResultsStorage {
 public:
  virtual ~ResultsStorage() = default;
  ResultsStorage(const ResultsStorage&) = delete;
  ResultsStorage& operator=(const ResultsStorage&) = delete;

  /// Frames that were complete when the run was first opened.
  [[nodiscard]] const ResultFrames& frames() const { return frames_; }
  /// The file, reopened if it was closed. Throws Error(invalid_input) if it has been replaced.
  const Hdf5Reader& file();
  void close();
  using Values = std::variant<std::vector<float>*, std::vector<double>*>;
  /// Reads the values of a field in a frame, row by row. Throws Error(invalid_input) if they are missing.
  virtual void read(Index frame, const ResultField& field, Index rows, Values values) = 0;

 protected:
  /// The file is the first one of the format.
  ResultsStorage(const std::string& directory, const ResultsFormat& format);
  /// Stores the positions of all data to be read later, from a newly opened file: a run in progress may change them.
  virtual void look_up(const Hdf5Reader& file) = 0;
  virtual void forget() {}

  ResultFrames frames_;

 private:
  /// Distinguishes a file from another one at its path, even if the inode number is reused.
  struct Identity {
    std::uint64_t number = 0;
    std::int64_t born = 0, born_part = 0;  ///< seconds and nanoseconds, if the file system provides them
    bool operator==(const Identity&) const = default;
  };
  [[nodiscard]] static Identity identify(const std::string& path);

  std::string path_, lock_;
  std::optional<Hdf5Reader> reader_;
  Identity identity_;
};

}  // namespace ricochet
