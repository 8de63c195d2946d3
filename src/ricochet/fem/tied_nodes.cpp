#include "ricochet/fem/tied_nodes.hpp"

#include <algorithm>
#include <map>

#include "ricochet/base/error.hpp"

namespace ricochet {

TiedNodes::TiedNodes(std::vector<Tie> ties, Index node_count)
    : ties_(std::move(ties)), tie_of_node_(std::size_t(node_count), -1) {
  std::ranges::sort(ties_, {}, &Tie::node);
  for (std::size_t i = 0; i < ties_.size(); ++i) tie_of_node_[std::size_t(ties_[i].node)] = int(i);
  // Each pass replaces nodes that are themselves tied; a chain is at most as long as there are contacts.
  constexpr int longest_chain = 16;
  for (int iteration = 0;; ++iteration) {
    bool changed = false;
    for (Tie& tie : ties_) {
      const bool follows_tied =
          std::ranges::any_of(tie.weights, [this](const auto& entry) { return is_tied(entry.first); });
      if (!follows_tied) continue;
      tie.weights = spread(tie.weights);
      changed = true;
    }
    if (!changed) return;
    if (iteration == longest_chain) {
      throw Error(ErrorKind::invalid_input,
                  "tied surfaces follow each other in a cycle: exchange \"group\" and \"against\" of one of them, and "
                  "set multipliers_on = \"group\" in all");
    }
  }
}

TiedNodes::Weights TiedNodes::spread(const Weights& weights) const {
  std::map<Index, double> sums;
  for (const auto& [node, weight] : weights) {
    if (!is_tied(node)) {
      sums[node] += weight;
      continue;
    }
    const Tie& tie = ties_[std::size_t(tie_of_node_[std::size_t(node)])];
    for (const auto& [other, part] : tie.weights) sums[other] += weight * part;
  }
  return {sums.begin(), sums.end()};
}

SparseMatrix TiedNodes::condense_general(const SparseMatrix& matrix, int components) const {
  const auto nodes = Index(tie_of_node_.size());
  std::vector<Eigen::Triplet<double>> entries;
  const auto enter = [&](Index row, Index column, double value) {
    for (int k = 0; k < components; ++k)
      entries.emplace_back(int(row * components + k), int(column * components + k), value);
  };
  for (Index node = 0; node < nodes; ++node) {
    if (!is_tied(node)) enter(node, node, 1.0);
  }
  for (const Tie& tie : ties_) {
    for (const auto& [other, weight] : tie.weights) enter(tie.node, other, weight);
  }
  SparseMatrix spreading(nodes * components, nodes * components);
  spreading.setFromTriplets(entries.begin(), entries.end());
  const SparseMatrix product = matrix * spreading;
  return spreading.transpose() * product;
}

SparseMatrix TiedNodes::condense(const SparseMatrix& matrix, int components) const {
  const SparseMatrix condensed = condense_general(matrix, components);
  const SparseMatrix transposed = condensed.transpose();
  SparseMatrix result = 0.5 * (condensed + transposed);
  result.makeCompressed();
  return result;
}

void TiedNodes::condense_load(Vector& load, int d) const {
  for (const Tie& tie : ties_) {
    for (const auto& [node, weight] : tie.weights) load.segment(node * d, d) += weight * load.segment(tie.node * d, d);
    load.segment(tie.node * d, d).setZero();
  }
}

void TiedNodes::complete(Vector& values, int d) const {
  for (const Tie& tie : ties_) {
    values.segment(tie.node * d, d).setZero();
    for (const auto& [node, weight] : tie.weights)
      values.segment(tie.node * d, d) += weight * values.segment(node * d, d);
  }
}

}  // namespace ricochet
