#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/distributed/communicator.hpp"

/// @file Nodes that several ranks share.
namespace ricochet {

/// The ranks that share each node of this rank, and their exchange of values. The first of the ranks that have a node
/// owns it.
class NodeExchange {
 public:
  /// `numbers` of this rank's nodes in the whole body, each once, from 0 to `count` − 1.
  NodeExchange(const Communicator& ranks, const std::vector<std::int64_t>& numbers, std::int64_t count);

  /// Replaces the contributions of all sharers of a node by their sum, with the same bits on all of them: contributions
  /// are added in the order of the ranks. Any number of values per node, node after node. One message to each
  /// neighbour.
  void accumulate(Vector& values) const { accumulate_any(values); }
  void accumulate(Eigen::VectorXf& values) const { accumulate_any(values); }
  /// Copies the values of a node's owner to all ranks that share it.
  void copy_from_owners(Vector& values) const;

  [[nodiscard]] bool is_owned(Index node) const { return !std::ranges::binary_search(not_owned_, node); }
  /// Returns the number of each node in the whole body.
  [[nodiscard]] const std::vector<std::int64_t>& numbers() const { return numbers_; }
  [[nodiscard]] Index owned_count() const { return nodes_ - Index(not_owned_.size()); }
  [[nodiscard]] const std::vector<Index>& not_owned() const { return not_owned_; }
  [[nodiscard]] const Traffic& traffic() const { return traffic_; }

 private:
  struct Neighbour {
    std::vector<Index> nodes;              ///< shared nodes, ordered by their numbers in the whole body
    std::vector<char> owned_by_neighbour;  ///< per node: owned by the neighbour
  };
  template <class Values>
  void accumulate_any(Values& values) const;
  template <class Values>
  void send_all(const Values& values, Index per_node) const;

  Communicator ranks_;
  std::vector<std::int64_t> numbers_;
  std::vector<Neighbour> neighbours_;      ///< by rank
  mutable std::vector<Message> messages_;  ///< one per neighbour
  std::vector<Index> shared_;              ///< nodes that some neighbour has, each once
  std::vector<Index> not_owned_;           ///< ascending
  Index nodes_ = 0;
  mutable Traffic traffic_;
  mutable std::vector<double> own_;
};

}  // namespace ricochet
