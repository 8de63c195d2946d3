#include "ricochet/linear_algebra/graph_components.hpp"

namespace ricochet {

std::vector<std::vector<Index>> graph_components(const SparseMatrix& matrix, Index node_size) {
  const Index count = matrix.cols() / node_size;
  std::vector<char> seen(static_cast<std::size_t>(count), 0);
  std::vector<std::vector<Index>> components;
  for (Index first = 0; first < count; ++first) {
    if (seen[static_cast<std::size_t>(first)] != 0) continue;
    seen[static_cast<std::size_t>(first)] = 1;
    std::vector<Index> members{first};
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (SparseMatrix::InnerIterator entry(matrix, members[k] * node_size); entry; ++entry) {
        const Index neighbour = entry.row() / node_size;
        if (seen[static_cast<std::size_t>(neighbour)] != 0) continue;
        seen[static_cast<std::size_t>(neighbour)] = 1;
        members.push_back(neighbour);
      }
    }
    components.push_back(std::move(members));
  }
  return components;
}

}  // namespace ricochet
