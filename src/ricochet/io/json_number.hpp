#pragma once

#include <cmath>
#include <string>

/// @file Numbers in JSON, which has no infinities: they are said in words. Not part of the public interface.
namespace ricochet {

template <class Json>
[[nodiscard]] Json number_to_json(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

template <class Json>
[[nodiscard]] double number_from_json(const Json& value) {
  if (value.is_number()) return value.template get<double>();
  const std::string text = value.is_string() ? value.template get<std::string>() : "nan";
  return text == "inf" ? INFINITY : text == "-inf" ? -INFINITY : NAN;
}

}  // namespace ricochet
