#include <fmt/format.h>

#include "ricochet/fem/packed_law.hpp"

namespace ricochet {

namespace {

/// W = c₁₀(Ī₁ − 3) + c₀₁(Ī₂ − 3) + (K/4)(J² − 1 − 2 ln J), Ī₁ = J^(−2/3) I₁, Ī₂ = J^(−4/3) I₂ of C: a law for rubber.
///
/// With c = (2/3) tr E and D the deviator of E, I₁ = 3(1+c), I₂ = 3(1+c)² − 2D:D and
/// J² = (1+c)³ − 2(1+c) D:D + 8 det D, so that all differences are of second order in D:
///   Ī₁ − 3 = 3(y − 1) = 3q/(1 + y + y²),   Ī₂ − 3 = 3[y²(1 − p) − 1] = 3[(y−1)(y+1) − p y²],   y = (1+q)^(1/3),
///   q = ((1+c)³ − J²)/J²,   p = ⅔ D:D/(1+c)².
class MooneyRivlin final : public PackedLaw<MooneyRivlin> {
 public:
  MooneyRivlin(double first, double second, double bulk) : first_(first), second_(second), volume_{bulk} {}

  [[nodiscard]] double lambda() const override { return volume_.modulus - 2.0 / 3.0 * mu(); }
  [[nodiscard]] double mu() const override { return 2.0 * (first_ + second_); }
  [[nodiscard]] double volumetric_modulus() const override { return volume_.modulus; }

  template <class T>
  RICOCHET_PART_OF_CALLER typename T::Number density(const T& strain) const {
    using Number = typename T::Number;
    const Distortion<T> of(strain);
    const Number& s = of.volume_change;
    const Number q = (2.0 * of.stretch * of.square - 8.0 * of.third) / (1.0 + s);
    const Number y = 1.0 / inverse_cube_root(q);
    const Number less = q / (1.0 + y + y * y);  // y − 1
    const Number p = 2.0 / 3.0 * of.square / (of.stretch * of.stretch);
    return 3.0 * (first_ * less + second_ * (less * (1.0 + y) - p * (y * y))) +
           0.25 * volume_.modulus * logarithm_rest(s);
  }

  // With m = 1 + c, C = mI + 2D, S is ½K s C⁻¹ plus
  //   [4 c₁₀ J^(−2/3) + 4 c₀₁ J^(−4/3) m] D C⁻¹ − 8 c₀₁ J^(−4/3) (D² − ⅓ D:D I) C⁻¹:
  // I − (I₁/3) C⁻¹ = 2D C⁻¹ and I₁I − C − ⅔I₂C⁻¹ = (2mD − 4(D² − ⅓ D:D I)) C⁻¹. By the Cayley–Hamilton theorem, with X
  // = adj D, D² = X + ½ D:D I, D X = det D I and X² = det D D − ½ D:D X, all terms are combinations of D, X and I:
  //   J² C⁻¹ = m² I − 2m D + 4X,   J² D C⁻¹ = m² D − 2m X + (4 det D − m D:D) I,
  //   J² (D² − ⅓ D:D I) C⁻¹ = (4 det D − ⅓ m D:D) D + (m² − (4/3) D:D) X + (m² D:D/6 − 2m det D) I.
  template <class T>
  RICOCHET_PART_OF_CALLER T stress_at(const T& strain) const {
    using Number = typename T::Number;
    const Distortion<T> of(strain);
    const Number &s = of.volume_change, &m = of.stretch, &square = of.square, &third = of.third;
    const Number scale = inverse_cube_root(s), inverse = 1.0 / (1.0 + s);  // J^(−2/3), J^(−2)
    const Number two = 4.0 * second_ * scale * scale * inverse;
    const Number one = 4.0 * first_ * scale * inverse + two * m;
    const Number pressure = 0.5 * volume_.modulus * s * inverse;
    const Number of_deviator = m * m * one - 2.0 * two * (4.0 * third - m * square * (1.0 / 3.0)) - 2.0 * m * pressure;
    const Number of_adjugate = -2.0 * m * one - 2.0 * two * (m * m - 4.0 / 3.0 * square) + 4.0 * pressure;
    const Number of_identity =
        (4.0 * third - m * square) * one - 2.0 * two * m * (m * square * (1.0 / 6.0) - 2.0 * third) + m * m * pressure;
    return combination(of_deviator, of.deviator, of_adjugate, of.adjugate, of_identity);
  }

