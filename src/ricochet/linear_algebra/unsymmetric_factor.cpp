#include "ricochet/linear_algebra/unsymmetric_factor.hpp"

#include <umfpack.h>

#include <array>
#include <new>
#include <vector>

namespace ricochet {

struct UnsymmetricFactor::Implementation {
  SparseMatrix matrix;
  void* symbolic = nullptr;
  void* numeric = nullptr;
  std::array<double, UMFPACK_CONTROL> control{};
  mutable std::array<double, UMFPACK_INFO> info{};
  mutable std::vector<int> integers;
  mutable Vector work;

  Implementation() {
    umfpack_di_defaults(control.data());
    control[UMFPACK_IRSTEP] = 0.0;  // the iterations of a step correct the rounding of a solution
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() { release(); }

  void release() {
    if (numeric != nullptr) umfpack_di_free_numeric(&numeric);
    if (symbolic != nullptr) umfpack_di_free_symbolic(&symbolic);
  }
  static bool is_done(int status) {
    if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
    return status == UMFPACK_OK;
  }
};

UnsymmetricFactor::UnsymmetricFactor() : implementation_(std::make_unique<Implementation>()) {}
UnsymmetricFactor::~UnsymmetricFactor() = default;

double UnsymmetricFactor::analyse(const SparseMatrix& matrix) {
  Implementation& own = *implementation_;
  own.release();
  own.matrix = matrix;
  own.matrix.makeCompressed();
  const int size = int(matrix.rows());
  const int status = umfpack_di_symbolic(size, size, own.matrix.outerIndexPtr(), own.matrix.innerIndexPtr(),
                                         own.matrix.valuePtr(), &own.symbolic, own.control.data(), own.info.data());
  return Implementation::is_done(status) ? own.info[UMFPACK_FLOPS_ESTIMATE] : 0.0;
}

bool UnsymmetricFactor::factorize() {
  Implementation& own = *implementation_;
  if (own.symbolic == nullptr) return false;
  if (own.numeric != nullptr) umfpack_di_free_numeric(&own.numeric);
  own.integers.resize(std::size_t(own.matrix.rows()));
  own.work.resize(own.matrix.rows());
  return Implementation::is_done(umfpack_di_numeric(own.matrix.outerIndexPtr(), own.matrix.innerIndexPtr(),
                                                    own.matrix.valuePtr(), own.symbolic, &own.numeric,
                                                    own.control.data(), own.info.data()));
}

void UnsymmetricFactor::solve(const Vector& right, Vector& x) const {
  const Implementation& own = *implementation_;
  x.resize(right.size());
  umfpack_di_wsolve(UMFPACK_A, own.matrix.outerIndexPtr(), own.matrix.innerIndexPtr(), own.matrix.valuePtr(), x.data(),
                    right.data(), own.numeric, own.control.data(), own.info.data(), own.integers.data(),
                    own.work.data());
}

}  // namespace ricochet
