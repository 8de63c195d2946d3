#pragma once

#include "ricochet/base/types.hpp"

namespace ricochet {

/// A point or a displacement in space, with two or three components; constructing one allocates nothing.
using SpaceVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;

}  // namespace ricochet
