#include "ricochet/simulation/history/sensor.hpp"

#include <array>

namespace ricochet {

void add_vector_columns(Columns& columns, const std::string& name, int dimension, Reduction by) {
  constexpr std::array<const char*, 3> axis_suffix{"_x", "_y", "_z"};
  for (int k = 0; k < dimension; ++k) columns.emplace_back(name + axis_suffix[static_cast<std::size_t>(k)], by);
}

std::vector<std::string> names_of(const Columns& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::vector<Reduction> reductions_of(const Columns& columns) {
  std::vector<Reduction> result;
  for (const Column& column : columns) result.push_back(column.by);
  return result;
}

namespace {

bool carries(const Vector& normal, const Vector& tangential, Index point) {
  if (normal[point] != 0.0) return true;
  if (tangential.size() == 0) return false;
  const Index tangents = tangential.size() / normal.size();
  return !tangential.segment(point * tangents, tangents).isZero(0.0);
}

}  // namespace

bool carries_force(const StepForces& forces, Index point) {
  return carries(forces.normal_reaction, forces.tangential_reaction, point);
}

bool carries_acting_force(const StepForces& forces, Index point) {
  return carries(forces.acting_normal(), forces.acting_tangential(), point);
}

}  // namespace ricochet
