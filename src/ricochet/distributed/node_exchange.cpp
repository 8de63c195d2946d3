#include "ricochet/distributed/node_exchange.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <unordered_map>

namespace ricochet {

namespace {

/// Returns, per rank in ascending order, the nodes that it shares with this one. Each rank collects the sharers of a
/// range of numbers and replies to queries for it.
std::map<int, std::vector<std::int64_t>> find_sharers(const Communicator& ranks,
                                                      const std::vector<std::int64_t>& numbers, std::int64_t count) {
  const auto size = std::size_t(ranks.size());
  const std::int64_t range = std::max<std::int64_t>(1, (count + ranks.size() - 1) / ranks.size());
  std::vector<std::vector<std::int64_t>> requests(size);
  for (const std::int64_t number : numbers) requests.at(std::size_t(number / range)).push_back(number);
  const std::vector<std::vector<std::int64_t>> received = ranks.exchange(requests);
  std::unordered_map<std::int64_t, std::vector<int>> sharers;
  for (std::size_t rank = 0; rank < size; ++rank) {
    for (const std::int64_t number : received[rank]) sharers[number].push_back(int(rank));
  }
  // Replies to each rank: pairs of a number and another rank that has it.
  std::vector<std::vector<std::int64_t>> replies(size);
  for (std::size_t rank = 0; rank < size; ++rank) {
    for (const std::int64_t number : received[rank]) {
      for (const int other : sharers.at(number)) {
        if (other == int(rank)) continue;
        replies[rank].push_back(number);
        replies[rank].push_back(other);
      }
    }
  }
  std::map<int, std::vector<std::int64_t>> result;
  for (const std::vector<std::int64_t>& reply : ranks.exchange(replies)) {
    for (std::size_t i = 0; i < reply.size(); i += 2) result[int(reply[i + 1])].push_back(reply[i]);
  }
  for (auto& [rank, shared] : result) std::ranges::sort(shared);
  return result;
}

}  // namespace

NodeExchange::NodeExchange(const Communicator& ranks, const std::vector<std::int64_t>& numbers, std::int64_t count)
    : ranks_(ranks), numbers_(numbers), nodes_(Index(numbers.size())) {
  std::unordered_map<std::int64_t, Index> node_of;
  for (std::size_t node = 0; node < numbers.size(); ++node) node_of.emplace(numbers[node], Index(node));
  if (node_of.size() != numbers.size()) throw std::logic_error("a rank has a node twice");
  std::vector<int> owner(numbers.size(), ranks.rank());
  for (const auto& [rank, shared] : find_sharers(ranks, numbers, count)) {
    Neighbour& neighbour = neighbours_.emplace_back();
    messages_.push_back({.rank = rank, .out = {}, .in = {}});
    for (const std::int64_t number : shared) {
      const Index node = node_of.at(number);
      neighbour.nodes.push_back(node);
      shared_.push_back(node);
      int& first = owner[std::size_t(node)];
      first = std::min(first, rank);
    }
  }
  std::ranges::sort(shared_);
  shared_.erase(std::unique(shared_.begin(), shared_.end()), shared_.end());
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    for (const Index node : neighbours_[i].nodes)
      neighbours_[i].owned_by_neighbour.push_back(owner[std::size_t(node)] == messages_[i].rank ? 1 : 0);
  }
  for (std::size_t node = 0; node < owner.size(); ++node) {
    if (owner[node] != ranks.rank()) not_owned_.push_back(Index(node));
  }
}

/// Fills the messages with the values at shared nodes, and exchanges them with the neighbours.
template <class Values>
void NodeExchange::send_all(const Values& values, Index per_node) const {
  if (values.size() != per_node * nodes_) throw std::logic_error("the number of values does not match the nodes");
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    Message& message = messages_[i];
    const std::size_t count = neighbours_[i].nodes.size() * std::size_t(per_node);
    message.in.resize(count);
    message.out.resize(count);
    auto to = message.out.begin();
    for (const Index node : neighbours_[i].nodes) to = std::copy_n(values.data() + node * per_node, per_node, to);
    ++traffic_.messages;
    traffic_.bytes += std::int64_t(count * sizeof(double));
  }
  ranks_.swap(messages_);
}

template <class Values>
void NodeExchange::accumulate_any(Values& values) const {
  using Number = typename Values::Scalar;
  if (neighbours_.empty()) return;
  const Index per_node = values.size() / std::max<Index>(1, nodes_);
  send_all(values, per_node);
  own_.resize(shared_.size() * std::size_t(per_node));
  auto target = own_.begin();
  for (const Index node : shared_) {
    target = std::copy_n(values.data() + node * per_node, per_node, target);
    values.segment(node * per_node, per_node).setZero();
  }
  const auto add_own = [&] {
    const double* from = own_.data();
    for (const Index node : shared_) {
      for (Index k = 0; k < per_node; ++k) values[node * per_node + k] += static_cast<Number>(*from++);
    }
  };
  bool is_added = false;
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    if (!is_added && messages_[i].rank > ranks_.rank()) {
      add_own();
      is_added = true;
    }
    const double* from = messages_[i].in.data();
    for (const Index node : neighbours_[i].nodes) {
      for (Index k = 0; k < per_node; ++k) values[node * per_node + k] += static_cast<Number>(*from++);
    }
  }
  if (!is_added) add_own();
}

template void NodeExchange::accumulate_any(Vector& values) const;
template void NodeExchange::accumulate_any(Eigen::VectorXf& values) const;

void NodeExchange::copy_from_owners(Vector& values) const {
  if (neighbours_.empty()) return;
  const Index per_node = values.size() / std::max<Index>(1, nodes_);
  send_all(values, per_node);
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    const Neighbour& neighbour = neighbours_[i];
    for (std::size_t k = 0; k < neighbour.nodes.size(); ++k) {
      if (neighbour.owned_by_neighbour[k] == 0) continue;
      std::copy_n(messages_[i].in.data() + k * std::size_t(per_node), per_node,
                  values.data() + neighbour.nodes[k] * per_node);
    }
  }
}

}  // namespace ricochet
