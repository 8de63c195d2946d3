#include <gtest/gtest.h>

#include <Eigen/SparseLU>
#include <array>
#include <cmath>
#include <functional>
#include <ranges>

#include "ricochet/problem/finite_elasticity.hpp"
#include "support/bent_body.hpp"

/// @file Tangent of the mean stress along the path of the strain, for all laws and cells: differences, and identities
/// that follow from the momenta and the work of the force.
namespace ricochet::test_support {
namespace {

struct PathCase {
  ElementKind element;
  std::string law;
  PlaneState plane = PlaneState::strain;
  double poisson = 0.3;
  bool mean_dilatation = false;
  bool has_branches = false;

  [[nodiscard]] std::string label() const {
    std::string result = element.label() + "_" + law + (mean_dilatation ? "_mean" : "") +
                         (has_branches ? "_branches" : "") + (plane == PlaneState::stress ? "_plane_stress" : "") +
                         (plane == PlaneState::axisymmetric ? "_axisymmetric" : "");
    std::ranges::replace(result, '-', '_');
    return result;
  }
};

std::vector<PathCase> path_cases() {
  std::vector<PathCase> all;
  for (const ElementKind& element : all_element_kinds()) {
    const bool is_plane = element.dimension() == 2;
    for (const std::string law : {"linear", "saint-venant-kirchhoff", "neo-hookean", "mooney-rivlin"}) {
      all.push_back({element, law});
      if (is_plane) all.push_back({element, law, PlaneState::stress});
      if (is_plane) all.push_back({element, law, PlaneState::axisymmetric});
    }
    for (const std::string law : {"neo-hookean", "mooney-rivlin"}) {
      all.push_back({element, law, PlaneState::strain, 0.49, true});
      if (is_plane) all.push_back({element, law, PlaneState::axisymmetric, 0.49, true});
    }
    all.push_back({element, "neo-hookean", PlaneState::strain, 0.49, true, true});
    if (is_plane) all.push_back({element, "neo-hookean", PlaneState::axisymmetric, 0.3, false, true});
  }
  return all;
}

Parameters path_law_parameters(const PathCase& of) {
  constexpr double mu = 0.8;
  const double lambda = 2.0 * mu * of.poisson / (1.0 - 2.0 * of.poisson);
  if (of.law == "mooney-rivlin") return {{"c10", 0.3}, {"c01", 0.1}, {"bulk_modulus", lambda + 2.0 / 3.0 * mu}};
  return {{"lambda", lambda}, {"mu", mu}};
}

constexpr auto all_path_rules = path_rule_table | std::views::transform(&PathRuleProperties::rule);
constexpr std::array path_variations{of_path_end, of_path_start, PathVariation{1.0, 0.0}, PathVariation{0.0, 1.0}};

/// Derivative at 0 of a vector-valued function: central differences with the steps h, 2h and 4h, extrapolated to an
/// error of order h⁶.
Vector derivative(const std::function<Vector(double)>& function, double h) {
  const auto central = [&](double step) { return Vector((function(step) - function(-step)) / (2.0 * step)); };
  const Vector one = central(h), two = central(2.0 * h), four = central(4.0 * h);
  return (64.0 * one - 20.0 * two + four) / 45.0;
}

/// Middle and increment of a path.
struct MeanPath {
  Vector middle, increment;
  [[nodiscard]] Vector start() const { return middle - 0.5 * increment; }
  [[nodiscard]] Vector end() const { return middle + 0.5 * increment; }
  [[nodiscard]] MeanPath moved(const PathVariation& by, const Vector& along, double size) const {
    return {middle + size * by.middle * along, increment + size * by.increment * along};
  }
};

class PathTangent : public testing::TestWithParam<PathCase> {
 protected:
  static constexpr double step = 0.7;

  void SetUp() override {
    body_ = make_bent_body(kind().element, kind().plane);
    Material& material = body_->body.materials[0];
    material.law = make_material_law(kind().law, path_law_parameters(kind()));
    material.mean_dilatation = kind().mean_dilatation;
    if (kind().has_branches) material.relaxation = {{0.5, 0.3}, {2.0, 4.0}};
    force_ = std::make_unique<FiniteElasticity>(body_->body, node_graph(body_->space));
    if (kind().has_branches) force_->relax(random(0.02, 1), internal_);
    path_ = {random(0.02, 2), random(0.03, 3)};
  }
  static const PathCase& kind() { return GetParam(); }
  static int dimension() { return kind().element.dimension(); }
  static bool is_linear() { return kind().law == "linear"; }
  /// Whether rigid motions are in the space and change no strain.
  static bool has_rotations() {
    return !is_linear() && kind().plane != PlaneState::axisymmetric && kind().element.contains_affine();
  }
  [[nodiscard]] Vector random(double size, unsigned seed) const { return random_displacement(*body_, size, seed); }
  [[nodiscard]] PathRules rules(PathRule rule) const { return PathRules(force_->path_rules().size(), rule); }

