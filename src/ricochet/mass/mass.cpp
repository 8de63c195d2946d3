#include "ricochet/mass/mass.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"

namespace ricochet {

// The masses, each by the registration function of its own file. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_MASSES(mass)   \
  mass(consistent_mass)         \
  mass(lumped_mass)             \
  mass(equivalent_mass)         \
  mass(nodewise_equivalent_mass) \
  mass(cellwise_equivalent_mass) \
  mass(compact_equivalent_mass) \
  mass(nearest_equivalent_mass) \
  mass(lumped_equivalent_mass)
// clang-format on

RICOCHET_DEFINE_REGISTRY(mass_registry, MassType, "mass", RICOCHET_MASSES)

SparseMatrix build_mass(const std::string& name, const MassInput& input, Parameters values) {
  return mass_registry().find(name, values).type.build(input, values);
}

MassRegistration consistent_mass() {
  return {"consistent", {.build = [](const MassInput& input, const Parameters&) { return *input.consistent; }}};
}

std::vector<char> MassInput::marked_contact_nodes() const {
  std::vector<char> marks(static_cast<std::size_t>(consistent->cols()), 0);
  for (const Index node : contact_nodes) marks[std::size_t(node)] = 1;
  return marks;
}

void MassInput::require_cells(const std::string& name) const {
  if (cells != nullptr) return;
  throw Error(ErrorKind::invalid_input, fmt::format("mass type \"{}\" needs the mass matrices of single cells", name));
}

MassChoice mass_to_build(const std::string& requested, const Parameters& parameters, const MassInput& input) {
  Parameters values = parameters;
  const MassType& type = mass_registry().find(requested, values).type;
  return type.choose != nullptr ? type.choose(input) : MassChoice{requested, {}, {}, parameters};
}

bool is_positive_definite(const SparseMatrix& mass, const std::vector<Index>& excluded_nodes) {
  std::vector<int> number(static_cast<std::size_t>(mass.cols()), 0);
  for (const Index node : excluded_nodes) number[std::size_t(node)] = -1;
  int count = 0;
  for (int& n : number) n = n < 0 ? -1 : count++;
  SparseMatrix block = extract(mass, number, count, number, count);
  // With a diagonal scaling, "positive to rounding" is independent of units and of the grading of the mesh.
  const Vector diagonal = block.diagonal();
  if (count > 0 && !(diagonal.minCoeff() > 0.0)) return false;
  const Vector scale = diagonal.cwiseSqrt().cwiseInverse();
  block = scale.asDiagonal() * block * scale.asDiagonal();
  return SparseCholesky(block).positive_definite();
}

}  // namespace ricochet
