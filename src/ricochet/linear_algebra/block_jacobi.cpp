#include "ricochet/linear_algebra/block_jacobi.hpp"

#include <Eigen/LU>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

template <int d>
class BlockJacobi final : public Preconditioner {
 public:
  BlockJacobi(const Vector& blocks, const std::vector<char>& solved) : inverse_(std::size_t(blocks.size() / (d * d))) {
    for (Index node = 0; node < nodes(); ++node) {
      Block block = Eigen::Map<const Block>(blocks.data() + node * d * d);
      for (int k = 0; k < d; ++k) {
        if (solved[std::size_t(node * d + k)] != 0) continue;
        block.row(k).setZero();
        block.col(k).setZero();
        block(k, k) = 1.0;
      }
      inverse_[std::size_t(node)] = block.inverse();
    }
  }

  void apply(const Vector& r, Vector& z) const override {
    z.resize(r.size());
    parallel_ranges(nodes(), [&](Index begin, Index end) {
      for (Index node = begin; node < end; ++node)
        z.segment<d>(node * d) = inverse_[std::size_t(node)] * r.segment<d>(node * d);
    });
  }

 private:
  using Block = Eigen::Matrix<double, d, d>;
  [[nodiscard]] Index nodes() const { return Index(inverse_.size()); }

  std::vector<Block> inverse_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_block_jacobi(const Vector& blocks, int d, const std::vector<char>& solved) {
  if (d == 2) return std::make_unique<BlockJacobi<2>>(blocks, solved);
  return std::make_unique<BlockJacobi<3>>(blocks, solved);
}

}  // namespace ricochet