  void tangent(const Tensor& strain, StressTangent& result) const override {
    const double s = determinant_change(2.0 * strain), scale = std::cbrt(1.0 / (1.0 + s));
    const Tensor inverse = inverse_metric(strain);
    const Tensor identity = Tensor::Identity(), c = identity + 2.0 * strain;
    const double first_invariant = c.trace(),
                 second_invariant = 0.5 * (first_invariant * first_invariant - c.squaredNorm());
    const Tensor slope = first_invariant * identity - c;  // ∂I₂/∂C
    result.setZero();
    const double one = 4.0 * first_ * scale, two = 4.0 * second_ * scale * scale;
    add_dyad(identity, inverse, -one / 3.0, result);
    add_dyad(inverse, identity, -one / 3.0, result);
    add_dyad(slope, inverse, -2.0 / 3.0 * two, result);
    add_dyad(inverse, slope, -2.0 / 3.0 * two, result);
    add_dyad(inverse, inverse, one * first_invariant / 9.0 + two * 4.0 / 9.0 * second_invariant, result);
    add_symmetric_product(inverse, one * first_invariant / 3.0 + two * 2.0 / 3.0 * second_invariant, result);
    add_dyad(identity, identity, two, result);
    add_symmetric_product(identity, -two, result);
    volume_.add_tangent(s, inverse, result);
  }

 private:
  /// Invariants in which the energy is expressed.
  template <class T>
  struct Distortion {
    using Number = typename T::Number;
    RICOCHET_PART_OF_CALLER explicit Distortion(const T& strain) {
      const Number c = 2.0 / 3.0 * trace(strain);
      stretch = 1.0 + c;
      deviator = combination(Number{} + 1.0, strain, -0.5 * c);
      adjugate = ricochet::adjugate(deviator);
      square = double_dot(deviator, deviator);
      third = determinant(deviator, adjugate);
      volume_change = c * (3.0 + c * (3.0 + c)) - 2.0 * stretch * square + 8.0 * third;
    }
    Number stretch;        ///< m = 1 + c
    T deviator, adjugate;  ///< D, adj D
    Number square, third;  ///< D : D, det D
    Number volume_change;  ///< s = J² − 1
  };
  double first_, second_;
  VolumetricEnergy volume_;
};

std::vector<Key> mooney_rivlin_keys() {
  return {number_key("c10", "stress", required(), "Coefficient of the first invariant; c10 + c01 > 0."),
          number_key("c01", "stress", required(),
                     "Coefficient of the second invariant; the shear modulus at zero strain is 2 (c10 + c01)."),
          number_key("bulk_modulus", "stress", required(positive), "Bulk modulus at zero strain.")};
}

void check_mooney_rivlin(const ParameterCheck& check, Parameters& values) {
  if (!check.is_usable("c10") || !check.is_usable("c01")) return;
  const double sum = values.number("c10") + values.number("c01");
  if (!(sum > 0.0)) {
    check.add_problem("c01", fmt::format("c10 + c01 must be positive; it is {:g}", sum));
    return;
  }
  const char* const negative = values.number("c10") < 0.0 ? "c10" : "c01";
  if (values.number(negative) < 0.0) {
    check.add_warning(
        negative,
        fmt::format("{} is negative: at large strains such a body no longer resists, and steps find no solution",
                    negative));
  }
  if (!check.is_usable("bulk_modulus")) return;
  const double bulk = values.number("bulk_modulus"), shear = 2.0 * sum;
  if (bulk < 2.0 / 3.0 * shear) {
    check.add_warning(
        "bulk_modulus",
        fmt::format("the bulk modulus {:.3g} is small compared with the shear modulus 2 (c10 + c01) = {:.3g}: "
                    "Poisson's ratio is {:.3g}, below zero; check the units (rubber has a bulk modulus of some 2e9 Pa)",
                    bulk, shear, (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear)));
  }
}

}  // namespace

MaterialLawRegistration mooney_rivlin_law() {
  const auto make = [](const Parameters& parameters) {
    return std::make_unique<MooneyRivlin>(parameters.number("c10"), parameters.number("c01"),
                                          parameters.number("bulk_modulus"));
  };
  return {"mooney-rivlin", {make, true}, mooney_rivlin_keys(), {}, check_mooney_rivlin};
}

}  // namespace ricochet
