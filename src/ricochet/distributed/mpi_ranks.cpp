#include "ricochet/distributed/mpi_ranks.hpp"

namespace ricochet {

/// Gathers the values of all ranks on each, which reduces them in the order of the ranks: the result has the same bits
/// everywhere, independent of the order of messages. A NaN on any rank makes the result NaN.
void WorldRanks::reduce(std::span<double> values, std::span<const Reduction> by) const {
  if (ranks_.size() == 1) return;
  ++traffic_.reductions;
  const std::vector<double> all = ranks_.gather(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    double result = all[i];
    for (std::size_t rank = 1; rank < std::size_t(ranks_.size()); ++rank) {
      const double value = all[rank * values.size() + i];
      switch (by[i]) {
        case Reduction::sum:
          result += value;
          break;
        case Reduction::minimum:
          result = value < result || value != value ? value : result;
          break;
        case Reduction::maximum:
          result = value > result || value != value ? value : result;
          break;
        case Reduction::same:
          break;
      }
    }
    values[i] = result;
  }
}

}  // namespace ricochet
