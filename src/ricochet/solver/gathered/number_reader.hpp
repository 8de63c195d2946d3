#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Messages of numbers. Not part of the public interface.
namespace ricochet {

/// Reads numbers one after the other.
class NumberReader {
 public:
  explicit NumberReader(const std::vector<double>& numbers) : at_(numbers.data()), end_(at_ + numbers.size()) {}
  [[nodiscard]] bool is_at_end() const { return at_ == end_; }
  double next() { return *at_++; }
  Index integer() { return static_cast<Index>(next()); }
  template <class Values>
  void fill(Values&& values) {
    for (Index i = 0; i < values.size(); ++i) values.data()[i] = next();
  }

 private:
  const double *at_, *end_;
};

}  // namespace ricochet
