#include "ricochet/io/frame_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "ricochet/base/error.hpp"
#include "support/case_run.hpp"

// Frames continued by a run that was interrupted anywhere: their bytes equal those of an uninterrupted run.

namespace ricochet::test_support {
namespace {

/// Number of nodes: large enough that displacements are compressed in single precision too, and small enough that
/// status numbers are not.
constexpr Index rows = 1500;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void overwrite(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

struct Writer {
  std::string path;
  FrameFileOptions options;
  std::vector<FixedDataset> fixed{{"/mesh/nodes", 2, 3, {1, 2, 3, 4, 5, 6}, {}},
                                  {"/mesh/cells", 2, 0, {}, {7, 8}},
                                  {.name = "/VTKHDF/Points", .same_as = "/mesh/nodes"},
                                  {"/VTKHDF/Types", 2, 0, {}, {3, 3}, "", true}};
  std::vector<DatasetLayout> layout{
      {"PointData/displacement", false, rows, 3}, {"PointData/status", true, rows, 0}, {"CellData/empty", false, 0, 0}};

  explicit Writer(const FrameFileOptions& with)
      : path(write_temporary(with.vtkhdf ? "results.vtkhdf" : "results.h5", "")), options(with) {
    if (options.vtkhdf) return;
    fixed.resize(2);
    for (DatasetLayout& each : layout) each.name = each.name.substr(each.name.find('/') + 1);
  }

  /// Numbers of a frame: some of them compress well, to a degree that depends on the frame.
  static std::vector<double> reals(long frame) {
    std::vector<double> values(3 * rows, double(frame));
    std::mt19937 random(static_cast<unsigned>(frame));
    for (std::size_t i = 0; i < std::size_t(7 * frame % 100); ++i) values[i] = double(random());
    return values;
  }
  static std::vector<int> integers(long frame) { return std::vector<int>(rows, int(frame)); }

  [[nodiscard]] FrameFile start() const { return {path, fixed, layout, options}; }
  [[nodiscard]] FrameFile resume(const Snapshot& snapshot) const {
    return {path, fixed, layout, options, snapshot.loader("results")};
  }
  static void append(FrameFile& file) {
    const std::vector<double> a = reals(file.frames());
    const std::vector<int> b = integers(file.frames());
    file.append({a.data(), b.data(), a.data()}, 0.1 * double(file.frames()));
  }
};

class FrameFiles : public ::testing::TestWithParam<FrameFileOptions> {
 protected:
  Writer writer{GetParam()};
};

TEST_P(FrameFiles, GoOnWithTheSameBytesWhereverTheyWereLeft) {
  constexpr long count = 70;       // more than a chunk of VTKHDF's tables, or a node of its indices, has room for
  std::vector<std::string> after;  // k frames
  std::vector<Snapshot> snapshots;
  FrameFile file = writer.start();
  for (long k = 0; k <= count; ++k) {
    after.push_back(content(writer.path));
    file.persist(snapshots.emplace_back().saver("results"));
    if (k < count) Writer::append(file);
  }
  for (const auto& [saved, left] :
       {std::pair{0, 0}, {0, 5}, {3, 3}, {3, 4}, {17, 40}, {39, 40}, {64, 65}, {64, 70}, {66, 70}}) {
    overwrite(writer.path, after[std::size_t(left)]);
    FrameFile resumed = writer.resume(snapshots[std::size_t(saved)]);
    EXPECT_EQ(resumed.frames(), saved);
    EXPECT_TRUE(content(writer.path) == after[std::size_t(saved)]) << saved << " of " << left;
    while (resumed.frames() < count) Writer::append(resumed);
    EXPECT_TRUE(content(writer.path) == after.back()) << saved << " of " << left;
  }
}

/// Anything but the numbers of the first frames may be damaged: torn index, lost end, garbage at the end.
TEST_P(FrameFiles, GoOnFromAFileThatWasTorn) {
  constexpr long count = 12, saved = 8;
  FrameFile file = writer.start();
  Snapshot snapshot;
  std::string at_checkpoint;
  while (file.frames() < count) {
    if (file.frames() == saved) {
      file.persist(snapshot.saver("results"));
      at_checkpoint = content(writer.path);
    }
    Writer::append(file);
  }
  const std::string end = content(writer.path);
  // Existing bytes that later frames changed: they may be the old or the new ones, or corrupted.
  for (int trial = 0; trial < 50; ++trial) {
    std::mt19937 random(static_cast<unsigned>(trial));
    std::string torn = end.substr(0, at_checkpoint.size() + random() % (end.size() - at_checkpoint.size()));
    for (std::size_t i = 0; i < at_checkpoint.size(); ++i) {
      if (at_checkpoint[i] != end[i] && random() % 2 == 0) torn[i] = random() % 2 == 0 ? at_checkpoint[i] : 'x';
    }
    for (std::size_t i = at_checkpoint.size(); i < torn.size(); ++i) {
      if (random() % 4 == 0) torn[i] = char(random());
    }
    overwrite(writer.path, torn);
    FrameFile resumed = writer.resume(snapshot);
    while (resumed.frames() < count) Writer::append(resumed);
    ASSERT_TRUE(content(writer.path) == end) << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FrameFiles,
                         ::testing::Values(FrameFileOptions{false, 0}, FrameFileOptions{true, 0},
                                           FrameFileOptions{false, 4}, FrameFileOptions{true, 1},
                                           FrameFileOptions{false, 0, true}, FrameFileOptions{true, 0, true},
                                           FrameFileOptions{false, 4, true}, FrameFileOptions{true, 1, true}),
                         [](const auto& info) {
                           return std::string(info.param.vtkhdf ? "VtkHdf" : "") +
                                  (info.param.single ? "Single" : "Double") +
                                  (info.param.compression > 0 ? "Compressed" : "");
                         });

TEST(FrameFile, RefusesAFileThatIsMissingOrShorter) {
  const Writer writer{FrameFileOptions{}};
  FrameFile file = writer.start();
  for (int k = 0; k < 4; ++k) Writer::append(file);
  Snapshot snapshot;
  file.persist(snapshot.saver("results"));
  const std::string whole = content(writer.path);
  overwrite(writer.path, whole.substr(0, whole.size() - 1));
  EXPECT_THROW((void)writer.resume(snapshot), Error);
  std::filesystem::remove(writer.path);
  EXPECT_THROW((void)writer.resume(snapshot), Error);
  EXPECT_FALSE(std::filesystem::exists(writer.path + ".pattern"));
}

}  // namespace
}  // namespace ricochet::test_support
