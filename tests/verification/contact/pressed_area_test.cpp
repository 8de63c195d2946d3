#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/fem/facet_integration.hpp"
#include "support/box_mesh.hpp"

/// @file Areas in contact: whole faces to rounding, and Hertz' contacts of a cylinder and of a ball, with prescribed
/// pressures and gaps at the nodes, to a part of a facet.
namespace ricochet::test_support::pressed_area_test {

/// A face of a body at a plane, with prescribed numbers at its nodes.
class Face {
 public:
  Face(
      const BoxMesh& box, int degree, const std::string& multipliers, PlaneState plane = PlaneState::strain,
      const FreeComponent& is_free = [](Index, int) { return true; })
      : body_(make_meshed_body(make_box_mesh(box), degree, plane)) {
    const int d = body_->mesh.dimension;
    obstacle_ = make_plane(Vector::Zero(d), Vector::Unit(d, d - 1));
    const std::string side = d == 2 ? "y0" : "z0";
    facets_ = body_->mesh.group(side, d - 1).members;
    const std::vector<ContactPair> pairs{{side, facets_, "plane", obstacle_.get(), {}, multipliers}};
    boundary_ = make_contact_boundary(body_->body, pairs, is_free);
    reaction_.setZero(boundary_.size());
    gap_.setZero(Index(boundary_.nodes.size()));
    pressure_.setZero(gap_.size());
    displacement_.setZero(body_->space.dof_count());
  }

  /// Sets `pressure` and `gap` at a position, of which one is zero.
  template <class Pressure, class Gap>
  void set(const Pressure& pressure, const Gap& gap) {
    for (std::size_t entry = 0; entry < boundary_.nodes.size(); ++entry) {
      const Vector x = body_->space.nodes.col(boundary_.nodes[entry]);
      pressure_[Index(entry)] = pressure(x);
      gap_[Index(entry)] = gap(x);
      if (boundary_.own_point[entry] >= 0) reaction_[boundary_.own_point[entry]] = pressure(x);
    }
  }
  void press_everywhere() {
    reaction_.setOnes();
    boundary_.recover_pressure(reaction_, pressure_);
    pressure_.array() += 1.0;
  }

  [[nodiscard]] double area() const {
    ContactSurface::Work work;
    const ContactSurface::Area found = boundary_.surface->pressed_area(
        0, {boundary_, *boundary_.rows, reaction_, gap_, pressure_, displacement_, one_rank()}, work);
    EXPECT_EQ(found.now, found.nominal);  // the law is linear
    return found.now;
  }
  [[nodiscard]] double whole() const {
    const FacetIntegration integration(body_->body);
    FacetQuadrature facet;
    double sum = 0.0;
    for (const Index number : facets_) {
      integration.evaluate(number, facet);
      sum += facet.measure.sum();
    }
    return sum;
  }
  /// E/(1 − ν²).
  [[nodiscard]] double modulus() const {
    const Material& material = body_->body.materials.front();
    return material.young() / (1.0 - material.poisson() * material.poisson());
  }

 private:
  std::unique_ptr<MeshedBody> body_;
  std::unique_ptr<Obstacle> obstacle_;
  std::vector<Index> facets_;
  ContactBoundary boundary_;
  Vector reaction_, gap_, pressure_, displacement_;
};

/// An entirely pressed face has its whole area, in all spaces, also with nodes held by supports.
TEST(PressedArea, OfAWholeFace) {
  for (const ElementKind& kind : all_element_kinds()) {
    for (const std::string multipliers : {"nodal", "p0", "p1", "dual"}) {
      for (const bool holds : {false, true}) {
        const int d = kind.dimension();
        BoxMesh box = box_of(kind.shape, std::vector<int>(std::size_t(d), 3));
        box.geometry_degree = kind.geometry_degree;
        if (kind.geometry_degree == 2) box.map = swirl_map(0.05);
        const FreeComponent is_free = [&](Index node, int component) {
          return !holds || component != d - 1 || node % 5 != 0;
        };
        Face face(box, kind.displacement_degree, multipliers, PlaneState::strain, is_free);
        face.press_everywhere();
        EXPECT_NEAR(face.area(), face.whole(), 1e-13) << kind.label() << multipliers << holds;
      }
    }
  }
}

TEST(PressedArea, OfARing) {
  BoxMesh box = box_of(CellShape::triangle, {4, 3});
  box.map = [](const Vector& x) -> Vector { return Eigen::Vector2d(0.5 + x[0], x[1]); };
  Face face(box, 2, "nodal", PlaneState::axisymmetric);
  EXPECT_EQ(face.area(), 0.0);
  face.press_everywhere();
  EXPECT_NEAR(face.area(), std::numbers::pi * (1.5 * 1.5 - 0.5 * 0.5), 1e-13);
}

/// The face's side is 2, the contact's half-width or radius a. The error of `measure` is a part of a facet all round
/// the border, while a sum of nodal areas errs by up to half a facet.
void expect_hertz(const ElementKind& kind, double a) {
  const int d = kind.dimension();
  const double exact = d == 2 ? 2.0 * a : std::numbers::pi * a * a, border = d == 2 ? 2.0 : 2.0 * std::numbers::pi * a;
  for (const int count : {8, 16, 32}) {
    std::vector<int> counts(static_cast<std::size_t>(d), count);
    counts.back() = 1;
    BoxMesh box = box_of(kind.shape, counts);
    box.distortion = 0.1;
    box.map = [d](const Vector& x) {
      Vector result = 2.0 * x.array() - 1.0;
      result[d - 1] = x[d - 1];
      return result;
    };
    Face face(box, kind.displacement_degree, "nodal");
    const double modulus = face.modulus(), radius = 10.0;
    const auto distance = [d](const Vector& x) { return x.head(d - 1).norm(); };
    face.set(
        [&](const Vector& x) {
          const double root = std::sqrt(std::max(a * a - std::pow(distance(x), 2), 0.0));
          return (d == 2 ? 0.5 : 2.0 / std::numbers::pi) * modulus / radius * root;
        },
        [&](const Vector& x) {
          const double r = distance(x);
          if (r <= a) return 0.0;
          const double root = std::sqrt(r * r - a * a);
          if (d == 2) return 0.5 / radius * (r * root - a * a * std::log((r + root) / a));
          const double moved = ((2.0 * a * a - r * r) * std::asin(a / r) + a * root) / std::numbers::pi;
          return (0.5 * r * r - a * a + moved) / radius;
        });
    const double edge = 2.0 / count / kind.displacement_degree;
    EXPECT_NEAR(face.area(), exact, 0.1 * edge * border) << kind.label() << ' ' << count << ' ' << a;
  }
}

TEST(PressedArea, OfHertzContactsConverges) {
  for (const ElementKind& kind : all_element_kinds()) {
    if (kind.geometry_degree != 1) continue;
    for (const double a : {0.41, 0.5, 0.63}) expect_hertz(kind, a);
  }
}

}  // namespace ricochet::test_support::pressed_area_test
