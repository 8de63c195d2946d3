#pragma once

#include <string>

/// @file Lock file: a run writes a frame while no reader has the results open, and vice versa. The lock is advisory
/// (flock): readers that ignore it behave as without it. HDF5's own locks are not used, as their holders keep them
/// while a file is open, which would block a run.
namespace ricochet {

class FileLock {
 public:
  enum class Kind { shared, exclusive };

  /// Opens an existing file; if it cannot be opened, nothing is locked.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// Waits for at most so many seconds; returns false if others still hold the lock or files cannot be locked here.
  bool acquire(Kind kind, double seconds);
  void release();

 private:
  int file_ = -1;
};

}  // namespace ricochet
