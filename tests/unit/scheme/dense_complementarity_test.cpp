#include "ricochet/scheme/response/dense_complementarity.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"

namespace ricochet {
namespace {

TEST(DenseComplementarity, HoldsForRandomProblemsFromAnyStart) {
  std::srand(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 1 + trial % 40;
    const Matrix a = Matrix::Random(n, n);
    // From well conditioned to nearly singular, in any units.
    const Matrix h =
        std::pow(10.0, trial % 7 - 3) * (a * a.transpose() + std::pow(10.0, -(trial % 5)) * Matrix::Identity(n, n));
    const Vector b = h.diagonal().cwiseProduct(Vector::Random(n));
    Vector first_answer;
    for (const char start : {'\0', '\1'}) {
      const Vector r = dense_complementarity(h, b, std::vector<char>(std::size_t(n), start));
      const Vector y = h * r - b;
      const double size = b.lpNorm<Eigen::Infinity>();
      EXPECT_GE(r.minCoeff(), 0.0);
      EXPECT_GE(y.minCoeff(), -1e-12 * size);
      EXPECT_LT(r.cwiseProduct(y).lpNorm<Eigen::Infinity>(), 1e-11 * size * (1.0 + r.lpNorm<Eigen::Infinity>()));
      if (start != 0) {
        EXPECT_LT((r - first_answer).norm(), 1e-8 * (1e-300 + first_answer.norm())) << "there is one";
      }
      first_answer = r;
    }
  }
}

TEST(DenseComplementarity, RefusesWhatIsNotPositiveDefinite) {
  Matrix h(2, 2);
  h << 1.0, 2.0, 2.0, 1.0;
  EXPECT_THROW((void)dense_complementarity(h, Vector::Ones(2), {1, 1}), Error);
}

}  // namespace
}  // namespace ricochet
