#include "ricochet/case/rotation_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/log.hpp"
#include "ricochet/fem/green_strain.hpp"

namespace ricochet {

std::string spurious_strain(double rotation) {
  return fmt::format("a strain of {:.2g} % that is not there (1 - cos of the angle)",
                     100.0 * (1.0 - std::cos(rotation)));
}

void RotationWatch::watch(const std::vector<double>& row, const State& state) {
  const double rotation = row[column_];
  if (warned_ || !(rotation > rotation_limit)) return;
  warned_ = true;
  log::warning(fmt::format(
      "at t = {:.6g} a cell has rotated by {:.3g} rad: above {} rad small strain no longer holds; it takes this "
      "rotation for {}, and the largest strain that is there is {:.2g} %. A body that turns inflates, and its "
      "forces and its rebound are wrong: read what follows with care",
      row[1], rotation, rotation_limit, spurious_strain(rotation),
      100.0 * largest_green_strain(body_, state.displacement)));
}

}  // namespace ricochet
