#include "ricochet/base/blas_kernels.hpp"

#include <cblas.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <limits>
#include <system_error>
#include <vector>

#include "ricochet/base/blas.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"

extern "C" {
__attribute__((weak)) void gotoblas_dynamic_init();
__attribute__((weak)) void gotoblas_dynamic_quit();
void dpotrf_(const char* triangle, const int* size, double* matrix, const int* stride, int* info);
}

namespace ricochet {

namespace {

constexpr const char* core_variable = "OPENBLAS_CORETYPE";
constexpr std::array<std::string_view, 3> core_of_set{"Prescott", "Haswell", "SkylakeX"};

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Rank of the instruction sets that a core's kernels require. An unknown core is newer and ranks highest.
int demands(std::string_view core) {
  constexpr std::array<std::string_view, 16> sse{
      "Katmai",     "Coppermine", "Northwood", "Prescott", "Banias", "Atom",         "Core2",     "Penryn",
      "Dunnington", "Nehalem",    "Athlon",    "Opteron",  "Bobcat", "Opteron_SSE3", "Barcelona", "Nano"};
  constexpr std::array<std::string_view, 4> avx{"Sandybridge", "Bulldozer", "Piledriver", "Steamroller"};
  constexpr std::array<std::string_view, 3> avx2{"Haswell", "Excavator", "Zen"};
  const auto is_core = [core](std::string_view name) { return same_name(core, name); };
  if (std::ranges::any_of(sse, is_core)) return 0;
  if (std::ranges::any_of(avx, is_core)) return 1;
  if (std::ranges::any_of(avx2, is_core)) return 2;
  return 3;
}

/// Returns whether threads run besides those of OpenBLAS, which are idle here. The OpenMP version of OpenBLAS has none
/// until it needs them.
bool other_threads_run() {
  std::error_code failed;
  const std::filesystem::directory_iterator threads("/proc/self/task", failed);
  if (failed) return true;
  constexpr int own_threads = 1;  // value of openblas_get_parallel if compiled with threads of its own
  const int expected = openblas_get_parallel() == own_threads ? openblas_get_num_threads() : 1;
  return std::distance(begin(threads), end(threads)) > std::max(expected, 1);
}

void select_core(const char* name) {
  if (name != nullptr) setenv(core_variable, name, 1);
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  unsetenv(core_variable);
}

/// Returns y = M x or y = Mᵀ x by plain loops; with `lower`, M is restricted to its lower triangle.
std::vector<double> times(const std::vector<double>& matrix, const std::vector<double>& x, bool transposed,
                          bool lower) {
  const std::size_t n = x.size();
  std::vector<double> y(n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = lower ? j : 0; i < n; ++i) {
      const double entry = matrix[j * n + i];
      transposed ? y[j] += entry * x[i] : y[i] += entry * x[j];
    }
  }
  return y;
}

/// Checks a product B = A Aᵀ + n I, its Cholesky factor L and a triangular solve: L X = B must give X = Lᵀ. Results are
/// compared through their products with one vector, which takes few operations.
bool computes_rightly(int size) {
  constexpr double one = 1.0;
  const auto n = std::size_t(size);
  std::vector<double> a(n * n), b(n * n), x(n);
  for (std::size_t k = 0; k < a.size(); ++k) a[k] = double(k * k % 199) / 99.0 - 1.0;
  for (std::size_t i = 0; i < n; ++i) x[i] = double(i * i % 17) / 8.0 - 1.0;
  for (std::size_t i = 0; i < n; ++i) b[i * n + i] = size;
  // Entries of A and x are at most 1, hence those of B x at most n³.
  const double tolerance = 4.0 * std::pow(size, 3) * std::numeric_limits<double>::epsilon();
  const auto differ = [&](const std::vector<double>& found, const std::vector<double>& expected) {
    for (std::size_t i = 0; i < n; ++i) {
      if (!(std::abs(found[i] - expected[i]) <= tolerance)) return true;
    }
    return false;
  };
  std::vector<double> expected = times(a, times(a, x, true, false), false, false);
  for (std::size_t i = 0; i < n; ++i) expected[i] += size * x[i];
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, size, size, size, one, a.data(), size, a.data(), size, one,
              b.data(), size);
  if (differ(times(b, x, false, false), expected)) return false;
  std::vector<double> factor = b;
  int info = 0;
  dpotrf_("L", &size, factor.data(), &size, &info);
  if (info != 0 || differ(times(factor, times(factor, x, true, true), false, true), expected)) return false;
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, size, size, one, factor.data(), size,
              b.data(), size);
  return !differ(times(b, x, false, false), times(factor, x, true, true));
}

/// Runs the checks on one thread, whose memory has been reserved.
bool computes_rightly_alone() {
  const int threads = openblas_get_num_threads();
  openblas_set_num_threads(1);
  // Small matrices have kernels of their own; neither size is a multiple of any block size.
  const bool right = computes_rightly(37) && computes_rightly(301);
  openblas_set_num_threads(threads);
  return right;
}

/// Reserves memory for the calls of `computes_rightly`, since OpenBLAS would repeat a refused request forever.
bool has_memory() {
  try {
    reserve_blas_memory(1);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string_view better_blas_core(std::string_view chosen, InstructionSet set, bool given) {
  const std::string_view core = core_of_set[std::size_t(set)];
  if (given) return same_name(chosen, core) ? "" : core;
  return demands(chosen) < demands(core) ? core : "";
}

void choose_blas_kernels() {
  const std::string before = openblas_get_corename();
  const std::string core(better_blas_core(before, instruction_set(), instruction_set_is_given()));
  if (core.empty() || std::getenv(core_variable) != nullptr) return;
  const auto stays = [&](std::string_view reason) {
    log::warning(fmt::format(
        "OpenBLAS keeps its kernels for {}, although those for {} {}: {}", before, core,
        instruction_set_is_given() ? "match RICOCHET_INSTRUCTION_SET" : "suit this processor better", reason));
  };
  if (gotoblas_dynamic_init == nullptr || gotoblas_dynamic_quit == nullptr)
    return stays("this OpenBLAS cannot change them");
  if (other_threads_run()) {
    return stays(
        fmt::format("other threads were running when Ricochet first needed it, and one of them might have been using "
                    "OpenBLAS; call ricochet::prepare_blas() before they start, or set {}={}",
                    core_variable, core));
  }
  if (!has_memory()) return stays("the memory limit (ulimit -v) leaves no memory to check other kernels");
  select_core(core.c_str());
  if (same_name(openblas_get_corename(), core) && computes_rightly_alone()) return;
  select_core(nullptr);
  stays("this OpenBLAS does not have them, or they compute wrong results here");
}

}  // namespace ricochet
