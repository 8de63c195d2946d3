#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/base/contact_status.hpp"
#include "ricochet/base/types.hpp"

/// @file Named numbers and texts: the state of a run, from which it can continue later with the same bits.
///
/// Every part that keeps state from step to step has save(snapshot, name) and load(snapshot, name). Names are paths
/// ("solver.0.candidates"). A part loads what it has saved, all of it and nothing else; everything that is constant
/// during a run is computed again from the case. See io/checkpoint.hpp for the file.
namespace ricochet {

class Snapshot {
 public:
  using Integers = std::vector<std::int64_t>;
  using Texts = std::vector<std::string>;
  using Value = std::variant<Vector, Integers, Texts>;

  void save(const std::string& name, const Vector& values) { values_[name] = values; }
  void save(const std::string& name, double value) { values_[name] = Vector(Vector::Constant(1, value)); }
  void save(const std::string& name, Integers values) { values_[name] = std::move(values); }
  void save(const std::string& name, std::int64_t value) { values_[name] = Integers{value}; }
  void save(const std::string& name, int value) { save(name, std::int64_t{value}); }
  void save(const std::string& name, bool value) { save(name, std::int64_t{value ? 1 : 0}); }
  void save(const std::string& name, const std::vector<ContactStatus>& values);
  void save(const std::string& name, Texts values) { values_[name] = std::move(values); }
  void save(const std::string& name, const std::string& value) { values_[name] = Texts{value}; }

  [[nodiscard]] bool has(const std::string& name) const { return values_.contains(name); }
  /// All of these throw Error(invalid_input) if the entry is missing or of another type or size.
  [[nodiscard]] const Vector& reals(const std::string& name) const;
  /// Requires one of these two sizes.
  [[nodiscard]] const Vector& reals(const std::string& name, Index size, Index other_size = -1) const;
  [[nodiscard]] double real(const std::string& name) const { return reals(name, 1)[0]; }
  [[nodiscard]] const Integers& integers(const std::string& name) const;
  /// Requires each value to be from `least` to `most`.
  [[nodiscard]] const Integers& integers(const std::string& name, std::int64_t least, std::int64_t most) const;
  [[nodiscard]] std::int64_t integer(const std::string& name) const;
  [[nodiscard]] bool flag(const std::string& name) const { return integer(name) != 0; }
  [[nodiscard]] std::vector<ContactStatus> statuses(const std::string& name, Index size) const;
  [[nodiscard]] const Texts& texts(const std::string& name) const;
  [[nodiscard]] const std::string& text(const std::string& name) const;

  /// All values, in the order of their names.
  [[nodiscard]] const std::map<std::string, Value>& values() const { return values_; }
  void set(const std::string& name, Value value) { values_[name] = std::move(value); }

  /// Throws Error(invalid_input), "the saved state does not fit: NAME WHY", for parts that check more.
  [[noreturn]] static void refuse(const std::string& name, const std::string& why);

 private:
  template <class Kind>
  [[nodiscard]] const Kind& find(const std::string& name, const char* kind) const;

  std::map<std::string, Value> values_;
};

}  // namespace ricochet
