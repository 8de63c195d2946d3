#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ricochet/simulation/history/sensor.hpp"

/// @file Sensors whose quantities are described once, each with its value.
namespace ricochet {

/// Base of a sensor `Self` with the static function `quantities()`, which returns a reference to a static list of
/// ValuedQuantity<Self>, and `evaluate(const Observation&)`, which computes what their values are read from.
template <class Self>
class QuantitySensor : public Sensor {
 public:
  using Quantities = std::vector<ValuedQuantity<Self>>;

  /// `prefix`: before the names of the quantities.
  QuantitySensor(std::string prefix, const SemidiscreteProblem& problem)
      : QuantitySensor(std::move(prefix), problem.dimension) {}
  QuantitySensor(std::string prefix, int dimension) : prefix_(std::move(prefix)), dimension_(dimension) {}

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    static_assert(std::is_lvalue_reference_v<decltype(Self::quantities())>);
    add_columns(Self::quantities(), self(), prefix_, dimension_, columns);
    return columns;
  }
  void observe(const Observation& observation, std::vector<double>& row) override {
    static_cast<Self&>(*this).evaluate(observation);
    append_values(Self::quantities(), self(), dimension_, row);
  }
  /// Reads the value from a member of the sensor, a number or a vector.
  template <class Value>
  static auto member_value(Value Self::*member) {
    return [member](const Self& sensor, [[maybe_unused]] Index k) -> double {
      const Value& value = sensor.*member;
      if constexpr (std::is_same_v<Value, double>) {
        return value;
      } else {
        return value[value.size() == 1 ? 0 : k];  // in 2D an axial vector may have one component
      }
    };
  }
  /// Returns the documentation of the quantities.
  [[nodiscard]] static std::vector<RowQuantity> descriptions() { return documentation_of(Self::quantities()); }

 private:
  [[nodiscard]] const Self& self() const { return static_cast<const Self&>(*this); }

  std::string prefix_;
  int dimension_;
};

}  // namespace ricochet
