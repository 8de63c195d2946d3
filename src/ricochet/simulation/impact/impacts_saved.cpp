#include <cmath>
#include <cstring>
#include <type_traits>

#include "ricochet/base/error.hpp"
#include "ricochet/simulation/impact/impacts.hpp"

/// @file Impacts in checkpoints.
namespace ricochet {

namespace {

/// Concatenates structures that consist of double only.
template <class Structure>
Vector as_numbers(const std::vector<Structure>& values) {
  static_assert(std::is_trivially_copyable_v<Structure> && sizeof(Structure) % sizeof(double) == 0);
  Vector result(static_cast<Index>(values.size() * (sizeof(Structure) / sizeof(double))));
  if (!values.empty()) std::memcpy(result.data(), values.data(), values.size() * sizeof(Structure));
  return result;
}

template <class Structure>
void from_numbers(const Vector& numbers, std::vector<Structure>& values) {
  values.resize(static_cast<std::size_t>(numbers.size()) / (sizeof(Structure) / sizeof(double)));
  if (!values.empty())
    std::memcpy(static_cast<void*>(values.data()), numbers.data(), values.size() * sizeof(Structure));
}

}  // namespace

void ImpactRecorder::save(Snapshot& snapshot, const std::string& name) const {
  snapshot.save(name + ".open", as_numbers(open_));
  snapshot.save(name + ".filed", as_numbers(completed_));
  snapshot.save(name + ".left_out", std::int64_t{left_out_});
  snapshot.save(name + ".method_energy", method_before_);
}

void ImpactRecorder::load(const Snapshot& snapshot, const std::string& name) {
  constexpr Index size = sizeof(Interval) / sizeof(double);
  constexpr double largest_count = 1e15;
  const auto damaged = [&] {
    throw Error(ErrorKind::invalid_input, "the checkpoint's record of impacts does not belong to this case");
  };
  from_numbers(snapshot.reals(name + ".open", size * static_cast<Index>(collision_pairs_.size())), open_);
  const Vector& filed = snapshot.reals(name + ".filed");
  if (filed.size() % size != 0 || filed.size() / size > static_cast<Index>(most_impacts)) damaged();
  from_numbers(filed, completed_);
  left_out_ = snapshot.integer(name + ".left_out");
  method_before_ = snapshot.real(name + ".method_energy");
  for (const auto* list : {&open_, &completed_}) {
    for (const Interval& interval : *list) {
      // Also false for NaN.
      if (!(interval.collision >= 0.0 && interval.collision < static_cast<double>(collision_pairs_.size()))) damaged();
      if (interval.collision != std::floor(interval.collision)) damaged();
      if (interval.phase != no_contact && interval.phase != touching && interval.phase != apart) damaged();
      for (const double count : {interval.intervals, interval.most_points}) {
        if (!(count >= 0.0 && count < largest_count)) damaged();
      }
    }
  }
  for (std::size_t collision = 0; collision < collision_pairs_.size(); ++collision) {
    if (open_[collision].collision != static_cast<double>(collision)) damaged();
  }
}

}  // namespace ricochet
