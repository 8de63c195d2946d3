#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/types.hpp"

/// @file Binary serialization of values, for another process of the same program.
namespace ricochet {

/// Serializes in both directions by one description: `archive(value)` appends the value or reads it. A composite type
/// has a function persist(archive, value) beside it, which passes its parts to the archive. Both processes must run
/// on the same kind of machine: neither a version nor the byte order is stored.
class Archive {
 public:
  /// Creates an archive that is written and kept in memory.
  Archive() = default;
  /// Accepts what has been written, one block after another; finish() passes on the last block.
  using Sink = std::function<void(std::span<const char>)>;
  explicit Archive(Sink sink) : sink_(std::move(sink)) {}
  /// Creates an archive that is read from these bytes.
  explicit Archive(std::vector<char> bytes) : bytes_(std::move(bytes)), reads_(true) {}

  [[nodiscard]] bool reads() const { return reads_; }
  [[nodiscard]] std::vector<char> take() { return std::move(bytes_); }
  void finish() {
    sink_(bytes_);
    bytes_.clear();
  }
  [[nodiscard]] bool is_at_end() const { return position_ == bytes_.size(); }

  template <class... Values>
  void all(Values&... values) {
    ((*this)(values), ...);
  }

  /// Passes on members for which other visitors have a rule, such as one by which they are divided.
  template <class Rule, class... Values>
  requires requires { typename Rule::IsMemberRule; }
  void operator()(const Rule&, Values&... values) { all(values...); }
  template <class Value>
  void operator()(Value& value) {
    if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      block(&value, 1);
    } else {
      persist(*this, value);
    }
  }
  void operator()(std::string& text) { sequence(text); }
  template <class Value>
  void operator()(std::vector<Value>& values) {
    if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      sequence(values);
    } else {
      values.resize(count(values.size()));
      for (Value& value : values) (*this)(value);
    }
  }
  template <class Value, std::size_t size>
  void operator()(std::array<Value, size>& values) {
    for (Value& value : values) (*this)(value);
  }
  template <class First, class Second>
  void operator()(std::pair<First, Second>& values) {
    all(values.first, values.second);
  }
  template <class Value>
  void operator()(std::optional<Value>& value) {
    bool is_there = value.has_value();
    (*this)(is_there);
    if (!is_there) return value.reset();
    if (!value) value.emplace();
    (*this)(*value);
  }
  template <class Value>
  void operator()(std::shared_ptr<const Value>& value) {
    bool is_there = value != nullptr;
    (*this)(is_there);
    if (!is_there) return value.reset();
    const auto own = reads_ ? std::make_shared<Value>() : std::make_shared<Value>(*value);
    (*this)(*own);
    if (reads_) value = own;
  }
  template <class Number, int rows, int columns, int options, int most_rows, int most_columns>
  void operator()(Eigen::Matrix<Number, rows, columns, options, most_rows, most_columns>& matrix) {
    const std::size_t high = count(std::size_t(matrix.rows()));
    const std::size_t wide = count(std::size_t(matrix.cols()));
    if (reads_) matrix.resize(Index(high), Index(wide));
    block(matrix.data(), std::size_t(matrix.size()));
  }
  /// Compresses a matrix that is written.
  template <int order>
  void operator()(Eigen::SparseMatrix<double, order, int>& matrix) {
    if (!reads_) matrix.makeCompressed();
    const std::size_t rows = count(std::size_t(matrix.rows()));
    const std::size_t columns = count(std::size_t(matrix.cols()));
    const std::size_t entries = count(std::size_t(matrix.nonZeros()));
    if (reads_) {
      matrix.resize(Index(rows), Index(columns));
      matrix.resizeNonZeros(Index(entries));
    }
    block(matrix.outerIndexPtr(), std::size_t(matrix.outerSize()) + 1);
    block(matrix.innerIndexPtr(), entries);
    block(matrix.valuePtr(), entries);
  }

 private:
  [[nodiscard]] std::size_t count(std::size_t own) {
    block(&own, 1);
    return own;
  }
  template <class Sequence>
  void sequence(Sequence& values) {
    values.resize(count(values.size()));
    block(values.data(), values.size());
  }
  template <class Value>
  void block(Value* values, std::size_t size) {
    const std::size_t length = size * sizeof(Value);
    if (length == 0) return;
    if (reads_) {
      if (bytes_.size() - position_ < length)
        throw Error(ErrorKind::invalid_input, "a message from another process has unexpected content");
      std::memcpy(values, bytes_.data() + position_, length);
      position_ += length;
    } else {
      const char* const begin = reinterpret_cast<const char*>(values);
      if (sink_ && bytes_.size() + length > most_buffered) finish();
      if (sink_ && length > most_buffered) {
        sink_({begin, length});
      } else {
        bytes_.insert(bytes_.end(), begin, begin + length);
      }
    }
  }

  static constexpr std::size_t most_buffered = std::size_t{1} << 22;

  std::vector<char> bytes_;
  Sink sink_;
  bool reads_ = false;
  std::size_t position_ = 0;
};

}  // namespace ricochet
