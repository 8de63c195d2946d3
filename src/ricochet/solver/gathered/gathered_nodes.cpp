#include "ricochet/solver/gathered/gathered_nodes.hpp"

#include <algorithm>

namespace ricochet {

GatheredNodes::GatheredNodes(const Ranks& ranks, int root_rank, const std::vector<Index>& nodes,
                             const GatheredNodes* first)
    : ranks_(&ranks), root_(root_rank), nodes_(nodes) {
  std::ranges::sort(nodes_);
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  const auto size = std::size_t(ranks.size());
  Ranks::ForEach<std::int64_t> sent(size), sent_owned(size);
  for (const Index node : nodes_) {
    sent[std::size_t(root_rank)].push_back(ranks.number_of(node));
    sent_owned[std::size_t(root_rank)].push_back(ranks.is_owned(node) ? 1 : 0);
    if (ranks.is_owned(node)) owned_.push_back(node);
  }
  const Ranks::ForEach<std::int64_t> received = ranks.exchange(std::move(sent));
  const Ranks::ForEach<std::int64_t> received_owned = ranks.exchange(std::move(sent_owned));
  if (!is_root()) return;
  if (first != nullptr) numbers_ = first->numbers_;
  std::vector<std::int64_t> before = numbers_, others;
  std::ranges::sort(before);
  for (const auto& list : received) {
    for (const std::int64_t number : list) {
      if (!std::ranges::binary_search(before, number)) others.push_back(number);
    }
  }
  std::ranges::sort(others);
  others.erase(std::unique(others.begin(), others.end()), others.end());
  numbers_.insert(numbers_.end(), others.begin(), others.end());
  for (std::size_t index = 0; index < numbers_.size(); ++index) index_.emplace_back(numbers_[index], Index(index));
  std::ranges::sort(index_);
  indices_.resize(size);
  owned_indices_.resize(size);
  for (std::size_t rank = 0; rank < size; ++rank) {
    for (std::size_t i = 0; i < received[rank].size(); ++i) {
      indices_[rank].push_back(index_of(received[rank][i]));
      if (received_owned[rank][i] != 0) owned_indices_[rank].push_back(indices_[rank].back());
    }
  }
}

Index GatheredNodes::index_of(std::int64_t number) const {
  const auto found = std::ranges::lower_bound(index_, std::pair(number, Index{0}));
  return found != index_.end() && found->first == number ? found->second : -1;
}

Vector GatheredNodes::gather(const Vector& values, int per_node) const {
  Ranks::ForEach<double> sent(static_cast<std::size_t>(ranks_->size()));
  std::vector<double>& own = sent[std::size_t(root_)];
  for (const Index node : owned_)
    own.insert(own.end(), values.data() + node * per_node, values.data() + (node + 1) * per_node);
  const Ranks::ForEach<double> received = ranks_->exchange(std::move(sent));
  if (!is_root()) return {};
  Vector result = Vector::Zero(count() * per_node);
  for (std::size_t rank = 0; rank < received.size(); ++rank) {
    const double* from = received[rank].data();
    for (const Index index : owned_indices_[rank]) {
      std::copy_n(from, per_node, result.data() + index * per_node);
      from += per_node;
    }
  }
  return result;
}

void GatheredNodes::scatter(const Vector& at_root, int per_node, Vector& values) const {
  Ranks::ForEach<double> sent(static_cast<std::size_t>(ranks_->size()));
  for (std::size_t rank = 0; rank < indices_.size(); ++rank) {
    for (const Index index : indices_[rank])
      sent[rank].insert(sent[rank].end(), at_root.data() + index * per_node, at_root.data() + (index + 1) * per_node);
  }
  const Ranks::ForEach<double> received = ranks_->exchange(std::move(sent));
  const double* from = received[std::size_t(root_)].data();
  for (const Index node : nodes_) {
    std::copy_n(from, per_node, values.data() + node * per_node);
    from += per_node;
  }
}

}  // namespace ricochet
