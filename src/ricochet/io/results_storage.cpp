#include "ricochet/io/results_storage.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <map>

#include "ricochet/base/file_version.hpp"
#include "ricochet/hdf5/hdf5_rows.hpp"
#include "ricochet/io/file_lock.hpp"
#include "ricochet/io/vtkhdf_reader.hpp"
#include "ricochet/io/xdmf_reader.hpp"

namespace ricochet {

ResultsStorage::ResultsStorage(const std::string& directory, const std::string& name, ResultsFormat format)
    : path_(directory + "/" + name),
      lock_(directory + "/" + lock_of_results(format)),
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

namespace {

/// results.h5, one group per frame; results.xdmf describes their content. Groups do not move in the file.
class GroupsStorage : public ResultsStorage {
 public:
  explicit GroupsStorage(const std::string& directory) : ResultsStorage(directory, "results.h5", ResultsFormat::xdmf) {
    frames_ = read_xdmf_frames(directory + "/results.xdmf");
    groups_ = file().members("/frames");
    if (groups_.size() < frames_.times.size()) {
      file().fail("/frames",
                  fmt::format("has {} frames, but results.xdmf has {}", groups_.size(), frames_.times.size()));
    }
  }

  void read(Index frame, const ResultField& field, Index rows, std::vector<float>& values) override {
    read_numbers(frame, field, rows, values);
  }
  void read(Index frame, const ResultField& field, Index rows, std::vector<double>& values) override {
    read_numbers(frame, field, rows, values);
  }

 private:
  void look_up(const Hdf5Reader& /*file*/) override {}
  template <class Number>
  void read_numbers(Index frame, const ResultField& field, Index rows, std::vector<Number>& values) {
    file().table(groups_[static_cast<std::size_t>(frame)], field.name, rows,
                 field.components > 1 ? field.components : 0, values);
  }

  std::vector<Hdf5Member> groups_;
};

/// results.vtkhdf, one dataset per field with the rows of all frames in sequence.
class RowsStorage : public ResultsStorage {
 public:
  explicit RowsStorage(const std::string& directory)
      : ResultsStorage(directory, "results.vtkhdf", ResultsFormat::vtkhdf) {
    frames_ = read_vtkhdf_frames(file());
    look_up(file());
  }

  void read(Index frame, const ResultField& field, Index rows, std::vector<float>& values) override {
    read_numbers(frame, field, rows, values);
  }
  void read(Index frame, const ResultField& field, Index rows, std::vector<double>& values) override {
    read_numbers(frame, field, rows, values);
  }

 private:
  void look_up(const Hdf5Reader& file) final {
    for (const ResultField& field : frames_.fields) {
      const std::string name = vtkhdf_name(field);
      values_of_.try_emplace(name, file, name);
    }
  }
  void forget() override { values_of_.clear(); }
  template <class Number>
  void read_numbers(Index frame, const ResultField& field, Index rows, std::vector<Number>& values) {
    static_cast<void>(file());
    values_of_.at(vtkhdf_name(field)).read(frame * rows, rows, values);
    if (field.components != static_cast<int>(vtk_tensor_from_ours.size())) return;
    std::array<Number, vtk_tensor_from_ours.size()> tensor;
    for (auto row = values.begin(); row != values.end(); row += tensor.size()) {
      std::copy_n(row, tensor.size(), tensor.begin());
      for (std::size_t k = 0; k < tensor.size(); ++k) row[vtk_tensor_from_ours[k]] = tensor[k];
    }
  }

  std::map<std::string, Hdf5Rows> values_of_;
};

}  // namespace

std::unique_ptr<ResultsStorage> open_results(const std::string& directory, ResultsFormat format) {
  if (format == ResultsFormat::vtkhdf) return std::make_unique<RowsStorage>(directory);
  return std::make_unique<GroupsStorage>(directory);
}

}  // namespace ricochet
