#include "ricochet/run/distortion_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ricochet/base/log.hpp"
#include "ricochet/problem/distortion_force.hpp"

namespace ricochet {

void DistortionWatch::watch(double time, const State& state) {
  const DistortionForce* const distortion = problem_.internal_force->distortion();
  if (distortion == nullptr) return;
  const double energy = problem_.ranks->sum(distortion->distortion_energy(state.displacement));
  if (energy > 0.0 && largest_energy_ == 0.0) {
    const CellVolume smallest = distortion->smallest_nodal_volume(state.displacement);
    const CellLocation cell = location_of_cell(*body_.mesh, std::max<Index>(smallest.cell, 0));
    log::warning(fmt::format(
        "at t = {:.6g} the volume of cell {} at ({:.6g}) is {:.3g} times that at rest near one of its nodes: an "
        "artificial energy keeps the cell from being turned inside out there, and strains and stresses of this cell "
        "are not reliable (the total energy includes it; \"distortion_energy\" in summary.json is its largest value). "
        "Smaller cells where the body is folded or squeezed this strongly avoid it",
        time, cell.tag, fmt::join(cell.centre, ", "), smallest.volume_ratio));
  }
  largest_energy_ = std::max(largest_energy_, energy);
}

}  // namespace ricochet
