#include "ricochet/fem/distortion_law.hpp"

#include "ricochet/fem/packed_law.hpp"

namespace ricochet {

namespace {

/// With x = max(1 − j, 0), W = k x³/j and S = −k x² (1 + 2j)/j C⁻¹.
class DistortionLaw final : public PackedLaw<DistortionLaw> {
 public:
  explicit DistortionLaw(double stiffness) : stiffness_(stiffness) {}

  [[nodiscard]] double lambda() const override { return 0.0; }
  [[nodiscard]] double mu() const override { return 0.0; }
  template <class T>
  RICOCHET_PART_OF_CALLER typename T::Number density(const T& strain) const {
    using Number = typename T::Number;
    const Number ratio = ratio_of(measures_of(strain).volume_change), lacking = lack_of(ratio);
    return stiffness_ * (lacking * lacking * lacking / ratio);
  }
  template <class T>
  RICOCHET_PART_OF_CALLER T stress_at(const T& strain) const {
    using Number = typename T::Number;
    const StrainMeasures<T> of = measures_of(strain);
    const Number ratio = ratio_of(of.volume_change), lacking = lack_of(ratio);
    return of.inverse(Number(-stiffness_ * (lacking * lacking * (1.0 + 2.0 * ratio) / ratio)));
  }
  // With S = k h(j) C⁻¹, h = −(1 − j)² (1 + 2j)/j, it is k j h′ C⁻¹ ⊗ C⁻¹ and the derivative of C⁻¹; j h′ = 1/j + 3j −
  // 4j².
  void tangent(const Tensor& strain, StressTangent& result) const override {
    const double ratio = ratio_of(determinant_change(2.0 * strain)), lacking = lack_of(ratio);
    result.setZero();
    if (lacking == 0.0) return;
    const Tensor inverse = inverse_metric(strain);
    add_dyad(inverse, inverse, stiffness_ * (1.0 / ratio + ratio * (3.0 - 4.0 * ratio)), result);
    add_symmetric_product(inverse, 2.0 * stiffness_ * lacking * lacking * (1.0 + 2.0 * ratio) / ratio, result);
  }

 private:
  /// j, from J² − 1.
  template <class Number>
  RICOCHET_PART_OF_CALLER static Number ratio_of(const Number& volume_change) {
    return square_root(Number(1.0 + volume_change)) * (1.0 / distortion_volume_ratio);
  }
  template <class Number>
  RICOCHET_PART_OF_CALLER static Number lack_of(const Number& ratio) {
    const Number lacking = 1.0 - ratio;
    return 0.5 * (lacking + square_root(Number(lacking * lacking)));
  }

  double stiffness_;
};

}  // namespace

std::shared_ptr<const MaterialLaw> make_distortion_law(double stiffness) {
  return std::make_shared<DistortionLaw>(stiffness);
}

}  // namespace ricochet
