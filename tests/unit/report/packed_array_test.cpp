#include "ricochet/report/packed_array.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace ricochet {
namespace {

std::string inflated(const std::string& blob, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf length = size;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length, reinterpret_cast<const Bytef*>(blob.data()),
                       blob.size()),
            Z_OK);
  EXPECT_EQ(length, size);
  return bytes;
}

unsigned byte(const std::string& bytes, std::size_t at) { return static_cast<unsigned char>(bytes.at(at)); }

/// Decodes the levels as the viewer does, from the description of the format.
std::vector<unsigned> decoded(const PackedArray& array, const std::string& bytes) {
  const auto columns = std::size_t(array.columns);
  const unsigned mask = (1U << array.bits) - 1U;
  const std::size_t planes = array.bits > 8 ? 2 : 1;
  std::vector<unsigned> levels;
  for (std::size_t r = 0; r < std::size_t(array.rows); ++r) {
    for (std::size_t i = 0; i < columns; ++i) {
      const auto level = [&](std::size_t row, std::size_t column) { return levels[row * columns + column]; };
      unsigned expected = r > 0 ? level(r - 1, i) : 0U;
      if (i > 0 && (r == 0 || array.prediction == 2)) expected += level(r, i - 1) - (r > 0 ? level(r - 1, i - 1) : 0U);
      unsigned code = byte(bytes, planes * r * columns + i);
      if (planes == 2) code |= byte(bytes, planes * r * columns + columns + i) << 8U;
      const unsigned difference = (code & 1U) != 0 ? ~(code >> 1U) : code >> 1U;
      levels.push_back((expected + difference) & mask);
    }
  }
  return levels;
}

TEST(PackedArrays, GiveRealsBackToTheBit) {
  std::vector<double> values{0.0, -0.0, 1.0 / 3.0, 1e300, -5e-324, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 100; ++i) values.push_back(std::sin(0.1 * i));
  PackedArrays arrays;
  const PackedArray array = arrays.add_reals(values, 2, 53);
  EXPECT_EQ(array.coding, Coding::reals);
  EXPECT_EQ(array.rows, 2);
  const std::string bytes = inflated(arrays.blobs().at(array.blob), 8 * values.size());
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < 8; ++k) word |= std::uint64_t(byte(bytes, k * values.size() + i)) << (8 * k);
    before ^= word;
    EXPECT_EQ(before, std::bit_cast<std::uint64_t>(values[i])) << i;
  }
}

TEST(PackedArrays, GiveIndicesBack) {
  const std::vector<int> values{5, 4, 4, 2147483647, -1, 0, 1000000, 999999};
  PackedArrays arrays;
  const PackedArray array = arrays.add_indices(values);
  const std::string bytes = inflated(arrays.blobs().at(array.blob), 4 * values.size());
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::uint32_t code = 0;
    for (std::size_t k = 0; k < 4; ++k) code |= byte(bytes, k * values.size() + i) << (8 * k);
    before += (code & 1U) != 0 ? ~(code >> 1U) : code >> 1U;
    EXPECT_EQ(std::int32_t(before), values[i]) << i;
  }
}

TEST(PackedArrays, KeepValuesToHalfALevel) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> noise(-1.0F, 1.0F);
  for (const bool smooth : {false, true}) {
    for (const int bits : {2, 6, 8, 9, 12, 16}) {
      constexpr Index rows = 20, columns = 31;
      std::vector<float> values;
      for (Index r = 0; r < rows; ++r) {
        for (Index i = 0; i < columns; ++i)
          values.push_back(smooth ? std::sin(0.2F * float(r) + 0.1F * float(i)) : noise(random));
      }
      values[3] = std::numeric_limits<float>::quiet_NaN();
      values[100] = -std::numeric_limits<float>::infinity();
      PackedArrays arrays;
      const PackedArray array = arrays.add_levels(values, rows, columns, bits);
      const std::size_t size = values.size() * (bits > 8 ? 2 : 1);
      const std::vector<unsigned> levels = decoded(array, inflated(arrays.blobs().at(array.blob), size));
      ASSERT_EQ(levels.size(), values.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (i == 3 || i == 100) {
          EXPECT_EQ(levels[i], (1U << bits) - 1U) << "no number";
        } else {
          EXPECT_NEAR(array.low + array.step * levels[i], double(values[i]), 0.5000001 * array.step) << i;
        }
      }
      EXPECT_NEAR(array.step, 2.0 / ((1U << bits) - 2U), smooth ? 1e-3 : 0.1 * array.step + 0.02);
    }
  }
}

TEST(PackedArrays, TakeTheBetterPrediction) {
  std::vector<float> still, wave;
  for (int r = 0; r < 30; ++r) {
    for (int i = 0; i < 200; ++i) {
      // Local flicker is uncorrelated with its neighbours; the motion of a whole body is correlated.
      still.push_back(float((i * 7919 + r * (i % 3)) % 101));
      wave.push_back(float(0.5 * r * r + std::sin(0.05 * i)));
    }
  }
  PackedArrays arrays;
  EXPECT_EQ(arrays.add_levels(still, 30, 200, 12).prediction, 1);
  EXPECT_EQ(arrays.add_levels(wave, 30, 200, 12).prediction, 2);
}

TEST(PackedArrays, KeepConstantsExactly) {
  PackedArrays arrays;
  const PackedArray array = arrays.add_levels(std::vector<float>(12, 0.7F), 3, 4, 12);
  for (const unsigned level : decoded(array, inflated(arrays.blobs().at(array.blob), 24)))
    EXPECT_EQ(array.low + array.step * level, double(0.7F));
}

TEST(PackedArrays, KeepSmallNumbersExactly) {
  const std::vector<float> values{-1, 0, 1, 2, 3, 253, 3, -1};
  PackedArrays arrays;
  const PackedArray array = arrays.add_small_numbers(values, 2, 4);
  const std::vector<unsigned> levels = decoded(array, inflated(arrays.blobs().at(array.blob), 8));
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(array.low + array.step * levels[i], double(values[i]));
}

TEST(PackedArrays, KeepEqualOnesOnce) {
  PackedArrays arrays;
  const PackedArray a = arrays.add_reals({1.0, 2.0}, 1, 2), b = arrays.add_reals({1.0, 2.5}, 1, 2),
                    c = arrays.add_reals({1.0, 2.0}, 2, 1);
  EXPECT_EQ(a.blob, c.blob);
  EXPECT_NE(a.blob, b.blob);
  EXPECT_EQ(arrays.blobs().size(), 2U);
}

TEST(Base64, IsThatOfRfc4648) {
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"},
                                                          {"\xff\xfb\xef", "//vv"}};
  for (const auto& [bytes, expected] : examples) {
    std::string text;
    append_base64(bytes, text);
    EXPECT_EQ(text, expected);
    EXPECT_EQ(base64_size(std::string_view(bytes).size()), text.size());
  }
}

}  // namespace
}  // namespace ricochet
