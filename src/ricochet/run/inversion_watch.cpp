#include "ricochet/run/inversion_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ricochet/base/log.hpp"

namespace ricochet {

InversionWatch::InversionWatch(const Body& body, const Ranks& ranks) : body_(body) {
  if (has_finite_strain(body) && body.space->degree > 1 && !ranks.are_several()) volumes_.emplace(body);
}

void InversionWatch::watch(double time, const State& state) {
  if (!volumes_ || has_warned_) return;
  const VertexVolumes::Smallest found = volumes_->smallest(state.displacement);
  if (found.ratio > 0.0) return;
  has_warned_ = true;
  const CellLocation cell = location_of_cell(*body_.mesh, found.cell);
  log::warning(fmt::format(
      "at t = {:.6g} cell {} at ({:.6g}) is turned inside out at a vertex, where its volume is {:.3g} times "
      "that at rest, though not at its quadrature points: the mesh is too coarse for this deformation, and "
      "from here on strains and stresses of the cell, and forces of contact nearby, are wrong",
      time, cell.tag, fmt::join(cell.centre, ", "), found.ratio));
}

}  // namespace ricochet
