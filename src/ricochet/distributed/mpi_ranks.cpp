#include "ricochet/distributed/mpi_ranks.hpp"

namespace ricochet {

/// Numbers of all ranks come to each, which takes them in the order of the ranks: the same bits everywhere, whatever
/// way messages went. A NaN of any rank is one of all.
void WorldRanks::reduce(std::span<double> values, std::span<const Reduction> by) const {
  if (ranks_.size() == 1) return;
  ++traffic_.reductions;
  const std::vector<double> all = ranks_.gather(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    double result = all[i];
    for (std::size_t rank = 1; rank < static_cast<std::size_t>(ranks_.size()); ++rank) {
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
