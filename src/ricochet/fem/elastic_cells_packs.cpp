#include "ricochet/fem/strip_visits.hpp"

/// @file Forces and energies of all cells, pack by pack.
namespace ricochet {

CellVolume ElasticCells::force(const Vector& displacement, Vector& result) const {
  return visit_strips<StripWork>({{displacement, &PackNumbers::displacement}}, {{&PackNumbers::force, result}},
                                 [](auto& strips, const auto& strip, const PackPart& part) {
                                   strips.find_strains(strip, part.at(&PackNumbers::displacement), part.worst);
                                   strips.add_forces(strip, part.at(&PackNumbers::force));
                                 });
}

CellVolume ElasticCells::smallest_volume(const Vector& displacement) const {
  return visit_strips<StripWork>({{displacement, &PackNumbers::displacement}}, {},
                                 [](auto& strips, const auto& strip, const PackPart& part) {
                                   strips.find_smallest(strip, part.at(&PackNumbers::displacement), part.worst);
                                 });
}

/// Infinite if a cell is inverted, which cannot be recognized from its strain.
double ElasticCells::energy(const Vector& displacement) const {
  std::array<double, most_node_parts> sums{};
  visit_strips<StripWork>({{displacement, &PackNumbers::displacement}}, {},
                          [&](auto& strips, const auto& strip, const PackPart& part) {
                            CellVolume inverted;
                            strips.find_strains(strip, part.at(&PackNumbers::displacement), inverted);
                            sums[std::size_t(part.part)] +=
                                inverted.cell >= 0 ? std::numeric_limits<double>::infinity() : strips.energy(strip);
                          });
  double total = 0.0;
  for (const double sum : sums) total += sum;
  return total;
}

}  // namespace ricochet
