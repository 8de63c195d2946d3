#include "ricochet/fem/distortion_control.hpp"

#include "ricochet/fem/distortion_law.hpp"

namespace ricochet {

namespace {

/// Body whose materials are laws of distortion. The volume ratio of a thin plate is that of areas.
Body with_distortion_laws(Body body) {
  for (Material& material : body.materials) {
    material.law = make_distortion_law(material.mu());
    material.mean_dilatation = false;
    material.relaxation.clear();
  }
  if (body.plane == PlaneState::stress) body.plane = PlaneState::strain;
  return body;
}

}  // namespace

DistortionControl::DistortionControl(const Body& body, const NodeGraph& graph, const std::vector<int>& cells)
    : body_(with_distortion_laws(body)),
      cells_(std::make_unique<ElasticCells>(body_, &graph, cells, CellPoints::nodes)),
      rules_(std::size_t(body.mesh->cell_count()), path_rule_table.back().rule) {}

bool DistortionControl::applies_to(const Body& body) {
  const auto may_invert = [&](const CellBlock& cells) {
    return body.space->degree > 1 || body.mesh->degree > 1 || !is_simplex(cells.shape);
  };
  return has_finite_strain(body) && std::ranges::any_of(body.mesh->cells, may_invert);
}

CellVolume DistortionControl::add_force(const Vector& displacement, Vector& result) const {
  const CellVolume worst = cells_->force(displacement, force_);
  result += force_;
  return worst;
}

CellVolume DistortionControl::add_path_force(const Vector& middle, const Vector& increment, Vector& result) const {
  const CellVolume worst = cells_->path_force(middle, increment, rules_, force_);
  result += force_;
  return worst;
}

void DistortionControl::add_path_tangent(const Vector& middle, const Vector& increment, const PathVariation& variation,
                                         SparseMatrix& result) const {
  result += cells_->path_tangent(middle, increment, rules_, variation);
}

void DistortionControl::add_tangent(const Vector& displacement, SparseMatrix& result) const {
  result += cells_->tangent(displacement, 0.0);
}

}  // namespace ricochet
