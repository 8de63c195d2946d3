#include "ricochet/report/packed_array.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <new>

namespace ricochet {

namespace {

/// Returns all first bytes, then all second bytes, …
template <class Word>
std::string by_byte(const std::vector<Word>& words) {
  std::string bytes(sizeof(Word) * words.size(), '\0');
  for (std::size_t k = 0; k < sizeof(Word); ++k) {
    for (std::size_t i = 0; i < words.size(); ++i)
      bytes[k * words.size() + i] = char(static_cast<unsigned char>(words[i] >> (8 * k)));
  }
  return bytes;
}

std::string deflated(const std::string& bytes, int strategy) {
  z_stream stream{};
  // 15 and 9: the largest window and the most memory.
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15, 9, strategy) != Z_OK) throw std::bad_alloc();
  std::string result(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib only reads it
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

/// Returns the smallest compressed form. Noise compresses better without a search for repetitions.
std::string smallest(const std::string& bytes) {
  std::string best = deflated(bytes, Z_DEFAULT_STRATEGY);
  for (const int strategy : {Z_HUFFMAN_ONLY, Z_RLE}) {
    std::string other = deflated(bytes, strategy);
    if (other.size() < best.size()) best = std::move(other);
  }
  return best;
}

/// Codes the differences of a row of levels from their predictions, small ones of either sign first: 0, −1, 1, −2, …
class LevelCoder {
 public:
  LevelCoder(int bits, int prediction) : mask_((1U << bits) - 1U), bits_(bits), prediction_(prediction) {}

  [[nodiscard]] std::uint16_t code(const std::uint16_t* row, const std::uint16_t* before, Index i) const {
    const unsigned above = before != nullptr ? before[i] : 0U;
    unsigned expected = above;
    if (i > 0 && (before == nullptr || prediction_ == 2))
      expected += row[i - 1] - (before != nullptr ? before[i - 1] : 0U);
    const unsigned difference = (row[i] - expected) & mask_;
    const bool negative = (difference >> (bits_ - 1)) != 0;
    return std::uint16_t((negative ? ~(difference << 1U) : difference << 1U) & mask_);
  }

 private:
  unsigned mask_;
  int bits_, prediction_;
};

/// Returns the low bytes of each row, followed by the high bytes if there are any.
std::string coded(const std::vector<std::uint16_t>& levels, Index rows, Index columns, int bits, int prediction) {
  const LevelCoder coder(bits, prediction);
  const int planes = bits > 8 ? 2 : 1;
  std::string bytes(static_cast<std::size_t>(planes) * levels.size(), '\0');
  for (Index r = 0; r < rows; ++r) {
    const std::uint16_t* row = levels.data() + r * columns;
    char* const out = bytes.data() + planes * r * columns;
    for (Index i = 0; i < columns; ++i) {
      const unsigned code = coder.code(row, r > 0 ? row - columns : nullptr, i);
      out[i] = char(static_cast<unsigned char>(code));
      if (planes == 2) out[columns + i] = char(static_cast<unsigned char>(code >> 8U));
    }
  }
  return bytes;
}

/// Returns the prediction with the smaller differences in some rows from the middle.
int better_prediction(const std::vector<std::uint16_t>& levels, Index rows, Index columns, int bits) {
  double bits_needed[2] = {0.0, 0.0};
  for (Index r = std::max<Index>(rows / 2, 1); r < std::min(rows, rows / 2 + 8); ++r) {
    const std::uint16_t* row = levels.data() + r * columns;
    for (int k = 0; k < 2; ++k) {
      const LevelCoder coder(bits, k + 1);
      for (Index i = 0; i < columns; ++i) bits_needed[k] += std::log2(1.0 + coder.code(row, row - columns, i));
    }
  }
  return bits_needed[1] < bits_needed[0] ? 2 : 1;
}

}  // namespace

std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

void append_base64(std::string_view bytes, std::string& text) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  text.reserve(text.size() + base64_size(bytes.size()));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[word >> (18U - 6U * k) & 63U] : '=';
  }
}

std::size_t PackedArrays::add(std::string bytes) {
  std::string blob = smallest(bytes);
  const auto found = std::ranges::find(blobs_, blob);
  if (found != blobs_.end()) return std::size_t(found - blobs_.begin());
  blobs_.push_back(std::move(blob));
  return blobs_.size() - 1;
}

std::size_t PackedArrays::page_bytes() const {
  std::size_t sum = 0;
  for (const std::string& blob : blobs_) sum += base64_size(blob.size());
  return sum;
}

PackedArray PackedArrays::add_reals(const std::vector<double>& values, Index rows, Index columns) {
  std::vector<std::uint64_t> words(values.size());
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto word = std::bit_cast<std::uint64_t>(values[i]);
    words[i] = word ^ before;
    before = word;
  }
  PackedArray array;
  array.blob = add(by_byte(words));
  array.rows = rows;
  array.columns = columns;
  return array;
}

PackedArray PackedArrays::add_indices(const std::vector<int>& values) {
  std::vector<std::uint32_t> words(values.size());
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto word = std::uint32_t(values[i]);
    const std::uint32_t difference = word - before;
    words[i] = (difference >> 31U) != 0 ? ~(difference << 1U) : difference << 1U;
    before = word;
  }
  PackedArray array;
  array.blob = add(by_byte(words));
  array.coding = Coding::indices;
  array.rows = 1;
  array.columns = Index(values.size());
  return array;
}

PackedArray PackedArrays::add_levels(const std::vector<float>& values, Index rows, Index columns, int bits) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) low = high = 0.0F;
  const unsigned last = (1U << bits) - 2U;
  PackedArray array;
  array.coding = Coding::levels;
  array.rows = rows;
  array.columns = columns;
  array.bits = bits;
  array.low = double(low);
  array.step = (double(high) - array.low) / last;
  const double inverse = array.step > 0.0 ? 1.0 / array.step : 0.0;
  std::vector<std::uint16_t> levels(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    levels[i] =
        std::uint16_t(std::isfinite(values[i])
                          ? std::min<unsigned>(unsigned(std::lround((double(values[i]) - array.low) * inverse)), last)
                          : last + 1U);
  }
  array.prediction = better_prediction(levels, rows, columns, bits);
  array.blob = add(coded(levels, rows, columns, bits, array.prediction));
  return array;
}

PackedArray PackedArrays::add_small_numbers(const std::vector<float>& values, Index rows, Index columns) {
  PackedArray array;
  array.coding = Coding::levels;
  array.rows = rows;
  array.columns = columns;
  array.bits = 8;
  array.low = -1.0;
  array.step = 1.0;
  std::vector<std::uint16_t> levels(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool known = values[i] >= -1.0F && values[i] < 254.0F;
    levels[i] = known ? std::uint16_t(std::lround(values[i] + 1.0F)) : std::uint16_t{255};
  }
  array.blob = add(coded(levels, rows, columns, 8, 1));
  return array;
}

}  // namespace ricochet
