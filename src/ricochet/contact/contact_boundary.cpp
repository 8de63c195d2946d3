#include "ricochet/contact/contact_boundary.hpp"

#include <algorithm>

namespace ricochet {

std::vector<Index> ContactBoundary::unique_nodes() const {
  std::vector<Index> result(trace.innerIndexPtr(), trace.innerIndexPtr() + trace.nonZeros());
  result.insert(result.end(), reachable_nodes.begin(), reachable_nodes.end());
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace ricochet
