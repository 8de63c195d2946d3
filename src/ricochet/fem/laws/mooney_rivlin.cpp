#include <fmt/format.h>

#include "ricochet/fem/finite_strain.hpp"

namespace ricochet {

namespace {

/// W = c₁₀(Ī₁ − 3) + c₀₁(Ī₂ − 3) + (K/4)(J² − 1 − 2 ln J), Ī₁ = J^(−2/3) I₁, Ī₂ = J^(−4/3) I₂ of C: rubber.
///
/// With c = (2/3) tr E and D the deviator of E, I₁ = 3(1+c), I₂ = 3(1+c)² − 2D:D and
/// J² = (1+c)³ − 2(1+c) D:D + 8 det D, so that all differences are of the second order in D:
///   Ī₁ − 3 = 3[(1+q)^(1/3) − 1],   Ī₂ − 3 = 3[(1+q)^(2/3) (1−p) − 1],
///   q = ((1+c)³ − J²)/J²,   p = ⅔ D:D/(1+c)².
class MooneyRivlin final : public MaterialLaw {
 public:
  MooneyRivlin(double first, double second, double bulk) : first_(first), second_(second), volume_{bulk} {}

  [[nodiscard]] double lambda() const override { return volume_.modulus - 2.0 / 3.0 * mu(); }
  [[nodiscard]] double mu() const override { return 2.0 * (first_ + second_); }
  [[nodiscard]] double volumetric_modulus() const override { return volume_.modulus; }

  [[nodiscard]] double energy(const Tensor& strain) const override {
    const Shape shape(strain);
    const double stretch = 1.0 + shape.mean, square = shape.deviator.squaredNorm();
    const double q = (2.0 * stretch * square - 8.0 * determinant(shape.deviator)) / (1.0 + shape.s);
    const double logarithm = std::log1p(q) / 3.0;
    const double of_second = std::log1p(-2.0 / 3.0 * square / (stretch * stretch));
    return 3.0 * (first_ * std::expm1(logarithm) + second_ * std::expm1(2.0 * logarithm + of_second)) +
           volume_.energy(shape.s);
  }

  void stress(const Tensor& strain, Tensor& result) const override {
    const Shape shape(strain);
    const double scale = std::cbrt(1.0 / (1.0 + shape.s));  // J^(−2/3)
    const Tensor& d = shape.deviator;
    // I − (I₁/3)C⁻¹ = 2D C⁻¹, and I₁I − C − ⅔I₂C⁻¹ = (2(1+c)D − 4(D² − ⅓ D:D I)) C⁻¹.
    Tensor along = (4.0 * first_ * scale + 4.0 * second_ * scale * scale * (1.0 + shape.mean)) * d;
    along -= 8.0 * second_ * scale * scale * (d * d - d.squaredNorm() / 3.0 * Tensor::Identity());
    result.noalias() = along * shape.inverse;
    result = 0.5 * (result + result.transpose()).eval() + volume_.stress_factor(shape.s) * shape.inverse;
  }

  void tangent(const Tensor& strain, StressTangent& result) const override {
    const Shape shape(strain);
    const double scale = std::cbrt(1.0 / (1.0 + shape.s));
    const Tensor identity = Tensor::Identity(), c = identity + 2.0 * strain;
    const double first_invariant = c.trace(),
                 second_invariant = 0.5 * (first_invariant * first_invariant - c.squaredNorm());
    const Tensor slope = first_invariant * identity - c;  // ∂I₂/∂C
    result.setZero();
    const double one = 4.0 * first_ * scale, two = 4.0 * second_ * scale * scale;
    add_dyad(identity, shape.inverse, -one / 3.0, result);
    add_dyad(shape.inverse, identity, -one / 3.0, result);
    add_dyad(slope, shape.inverse, -2.0 / 3.0 * two, result);
    add_dyad(shape.inverse, slope, -2.0 / 3.0 * two, result);
    add_dyad(shape.inverse, shape.inverse, one * first_invariant / 9.0 + two * 4.0 / 9.0 * second_invariant, result);
    add_symmetric_product(shape.inverse, one * first_invariant / 3.0 + two * 2.0 / 3.0 * second_invariant, result);
    add_dyad(identity, identity, two, result);
    add_symmetric_product(identity, -two, result);
    volume_.add_tangent(shape.s, shape.inverse, result);
  }

 private:
  struct Shape {
    explicit Shape(const Tensor& strain)
        : mean(2.0 / 3.0 * strain.trace()),
          deviator(strain - 0.5 * mean * Tensor::Identity()),
          inverse(inverse_metric(strain)),
          s(determinant_change(2.0 * strain)) {}
    double mean;
    Tensor deviator, inverse;  ///< D, C⁻¹
    double s;                  ///< J² − 1
  };

  double first_, second_;
  VolumetricEnergy volume_;
};

std::vector<Key> mooney_rivlin_keys() {
  return {{.name = "c10",
           .type = KeyType::number,
           .unit = "stress",
           .required = true,
           .doc = "Of the first invariant; c10 + c01 > 0."},
          {.name = "c01",
           .type = KeyType::number,
           .unit = "stress",
           .required = true,
           .doc = "Of the second invariant; the shear modulus at zero strain is 2 (c10 + c01)."},
          {.name = "bulk_modulus",
           .type = KeyType::number,
           .unit = "stress",
           .required = true,
           .range = positive,
           .doc = "Bulk modulus at zero strain."}};
}

void check_mooney_rivlin(const ParameterCheck& place, Parameters& values) {
  if (!place.is_usable("c10") || !place.is_usable("c01")) return;
  const double sum = values.number("c10") + values.number("c01");
  if (!(sum > 0.0)) place.add_problem("c01", fmt::format("c10 + c01 must be positive; it is {:g}", sum));
}

}  // namespace

MaterialLawRegistration mooney_rivlin_law() {
  const auto make = [](const Parameters& parameters) {
    return std::make_unique<MooneyRivlin>(parameters.number("c10"), parameters.number("c01"),
                                          parameters.number("bulk_modulus"));
  };
  return {"mooney-rivlin", make, mooney_rivlin_keys(), {}, check_mooney_rivlin};
}

}  // namespace ricochet
