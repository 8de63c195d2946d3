#include "ricochet/io/line_checksums.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "ricochet/base/error.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

std::string line(int number) { return fmt::format("{},{:.17g}\n", number, 1.0 / (number + 1)); }

class LineChecksumsTest : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(folder_.file("rows.csv"), std::ios::binary) << text; }
  [[nodiscard]] std::string problem(const Snapshot& snapshot) const {
    return message_of([&] { require_same_files(folder_.path().string(), snapshot); }, ErrorKind::file_access);
  }

  TemporaryFolder folder_{std::filesystem::temp_directory_path(), "ricochet-test"};
};

TEST_F(LineChecksumsTest, NamesTheLinesThatHaveChanged) {
  for (const int count : {1, 2, 511, 512, 513, 1024, 1025, 5000}) {
    LineChecksums checksums;
    std::string text;
    for (int i = 0; i < count; ++i) {
      checksums.add(line(i));
      text += line(i);
    }
    EXPECT_EQ(checksums.length(), std::int64_t(text.size()));
    Snapshot snapshot;
    checksums.persist(snapshot.saver("rows"), "rows.csv");
    write(text);
    EXPECT_EQ(problem(snapshot), "") << count;
    write(text + "what came after it\n");
    EXPECT_EQ(problem(snapshot), "") << count;
    write(text.substr(0, text.size() - 1));
    EXPECT_TRUE(has(problem(snapshot), "bytes")) << count;
    for (const int changed : {0, count / 3, count - 1}) {
      std::string other;
      for (int i = 0; i < count; ++i) other += line(i);
      std::size_t at = 0;
      for (int i = 0; i < changed; ++i) at += line(i).size();
      other[at] = char(other[at] ^ 1);
      write(other);
      const std::string message = problem(snapshot);
      std::smatch found;
      if (std::regex_search(message, found, std::regex(": line ([0-9]+) differs"))) {
        EXPECT_EQ(std::stoi(found[1]), changed + 1);
      } else {
        ASSERT_TRUE(std::regex_search(message, found, std::regex("lines ([0-9]+) to ([0-9]+) differs"))) << message;
        EXPECT_LE(std::stoi(found[1]), changed + 1);
        EXPECT_GE(std::stoi(found[2]), changed + 1);
        EXPECT_LE(std::stoi(found[2]) - std::stoi(found[1]), count / 128) << message;
      }
    }
  }
}

TEST_F(LineChecksumsTest, AreTheSameWhereverTheyWereSaved) {
  constexpr int count = 2100;
  LineChecksums whole;
  for (int i = 0; i < count; ++i) whole.add(line(i));
  Snapshot expected;
  whole.persist(expected.saver("rows"), "rows.csv");
  for (const int left : {1, 300, 512, 513, 1023, 1999}) {
    LineChecksums first;
    for (int i = 0; i < left; ++i) first.add(line(i));
    Snapshot saved, found;
    first.persist(saved.saver("rows"), "rows.csv");
    LineChecksums second(saved.loader("rows"));
    for (int i = left; i < count; ++i) second.add(line(i));
    second.persist(found.saver("rows"), "rows.csv");
    EXPECT_EQ(expected.values(), found.values()) << left;
  }
}

TEST_F(LineChecksumsTest, RefuseWhatTheyHaveNotSaved) {
  LineChecksums checksums;
  for (int i = 0; i < 10; ++i) checksums.add(line(i));
  Snapshot snapshot;
  checksums.persist(snapshot.saver("rows"), "rows.csv");
  snapshot.save("rows.lines.pieces", std::int64_t{11});
  EXPECT_THROW(LineChecksums(snapshot.loader("rows")), Error);
  // Blocks of negative length.
  checksums.persist(snapshot.saver("rows"), "rows.csv");
  Snapshot::Integers lengths = snapshot.integers("rows.lines.lengths");
  lengths.front() = -1;
  snapshot.save("rows.lines.lengths", std::move(lengths));
  EXPECT_THROW(LineChecksums(snapshot.loader("rows")), Error);
  EXPECT_THROW(require_same_files(testing::TempDir(), snapshot), Error);
}

}  // namespace
}  // namespace ricochet::test_support
