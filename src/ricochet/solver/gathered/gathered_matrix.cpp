#include "ricochet/solver/gathered/gathered_matrix.hpp"

namespace ricochet {

SparseMatrix gather_matrix(const Ranks& ranks, const SparseMatrix& on_nodes, const std::vector<Index>& nodes, int d,
                           const GatheredNodes& gathered) {
  const auto dof_number = [&](Index dof) { return ranks.number_of(nodes[std::size_t(dof / d)]) * d + dof % d; };
  const auto size = std::size_t(ranks.size());
  Ranks::ForEach<std::int64_t> positions(size);
  Ranks::ForEach<double> values(size);
  const auto root = std::size_t(gathered.root());
  for (Index column = 0; column < on_nodes.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(on_nodes, column); entry; ++entry) {
      positions[root].push_back(dof_number(entry.row()));
      positions[root].push_back(dof_number(column));
      values[root].push_back(entry.value());
    }
  }
  const Ranks::ForEach<std::int64_t> received_positions = ranks.exchange(std::move(positions));
  const Ranks::ForEach<double> received_values = ranks.exchange(std::move(values));
  if (!gathered.is_root()) return {};
  const auto index_of = [&](std::int64_t dof) { return int(gathered.index_of(dof / d) * d + dof % d); };
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t rank = 0; rank < size; ++rank) {
    for (std::size_t i = 0; i < received_values[rank].size(); ++i)
      entries.emplace_back(index_of(received_positions[rank][2 * i]), index_of(received_positions[rank][2 * i + 1]),
                           received_values[rank][i]);
  }
  SparseMatrix result(gathered.count() * d, gathered.count() * d);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace ricochet
