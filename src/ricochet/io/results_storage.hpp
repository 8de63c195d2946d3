#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/io/result_frames.hpp"
#include "ricochet/io/results_format.hpp"

/// @file The file that holds the mesh and the fields of a run, in either format: all of reading that depends on it.
namespace ricochet {

/// A run that goes on waits with its next frame for as long as files of it are looked at, and readers wait for it.
constexpr double longest_wait_of_a_reader = 10.0;  // seconds

class ResultsStorage {
 public:
  virtual ~ResultsStorage() = default;
  ResultsStorage(const ResultsStorage&) = delete;
  ResultsStorage& operator=(const ResultsStorage&) = delete;

  /// The frames that were complete when the run was first looked at.
  [[nodiscard]] const ResultFrames& frames() const { return frames_; }
  /// The file, opened again if it was closed. Throws Error(invalid_input) where another one is in its place by then.
  const Hdf5Reader& file();
  void close();
  /// The values of a field in a frame, row by row. Throws Error(invalid_input) where they are not there.
  virtual void read(Index frame, const ResultField& field, Index rows, std::vector<float>& values) = 0;
  virtual void read(Index frame, const ResultField& field, Index rows, std::vector<double>& values) = 0;

 protected:
  ResultsStorage(const std::string& directory, const std::string& name, ResultsFormat format);
  /// Of a file just opened: the places of all that is read later, which a run that goes on may change.
  virtual void look_up(const Hdf5Reader& file) = 0;
  virtual void forget() {}

  ResultFrames frames_;

 private:
  /// What tells a file from another one at its path, also where that has the same number again.
  struct Identity {
    std::uint64_t number = 0;
    std::int64_t born = 0, born_part = 0;  ///< seconds and nanoseconds, where the file system knows
    bool operator==(const Identity&) const = default;
  };
  [[nodiscard]] static Identity identify(const std::string& path);

  std::string path_, lock_;
  std::optional<Hdf5Reader> reader_;
  Identity identity_;
};

/// Of the run in a directory, whose lock the caller holds. Throws Error(file_access) where files are missing,
/// Error(invalid_input) where they are damaged.
[[nodiscard]] std::unique_ptr<ResultsStorage> open_results(const std::string& directory, ResultsFormat format);

}  // namespace ricochet
