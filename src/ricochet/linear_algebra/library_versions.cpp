#include "ricochet/linear_algebra/library_versions.hpp"

#include <cblas.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <string_view>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"

namespace ricochet {

namespace {

#if defined(__clang__)
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

/// "0.3.21" of "OpenBLAS 0.3.21 NO_LAPACKE DYNAMIC_ARCH …".
std::string blas_version() {
  const std::string_view config = openblas_get_config();
  const std::size_t begin = config.find(' ') + 1;
  return std::string(config.substr(begin, config.find(' ', begin) - begin));
}

/// Which of the compiled versions of a function runs, see base/instruction_sets.hpp.
const char* instruction_set() {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
  if (__builtin_cpu_supports("x86-64-v3")) return "x86-64-v3";
#endif
  return "any processor";
}

}  // namespace

std::string library_versions() {
  return fmt::format("OpenBLAS {} ({}), {}, Eigen {}.{}.{}, compiled by {} for {}", blas_version(),
                     openblas_get_corename(), SparseCholesky::library(), EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION, compiler, instruction_set());
}

}  // namespace ricochet
