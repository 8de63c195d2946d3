#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// @file Naming the entities at fault in a message. Private to mesh/.
namespace ricochet {

/// Stores the first few numbers of entities and counts all of them.
class Offenders {
 public:
  void add(std::int64_t number) {
    if (first_.size() < 5) first_.push_back(number);
    ++count_;
  }
  [[nodiscard]] bool any() const { return count_ > 0; }
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Returns "element 12" or "9 elements (12, 13, 14, 15, 16, …)".
  [[nodiscard]] std::string text(const std::string& singular) const;

 private:
  std::vector<std::int64_t> first_;
  std::int64_t count_ = 0;
};

/// Throws Error(invalid_input) about the mesh from `source`.
[[noreturn]] void fail_mesh(const std::string& source, const std::string& message);

}  // namespace ricochet
