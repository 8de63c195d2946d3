#pragma once

#include "ricochet/base/ranks.hpp"
#include "ricochet/distributed/node_exchange.hpp"

/// @file Ranks of a run, implementing the interface of the library.
namespace ricochet {

/// Ranks without a body.
class WorldRanks : public Ranks {
 public:
  explicit WorldRanks(const Communicator& ranks) : ranks_(ranks) {}

  [[nodiscard]] int rank() const override { return ranks_.rank(); }
  [[nodiscard]] int size() const override { return ranks_.size(); }
  void reduce(std::span<double> values, std::span<const Reduction> by) const override;
  [[nodiscard]] ForEach<double> exchange(ForEach<double> to_each) const override {
    count(to_each);
    return ranks_.exchange(to_each);
  }
  [[nodiscard]] ForEach<std::int64_t> exchange(ForEach<std::int64_t> to_each) const override {
    count(to_each);
    return ranks_.exchange(to_each);
  }
  [[nodiscard]] bool all_arrive(double seconds) const override { return Processes::all_arrive(seconds); }
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

 private:
  template <class Number>
  void count(const ForEach<Number>& to_each) const {
    ++traffic_.reductions;
    for (std::size_t rank = 0; rank < to_each.size(); ++rank) {
      if (to_each[rank].empty() || int(rank) == ranks_.rank()) continue;
      ++traffic_.messages;
      traffic_.bytes += std::int64_t(sizeof(Number) * to_each[rank].size());
    }
  }

  Communicator ranks_;
  mutable Traffic traffic_;
};

class MpiRanks final : public WorldRanks {
 public:
  /// Keeps a reference to the exchange, whose nodes are those of the vectors of forces.
  MpiRanks(const Communicator& ranks, const NodeExchange& nodes) : WorldRanks(ranks), nodes_(nodes) {}

  void accumulate(Vector& force) const override { nodes_.accumulate(force); }
  void accumulate(Eigen::VectorXf& force) const override { nodes_.accumulate(force); }
  [[nodiscard]] Traffic traffic() const override { return WorldRanks::traffic() += nodes_.traffic(); }
  [[nodiscard]] bool is_owned(Index node) const override { return nodes_.is_owned(node); }
  [[nodiscard]] std::span<const Index> not_owned() const override { return nodes_.not_owned(); }
  [[nodiscard]] std::int64_t number_of(Index node) const override { return nodes_.numbers()[std::size_t(node)]; }

 private:
  const NodeExchange& nodes_;
};

}  // namespace ricochet
