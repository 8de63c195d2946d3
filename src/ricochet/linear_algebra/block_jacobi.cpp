#include "ricochet/linear_algebra/block_jacobi.hpp"

#include <Eigen/LU>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

template <int d>
class BlockJacobi final : public Preconditioner {
 public:
  BlockJacobi(const SparseMatrix& matrix, const std::vector<char>& solved, const Ranks& ranks)
      : inverse_(static_cast<std::size_t>(matrix.cols() / d)) {
    Vector blocks = Vector::Zero(matrix.cols() * d);
    for (Index node = 0; node < nodes(); ++node) {
      Eigen::Map<Block> block(blocks.data() + node * d * d);
      for (int k = 0; k < d; ++k) {
        for (SparseMatrix::InnerIterator entry(matrix, node * d + k); entry; ++entry) {
          if (entry.row() / d == node) block(entry.row() % d, k) = entry.value();
        }
      }
    }
    ranks.accumulate(blocks);
    for (Index node = 0; node < nodes(); ++node) {
      Block block = Eigen::Map<const Block>(blocks.data() + node * d * d);
      for (int k = 0; k < d; ++k) {
        if (solved[static_cast<std::size_t>(node * d + k)] != 0) continue;
        block.row(k).setZero();
        block.col(k).setZero();
        block(k, k) = 1.0;
      }
      inverse_[static_cast<std::size_t>(node)] = block.inverse();
    }
  }

  void apply(const Vector& r, Vector& z) const override {
    z.resize(r.size());
    parallel_ranges(nodes(), [&](Index begin, Index end) {
      for (Index node = begin; node < end; ++node)
        z.segment<d>(node * d) = inverse_[static_cast<std::size_t>(node)] * r.segment<d>(node * d);
    });
  }

 private:
  using Block = Eigen::Matrix<double, d, d>;
  [[nodiscard]] Index nodes() const { return static_cast<Index>(inverse_.size()); }

  std::vector<Block> inverse_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_block_jacobi(const SparseMatrix& matrix, int d, const std::vector<char>& solved,
                                                  const Ranks& ranks) {
  if (d == 2) return std::make_unique<BlockJacobi<2>>(matrix, solved, ranks);
  return std::make_unique<BlockJacobi<3>>(matrix, solved, ranks);
}

}  // namespace ricochet