  [[nodiscard]] Vector force(const MeanPath& at, PathRule rule) const {
    Vector result;
    force_->path_force(at.middle, at.increment, rules(rule), result);
    const Vector start = at.start(), end = at.end();
    if (kind().has_branches) force_->add_mean_force({at.middle, at.increment, start, end, internal_, step}, result);
    return result;
  }
  [[nodiscard]] SparseMatrix tangent(const MeanPath& at, PathRule rule, const PathVariation& by) const {
    if (!kind().has_branches) return force_->path_tangent(at.middle, at.increment, rules(rule), by);
    const Vector start = at.start(), end = at.end();
    return force_->step_path_tangent({at.middle, at.increment, start, end, internal_, step}, rules(rule), by);
  }
  /// Multiplies the vectors at all nodes by a skew matrix.
  [[nodiscard]] Vector spun(const Vector& vectors) const {
    const int d = dimension();
    Matrix spin(3, 3);
    spin << 0.0, -0.7, 0.4, 0.7, 0.0, -0.3, -0.4, 0.3, 0.0;
    return Vector((spin.topLeftCorner(d, d) * vectors.reshaped(d, body_->space.node_count())).reshaped());
  }
  [[nodiscard]] Vector position(const Vector& displacement) const {
    return Vector(body_->space.nodes.reshaped()) + displacement;
  }

