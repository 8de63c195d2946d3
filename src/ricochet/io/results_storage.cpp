#include "ricochet/io/results_storage.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include "ricochet/base/file_version.hpp"
#include "ricochet/io/file_lock.hpp"

namespace ricochet {

ResultsStorage::ResultsStorage(const std::string& directory, const ResultsFormat& format)
    : path_(directory + "/" + format.files.front()),
      lock_(directory + "/" + format.lock),
      reader_(path_),
      identity_(identify(path_)) {
  require_readable_version(path_, reader_->text_attribute("/", version_attribute));
}

ResultsStorage::Identity ResultsStorage::identify(const std::string& path) {
  struct statx file {};
  if (statx(AT_FDCWD, path.c_str(), 0, STATX_INO | STATX_BTIME, &file) != 0) return {};
  return {file.stx_ino, file.stx_btime.tv_sec, file.stx_btime.tv_nsec};
}

const Hdf5Reader& ResultsStorage::file() {
  if (reader_) return *reader_;
  FileLock lock(lock_);
  lock.acquire(FileLock::Kind::shared, longest_wait_of_a_reader);
  reader_.emplace(path_);
  try {
    if (identify(path_) != identity_)
      reader_->fail("/", "another run has replaced these results since they were read: read them again");
    look_up(*reader_);
  } catch (...) {
    close();
    throw;
  }
  return *reader_;
}

void ResultsStorage::close() {
  forget();
  reader_.reset();
}

}  // namespace ricochet
