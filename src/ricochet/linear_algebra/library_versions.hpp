#pragma once

#include <string>

/// @file Libraries that decide the bits of results besides the case: "the same machine with the same libraries".
namespace ricochet {

/// Returns "OpenBLAS 0.3.21 (Haswell), CHOLMOD 3.0.14, Eigen 3.4.0, compiled by GCC 12.2.0, loops for x86-64-v3 that
/// read one stream".
[[nodiscard]] std::string library_versions();

}  // namespace ricochet
