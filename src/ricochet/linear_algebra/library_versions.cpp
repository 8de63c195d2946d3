#include "ricochet/linear_algebra/library_versions.hpp"

#include <cblas.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <string_view>

#include "ricochet/base/blas.hpp"
#include "ricochet/base/instruction_sets.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/linear_algebra/supernodal_kernels.hpp"

namespace ricochet {

namespace {

#if defined(__clang__)
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

/// Returns "0.3.21" from "OpenBLAS 0.3.21 NO_LAPACKE DYNAMIC_ARCH …".
std::string blas_version() {
  const std::string_view config = openblas_get_config();
  const std::size_t begin = config.find(' ') + 1;
  return std::string(config.substr(begin, config.find(' ', begin) - begin));
}

}  // namespace

std::string library_versions() {
  prepare_blas();
  return fmt::format("OpenBLAS {} ({}), {}, Eigen {}.{}.{}, compiled by {}, loops for {}{}", blas_version(),
                     openblas_get_corename(), SparseCholesky::library(), EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION, compiler, name(instruction_set()),
                     stream_count() == StreamCount::one ? " that read one stream" : "");
}

}  // namespace ricochet
