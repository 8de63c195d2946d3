#pragma once

#include <string>
#include <vector>

/// @file Values of closed forms that benchmarks/closed_forms.py computes (tests/data/closed_forms.csv).
namespace ricochet::test_support {

struct ClosedForm {
  std::string quantity;
  double x, time, value;
};

/// Returns the values of a problem; there must be some.
std::vector<ClosedForm> closed_forms(const std::string& problem);

}  // namespace ricochet::test_support
