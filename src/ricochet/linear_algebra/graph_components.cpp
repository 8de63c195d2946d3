#include "ricochet/linear_algebra/graph_components.hpp"

namespace ricochet {

std::vector<std::vector<Index>> graph_components(const MatrixGraph& graph) {
  std::vector<char> visited(static_cast<std::size_t>(graph.size()), 0);
  std::vector<std::vector<Index>> components;
  for (Index first = 0; first < graph.size(); ++first) {
    if (visited[std::size_t(first)] != 0) continue;
    visited[std::size_t(first)] = 1;
    std::vector<Index> members{first};
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (const int neighbour : graph.neighbours(members[k])) {
        if (visited[std::size_t(neighbour)] != 0) continue;
        visited[std::size_t(neighbour)] = 1;
        members.push_back(neighbour);
      }
    }
    components.push_back(std::move(members));
  }
  return components;
}

}  // namespace ricochet