  std::unique_ptr<MeshedBody> body_;
  std::unique_ptr<FiniteElasticity> force_;
  Vector internal_;
  MeanPath path_;
};

TEST_P(PathTangent, IsTheDerivativeOfThePathForce) {
  const Vector along = random(1.0, 4);
  for (const PathRule rule : all_path_rules) {
    for (const PathVariation& by : path_variations) {
      const Vector found = tangent(path_, rule, by) * along;
      const Vector wanted = derivative([&](double size) { return force(path_.moved(by, along, size), rule); }, 5e-4);
      EXPECT_LE((found - wanted).norm(), 1e-9 * (wanted.norm() + force(path_, rule).norm()))
          << int(rule) << " " << by.middle << " " << by.increment;
    }
  }
}

/// Without an increment the path is a point: D(x, Δ̂) = f(x) up to terms of the second order in Δ̂.
TEST_P(PathTangent, IsTheTangentIfThereIsNoIncrement) {
  const MeanPath still{path_.middle, Vector::Zero(path_.middle.size())};
  if (kind().has_branches) force_->relax(still.middle, internal_);
  // That of the branches over a step is for a given strain at its start, so that the strain of the end moves by 2ψ.
  const SparseMatrix wanted =
      kind().has_branches ? force_->step_tangent(still.middle, step) : force_->tangent(still.middle);
  for (const PathRule rule : all_path_rules)
    EXPECT_LT((tangent(still, rule, {1.0, 2.0}) - wanted).norm(), 1e-14 * wanted.norm());
}

/// A body without stress that has turned rigidly, and turns further.
TEST_P(PathTangent, ASpinFromAStateWithoutStressHasNoForce) {
  if (!has_rotations()) return;
  const Vector rest = Vector::Zero(path_.middle.size()), end = turned(*body_, rest, some_rotation(dimension()));
  if (kind().has_branches) force_->relax(rest, internal_);
  const Vector spin = spun(position(end));
  for (const PathRule rule : all_path_rules) {
    const SparseMatrix matrix = tangent({0.5 * end, end}, rule, of_path_end);
    EXPECT_LT((matrix * spin).norm(), 1e-13 * matrix.norm() * spin.norm());
  }
}

/// D turns with the path, as the strains do not change.
TEST_P(PathTangent, TurnsTheForceWithThePath) {
  if (!has_rotations()) return;
  const Vector of_middle = spun(position(path_.middle)), of_increment = spun(path_.increment);
  for (const PathRule rule : all_path_rules) {
    const SparseMatrix by_middle = tangent(path_, rule, {1.0, 0.0}), by_increment = tangent(path_, rule, {0.0, 1.0});
    const Vector found = by_middle * of_middle + by_increment * of_increment, wanted = spun(force(path_, rule));
    EXPECT_LT((found - wanted).norm(), 1e-13 * by_middle.norm() * of_middle.norm());
  }
}

/// D has neither resultant nor moment about x, whatever the path is.
TEST_P(PathTangent, HasNeitherResultantNorMoment) {
  if (!has_rotations()) return;
  const Vector translation = interpolate(body_->space, [](const Vector& x) { return Vector(Vector::Ones(x.size())); });
  const Vector rotation = spun(position(path_.middle));
  for (const PathRule rule : all_path_rules) {
    for (const PathVariation& by : path_variations) {
      const SparseMatrix matrix = tangent(path_, rule, by);
      const double size = matrix.norm() * rotation.norm();
      EXPECT_LT((matrix.transpose() * translation).norm(), 1e-13 * size);
      EXPECT_LT((matrix * translation).norm(), 1e-13 * size);
      EXPECT_LT((matrix.transpose() * rotation - by.middle * spun(force(path_, rule))).norm(), 1e-13 * size);
    }
  }
}

/// If D·Δ̂ = W(u₁) − W(u⁺), the derivatives agree as well: Kᵀ Δ̂ + b D = (a + ½ b) f(u₁) − (a − ½ b) f(u⁺).
TEST_P(PathTangent, KeepsTheWorkOfThePath) {
  if (kind().has_branches) return;
  const bool is_quadratic = is_linear() || kind().law == "saint-venant-kirchhoff";
  Vector at_start, at_end;
  force_->evaluate(path_.start(), at_start);
  force_->evaluate(path_.end(), at_end);
  for (const PathRule rule : all_path_rules) {
    if (!is_exact(rule) && !is_quadratic) continue;
    for (const auto& by : path_variations) {
      const SparseMatrix matrix = tangent(path_, rule, by);
      const Vector found = matrix.transpose() * path_.increment + by.increment * force(path_, rule);
      const Vector wanted = (by.middle + 0.5 * by.increment) * at_end - (by.middle - 0.5 * by.increment) * at_start;
      EXPECT_LT((found - wanted).norm(), 1e-12 * (matrix.norm() * path_.increment.norm() + at_end.norm())) << int(rule);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, PathTangent, testing::ValuesIn(path_cases()),
                         [](const auto& info) { return info.param.label(); });

std::unique_ptr<MeshedBody> rubber_block(int boxes) {
  auto body = make_meshed_body(make_box_mesh(box_of(CellShape::quadrilateral, {boxes, boxes})), 1);
  body->body.materials[0].law = make_material_law("neo-hookean", {{"lambda", 39.2}, {"mu", 0.8}});
  body->body.materials[0].mean_dilatation = true;
  return body;
}

TEST(PathTangentOfTiedNodes, IsTheDerivativeOfThePathForce) {
  const auto body = rubber_block(3);
  const TiedNodes ties({{5, {{4, 0.3}, {6, 0.7}}}, {9, {{5, 0.5}, {10, 0.5}}}}, body->space.node_count());
  body->body.tied = &ties;
  const FiniteElasticity elastic(body->body, node_graph(body->space));
  const MeanPath path{random_displacement(*body, 0.01, 1), random_displacement(*body, 0.02, 2)};
  const Vector along = random_displacement(*body, 1.0, 3);
  const PathRules rules(elastic.path_rules().size(), PathRule::five_points_exact);
  const auto force = [&](double size) {
    const MeanPath at = path.moved(of_path_end, along, size);
    Vector result;
    elastic.path_force(at.middle, at.increment, rules, result);
    return result;
  };
  const Vector wanted = derivative(force, 5e-4);
  const SparseMatrix found = elastic.path_tangent(path.middle, path.increment, rules, of_path_end);
  EXPECT_LT((found * along - wanted).norm(), 1e-9 * wanted.norm());
}

/// Free flight of a block over one step, M (2/h²)(u₁ − u₀ − h v₀) + D = 0 with u⁺ = u₀.
class BlockInFlight {
 public:
  BlockInFlight()
      : start_(random_displacement(*body_, 0.01, 1)),
        drift_(step_ * random_displacement(*body_, 2.0, 2)),
        rules_(elastic_.path_rules().size(), PathRule::five_points_exact) {}

  /// Returns the sizes of the corrections of Newton's method with the exact tangent, or with half the tangent at x.
  [[nodiscard]] std::vector<double> corrections(bool is_exact) const {
    const SparseMatrix inertia = (2.0 / (step_ * step_)) * mass_;
    Vector end = start_ + drift_, force;
    std::vector<double> sizes;
    do {
      const Vector middle = 0.5 * (start_ + end), increment = end - start_;
      elastic_.path_force(middle, increment, rules_, force);
      force += inertia * (increment - drift_);
      const SparseMatrix tangent = is_exact ? elastic_.path_tangent(middle, increment, rules_, of_path_end)
                                            : SparseMatrix(0.5 * elastic_.tangent(middle));
      const Eigen::SparseLU<SparseMatrix> factor(inertia + tangent);
      const Vector correction = factor.solve(force);
      end -= correction;
      sizes.push_back(correction.norm());
    } while (sizes.back() > 1e-13 * end.norm() && sizes.size() < 30);
    return sizes;
  }

 private:
  std::unique_ptr<MeshedBody> body_ = rubber_block(4);
  FiniteElasticity elastic_{body_->body, node_graph(body_->space)};
  SparseMatrix mass_ = expand_to_components(assemble_scalar_mass(body_->body, node_graph(body_->space)), 2);
  double step_ = 0.05;
  Vector start_, drift_;
  PathRules rules_;
};

TEST(PathTangentOfAFreeStep, NewtonsMethodConvergesQuadratically) {
  const BlockInFlight block;
  const std::vector<double> sizes = block.corrections(true);
  ASSERT_GE(sizes.size(), 4U);
  const double* const last = &sizes.back();  // The last correction is at the level of rounding, or near it.
  EXPECT_GT(std::log(last[-1] / last[-2]) / std::log(last[-2] / last[-3]), 1.8);
  EXPECT_LE(sizes.size(), 6U);
  EXPECT_GE(block.corrections(false).size(), 2 * sizes.size());
}

}  // namespace
}  // namespace ricochet::test_support
