#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "ricochet/io/frame_file.hpp"
#include "support/case_run.hpp"

// A run may be killed between any two writes to a VTKHDF file: every state of the file between them can be read, and
// holds all steps that it counts. HDF5 restructures some of its indices in place when they grow (in the format before
// 1.10 at step 64), and such a file cannot be read until it is complete.

namespace {

/// Called before each write to the file of this inode, if it is not empty.
std::function<void()> before_write;
ino_t watched = 0;

void announce(int file) {
  struct stat about {};
  if (before_write && fstat(file, &about) == 0 && about.st_ino == watched) before_write();
}

}  // namespace

// Linked in place of the system's functions: HDF5 and the standard library call them.
extern "C" ssize_t pwrite(int file, const void* data, std::size_t size, off_t offset) {
  announce(file);
  return syscall(SYS_pwrite64, file, data, size, offset);
}
extern "C" ssize_t write(int file, const void* data, std::size_t size) {
  announce(file);
  return syscall(SYS_write, file, data, size);
}
extern "C" ssize_t writev(int file, const iovec* parts, int count) {
  announce(file);
  return syscall(SYS_writev, file, parts, count);
}

namespace ricochet::killed_frame_files {
namespace {

constexpr Index rows_of_a_step = 1400;
const std::vector<DatasetLayout> layout{{"PointData/velocity", false, rows_of_a_step, 3},
                                        {"CellData/element", true, rows_of_a_step, 0}};
const std::vector<FixedDataset> fixed{{"/VTKHDF/Points", 2, 3, {1, 2, 3, 4, 5, 6}}};

struct Step {
  std::vector<double> reals;
  std::vector<int> integers;
  explicit Step(long number)
      : reals(3 * rows_of_a_step, 1.5 + double(number)), integers(rows_of_a_step, 1 + int(number)) {}
};

void append(FrameFile& file) {
  const Step step(file.frames());
  file.append({step.reals.data(), step.integers.data()}, 0.1 * double(file.frames()));
}

/// Rows of one step, or fewer if they cannot be read.
template <class Number>
std::vector<Number> read_step(hid_t file, const DatasetLayout& set, hsize_t step, hid_t type) {
  std::vector<Number> values(static_cast<std::size_t>(set.rows * std::max<Index>(set.columns, 1)));
  const Hdf5Handle dataset(H5Dopen2(file, ("/VTKHDF/" + set.name).c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const hsize_t begin[2] = {step * rows_of_a_step, 0}, count[2] = {rows_of_a_step, static_cast<hsize_t>(set.columns)};
  const Hdf5Handle memory = hdf5_space(set.rows, set.columns);
  const bool good = H5Sselect_hyperslab(space, H5S_SELECT_SET, begin, nullptr, count, nullptr) >= 0 &&
                    H5Dread(dataset, type, memory, space, H5P_DEFAULT, values.data()) >= 0;
  return good ? values : std::vector<Number>();
}

/// Number of steps that the file counts; -1 if one of them is missing.
long whole_steps(const std::string& path) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file < 0) return -1;
  const Hdf5Handle attribute(H5Aopen_by_name(file, "/VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  long count = 0;
  if (H5Aread(attribute, H5T_NATIVE_LONG, &count) < 0) return -1;
  for (long k = 0; k < count; ++k) {
    const Step expected(k);
    const auto number = static_cast<hsize_t>(k);
    if (read_step<double>(file, layout[0], number, H5T_NATIVE_DOUBLE) != expected.reals ||
        read_step<int>(file, layout[1], number, H5T_NATIVE_INT) != expected.integers)
      return -1;
  }
  return count;
}

/// Checks the states of a file between the writes of an operation on it.
void expect_whole_steps_between_writes(const std::string& path, long lowest, long highest,
                                       const std::function<void()>& work) {
  std::vector<std::string> states;
  struct stat about {};
  ASSERT_EQ(stat(path.c_str(), &about), 0);
  watched = about.st_ino;
  before_write = [&] {
    const std::function<void()> again = std::exchange(before_write, nullptr);
    states.push_back(path + "." + std::to_string(states.size()));
    std::filesystem::copy_file(path, states.back());
    before_write = again;
  };
  work();
  before_write = nullptr;
  EXPECT_GE(states.size(), 5U);
  for (const std::string& state : states) {
    const long count = whole_steps(state);
    EXPECT_TRUE(lowest <= count && count <= highest) << state << ": " << count;
    std::filesystem::remove(state);
  }
}

class KilledFrameFiles : public ::testing::TestWithParam<FrameFileOptions> {};

TEST_P(KilledFrameFiles, HoldAllStepsThatTheyCount) {
  const std::string path = test_support::write_temporary("results.vtkhdf", "");
  FrameFile file(path, fixed, layout, GetParam());
  Snapshot snapshot;
  constexpr long saved = 62, count = 66;
  while (file.frames() < count) {
    const long k = file.frames();
    if (k == saved) file.persist(snapshot.saver("results"));
    // Indices grow at some steps: these at steps fixed by their layout, older ones at step 64.
    const bool grows = k == 0 || k == 4 || k == 20 || k == 36 || k >= saved;
    if (grows)
      expect_whole_steps_between_writes(path, k, k + 1, [&] { append(file); });
    else
      append(file);
  }
  std::optional<FrameFile> resumed;
  expect_whole_steps_between_writes(
      path, saved, count, [&] { resumed.emplace(path, fixed, layout, GetParam(), snapshot.loader("results")); });
  for (long k = saved; k < count; ++k) expect_whole_steps_between_writes(path, k, k + 1, [&] { append(*resumed); });
}

INSTANTIATE_TEST_SUITE_P(All, KilledFrameFiles,
                         ::testing::Values(FrameFileOptions{false, 0, true}, FrameFileOptions{true, 1, true}),
                         [](const auto& info) { return info.param.single ? "SingleCompressed" : "Double"; });

}  // namespace
}  // namespace ricochet::killed_frame_files
