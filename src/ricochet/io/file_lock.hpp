#pragma once

#include <string>

/// @file A file that says who may look: a run writes a frame while nobody opens the results, and the other way round.
/// Advisory (flock): readers that know nothing of it are as they were. HDF5's own locks are not used: their holders
/// keep them for as long as they have a file open, which would stop a run.
namespace ricochet {

class FileLock {
 public:
  enum class Kind { shared, exclusive };

  /// Of a file that is there; where it cannot be opened, the lock is none.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// Waits for so many seconds at most; false: others still hold it, or files cannot be locked here.
  bool acquire(Kind kind, double seconds);
  void release();

 private:
  int file_ = -1;
};

}  // namespace ricochet
