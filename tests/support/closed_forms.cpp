#include "support/closed_forms.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "support/paths.hpp"

namespace ricochet::test_support {

std::vector<ClosedForm> closed_forms(const std::string& problem) {
  std::ifstream lines(data_path("closed_forms.csv"));
  std::vector<ClosedForm> found;
  for (std::string name, quantity, numbers; std::getline(lines, name, ',');) {
    std::getline(lines, quantity, ',');
    std::getline(lines, numbers);
    char comma = 0;
    ClosedForm row{quantity, 0.0, 0.0, 0.0};
    if (!(std::istringstream(numbers) >> row.x >> comma >> row.time >> comma >> row.value))
      throw std::runtime_error("closed_forms.csv: " + numbers);
    if (name == problem) found.push_back(row);
  }
  if (found.empty()) throw std::runtime_error("closed_forms.csv has no problem " + problem);
  return found;
}

}  // namespace ricochet::test_support
