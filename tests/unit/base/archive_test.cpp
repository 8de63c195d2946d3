#include "ricochet/base/archive.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/contact_status.hpp"

namespace ricochet::archive_test {

struct Thing {
  std::string name;
  std::vector<std::pair<int, double>> pairs;
  std::optional<Vector> values;
};

void persist(Archive& archive, Thing& thing) { archive.all(thing.name, thing.pairs, thing.values); }

TEST(Archive, GivesBackWhatItWasGiven) {
  std::vector<Thing> things{{"", {}, {}}, {"a \"b\"\n", {{3, -0.0}, {-7, 1e-308}}, Vector::Random(5)}};
  SparseMatrix columns(3, 4);
  columns.insert(2, 1) = -4.0;
  columns.insert(0, 3) = 5.0;
  SparseRowMatrix rows = columns;
  Points points = Points::Random(2, 3);
  std::vector<char> flags{1, 0, 1};
  ContactStatus status = ContactStatus::slip;
  std::array<bool, 3> free{true, false, true};
  Archive written;
  written.all(things, columns, rows, points, flags, status, free);

  std::vector<Thing> found_things;
  SparseMatrix found_columns;
  SparseRowMatrix found_rows;
  Points found_points;
  std::vector<char> found_flags;
  ContactStatus found_status = ContactStatus::open;
  std::array<bool, 3> found_free{};
  Archive read(written.take());
  read.all(found_things, found_columns, found_rows, found_points, found_flags, found_status, found_free);
  EXPECT_TRUE(read.is_at_end());
  ASSERT_EQ(found_things.size(), 2U);
  EXPECT_EQ(found_things[1].name, things[1].name);
  EXPECT_EQ(found_things[1].pairs, things[1].pairs);
  EXPECT_FALSE(found_things[0].values.has_value());
  EXPECT_EQ(*found_things[1].values, *things[1].values);
  EXPECT_EQ(Matrix(found_columns), Matrix(columns));
  EXPECT_EQ(Matrix(found_rows), Matrix(rows));
  EXPECT_EQ(found_points, points);
  EXPECT_EQ(found_flags, flags);
  EXPECT_EQ(found_status, status);
  EXPECT_EQ(found_free, free);
}

TEST(Archive, HandsOnTheSameBytesAsItKeeps) {
  Vector small = Vector::Random(7), large = Vector::Random(1 << 21);
  std::vector<int> numbers(3000000, 5);
  Archive kept;
  kept.all(small, large, numbers, small);
  std::vector<char> handed;
  int pieces = 0;
  Archive handing([&](std::span<const char> bytes) {
    handed.insert(handed.end(), bytes.begin(), bytes.end());
    ++pieces;
  });
  handing.all(small, large, numbers, small);
  handing.finish();
  EXPECT_GT(pieces, 2);
  EXPECT_TRUE(handed == kept.take());
}

/// Something absent is absent again, whatever is there before.
TEST(Archive, GivesBackWhetherSomethingIsThere) {
  std::shared_ptr<const double> absent, present = std::make_shared<const double>(0.5);
  std::optional<double> none, some = 0.25;
  Archive written;
  written.all(absent, present, none, some);
  std::shared_ptr<const double> found[] = {std::make_shared<const double>(1.0), nullptr};
  std::optional<double> values[] = {1.0, {}};
  Archive read(written.take());
  read.all(found[0], found[1], values[0], values[1]);
  EXPECT_EQ(found[0], nullptr);
  ASSERT_NE(found[1], nullptr);
  EXPECT_EQ(*found[1], 0.5);
  EXPECT_FALSE(values[0].has_value());
  EXPECT_EQ(values[1], 0.25);
}

TEST(Archive, RefusesWhatIsTooShort) {
  Vector values = Vector::Random(10);
  Archive written;
  written(values);
  std::vector<char> bytes = written.take();
  for (const std::size_t length : {std::size_t{0}, std::size_t{9}, bytes.size() - 1}) {
    Archive read(std::vector<char>(bytes.begin(), bytes.begin() + std::ptrdiff_t(length)));
    Vector found;
    EXPECT_THROW(read(found), Error);
  }
}

}  // namespace ricochet::archive_test
