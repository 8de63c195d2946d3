#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

/// @file Errors on successively refined meshes, printed in a line with their observed orders.
namespace ricochet::test_support {

class Convergence {
 public:
  explicit Convergence(const std::string& label) { std::printf("%-42s", label.c_str()); }
  ~Convergence() { std::printf("\n"); }
  Convergence(const Convergence&) = delete;
  Convergence& operator=(const Convergence&) = delete;

  /// Adds an error, on a mesh twice as fine as the previous one.
  void add(double error) {
    errors_.push_back(error);
    std::printf("  %.2e", error);
    if (errors_.size() > 1) std::printf(" (%.2f)", last_order());
  }
  /// Returns the order between the last two.
  [[nodiscard]] double last_order() const { return std::log2(errors_.at(errors_.size() - 2) / errors_.back()); }

 private:
  std::vector<double> errors_;
};

}  // namespace ricochet::test_support
