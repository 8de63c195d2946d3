#include "ricochet/solver/gathered/gathered_matrix.hpp"

namespace ricochet {

SparseMatrix gather_matrix(const Ranks& ranks, const SparseMatrix& on_nodes, const std::vector<Index>& nodes, int d,
                           const GatheredNodes& gathered) {
  const auto dof_number = [&](Index dof) {
    return ranks.number_of(nodes[static_cast<std::size_t>(dof / d)]) * d + dof % d;
  };
  const auto size = static_cast<std::size_t>(ranks.size());
  Ranks::ForEach<std::int64_t> places(size);
  Ranks::ForEach<double> values(size);
  const auto home = static_cast<std::size_t>(gathered.root());
  for (Index column = 0; column < on_nodes.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(on_nodes, column); entry; ++entry) {
      places[home].push_back(dof_number(entry.row()));
      places[home].push_back(dof_number(column));
      values[home].push_back(entry.value());
    }
  }
  const Ranks::ForEach<std::int64_t> known_places = ranks.exchange(std::move(places));
  const Ranks::ForEach<double> known_values = ranks.exchange(std::move(values));
  if (!gathered.is_root()) return {};
  const auto index_of = [&](std::int64_t dof) { return static_cast<int>(gathered.index_of(dof / d) * d + dof % d); };
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t rank = 0; rank < size; ++rank) {
    for (std::size_t i = 0; i < known_values[rank].size(); ++i)
      entries.emplace_back(index_of(known_places[rank][2 * i]), index_of(known_places[rank][2 * i + 1]),
                           known_values[rank][i]);
  }
  SparseMatrix result(gathered.count() * d, gathered.count() * d);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace ricochet
