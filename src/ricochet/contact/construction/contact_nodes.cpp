#include <map>
#include <tuple>

#include "ricochet/contact/construction/boundary_patch.hpp"

/// @file Nodal output of the contact boundary.
namespace ricochet {

namespace {

/// Node with the (first) pair to which it belongs, and its side: 1 for the opposite one.
using NodeKey = std::tuple<Index, int, char>;

class NodeTable {
 public:
  NodeTable(const BoundaryNodes& all, const Body& body, const std::vector<ContactPair>& pairs)
      : all_(all), body_(body), pairs_(pairs) {}

  void add(const BoundaryPatch& patch) {
    if (patch.obstacle == nullptr) {
      for (const BodyContact::Node& node : patch.nodes)
        rows_[{node.node, patch.first_pair(), char(node.own ? 0 : 1)}] = {0, &node};
      return;
    }
    for (const Index node : patch.reached) rows_[key(patch, node)] = {};
  }

  void fill(ContactBoundary& boundary) {
    const auto count = Index(rows_.size());
    boundary.node_normals.resize(boundary.dimension, count);
    boundary.node_initial_gap.resize(count);
    std::vector<Eigen::Triplet<double>> projections;
    for (auto& [key, row] : rows_) {
      const auto& [node, pair, is_opposite] = key;
      row.number = int(boundary.nodes.size());
      boundary.nodes.push_back(node);
      boundary.node_pair.push_back(pair);
      boundary.is_opposite.push_back(is_opposite);
      if (row.between_bodies != nullptr) {
        boundary.node_normals.col(row.number) = row.between_bodies->normal;
        boundary.node_initial_gap[row.number] = row.between_bodies->gap;
        for (const auto& [other, weight] : row.between_bodies->opposite)
          projections.emplace_back(row.number, int(other), weight);
        continue;
      }
      const Obstacle& obstacle = *pairs_[std::size_t(pair)].obstacle;
      const Vector position = body_.space->nodes.col(node);
      boundary.node_normals.col(row.number) = obstacle.normal(position);
      boundary.node_initial_gap[row.number] = obstacle.gap(position);
    }
    boundary.own_point.assign(std::size_t(count), -1);
    if (projections.empty()) return;
    boundary.opposite_projection.resize(count, body_.space->node_count());
    boundary.opposite_projection.setFromTriplets(projections.begin(), projections.end());
  }

  /// Registers points that are anchored at nodes, and pressure recovery.
  void recover(const BoundaryPatch& patch, ContactBoundary& boundary, std::vector<Eigen::Triplet<double>>& recovery) {
    for (std::size_t i = 0; i < patch.retained.size(); ++i) {
      const Index node = patch.retained[i].node;
      if (node < 0) continue;
      const auto row = rows_.find(key(patch, node));
      if (row != rows_.end()) boundary.own_point[std::size_t(row->second.number)] = patch.numbers[i];
    }
    const auto add = [&](const NodeKey& key, const Eigen::Triplet<double>& entry) {
      const auto row = rows_.find(key);
      if (row == rows_.end()) return;  // no multiplier in use has the node in its trace
      recovery.emplace_back(row->second.number, patch.numbers[std::size_t(entry.col())], entry.value());
    };
    for (const auto& entry : patch.recovery) add(key(patch, entry.row()), entry);
    for (const auto& entry : patch.opposite_recovery) add({entry.row(), patch.first_pair(), 1}, entry);
  }

 private:
  struct Row {
    int number = 0;
    const BodyContact::Node* between_bodies = nullptr;
  };
  [[nodiscard]] NodeKey key(const BoundaryPatch& patch, Index node) const {
    const int first = patch.obstacle == nullptr ? -1 : all_.first_pair(node, patch.obstacle);
    return {node, first < 0 ? patch.first_pair() : first, 0};
  }

  const BoundaryNodes& all_;
  const Body& body_;
  const std::vector<ContactPair>& pairs_;
  std::map<NodeKey, Row> rows_;
};

}  // namespace

void fill_boundary_nodes(const std::vector<std::unique_ptr<BoundaryPatch>>& patches, const BoundaryNodes& all,
                         const Body& body, const std::vector<ContactPair>& pairs, ContactBoundary& boundary) {
  NodeTable table(all, body, pairs);
  for (const auto& patch : patches) table.add(*patch);
  table.fill(boundary);
  std::vector<Eigen::Triplet<double>> recovery;
  for (const auto& patch : patches) table.recover(*patch, boundary, recovery);
  boundary.pressure_recovery.resize(Index(boundary.nodes.size()), boundary.size());
  boundary.pressure_recovery.setFromTriplets(recovery.begin(), recovery.end());
}

}  // namespace ricochet
