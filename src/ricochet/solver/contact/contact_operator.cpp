#include "ricochet/solver/contact/contact_operator.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

void require_square(Index rows, Index columns) {
  if (rows != columns)
    throw Error(ErrorKind::invalid_input,
                fmt::format("contact problem: W has {} rows and {} columns, but must be square", rows, columns));
}

class DenseOperator final : public ContactOperator {
 public:
  explicit DenseOperator(Matrix w) : w_(std::move(w)) { require_square(w_.rows(), w_.cols()); }
  [[nodiscard]] Index rows() const override { return w_.rows(); }
  void multiply(const Vector& x, Vector& y) const override { y.noalias() = w_ * x; }
  [[nodiscard]] PointMatrix block(Index first, Index size) const override { return w_.block(first, first, size, size); }
  [[nodiscard]] const Matrix* dense() const override { return &w_; }

 private:
  Matrix w_;
};

class SparseOperator final : public ContactOperator {
 public:
  explicit SparseOperator(SparseMatrix w) : w_(std::move(w)) {
    require_square(w_.rows(), w_.cols());
    w_.makeCompressed();
  }
  [[nodiscard]] Index rows() const override { return w_.rows(); }
  void multiply(const Vector& x, Vector& y) const override { y.noalias() = w_ * x; }
  [[nodiscard]] PointMatrix block(Index first, Index size) const override {
    PointMatrix result(size, size);
    for (Index j = 0; j < size; ++j) {
      for (Index i = 0; i < size; ++i) result(i, j) = w_.coeff(first + i, first + j);
    }
    return result;
  }
  [[nodiscard]] const SparseMatrix* sparse() const override { return &w_; }

 private:
  SparseMatrix w_;
};

class ProductOperator final : public ContactOperator {
 public:
  ProductOperator(Index rows, std::function<void(const Vector&, Vector&)> product)
      : rows_(rows), product_(std::move(product)) {
    if (rows_ < 0 || product_ == nullptr) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("contact problem: W with {} rows needs {}", rows_,
                              rows_ < 0 ? "a nonnegative number of rows" : "a product function"));
    }
  }
  [[nodiscard]] Index rows() const override { return rows_; }
  void multiply(const Vector& x, Vector& y) const override {
    y.setZero(rows_);
    product_(x, y);
    if (y.size() != rows_) {
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("contact problem: the product with W returns {} entries, but W has {} rows", y.size(), rows_));
    }
  }
  [[nodiscard]] PointMatrix block(Index first, Index size) const override {
    PointMatrix result(size, size);
    Vector unit = Vector::Zero(rows_);
    Vector column(rows_);
    for (Index j = 0; j < size; ++j) {
      unit[first + j] = 1.0;
      multiply(unit, column);
      unit[first + j] = 0.0;
      result.col(j) = column.segment(first, size);
    }
    return result;
  }

 private:
  Index rows_;
  std::function<void(const Vector&, Vector&)> product_;
};

}  // namespace

std::shared_ptr<ContactOperator> make_dense_operator(Matrix w) { return std::make_shared<DenseOperator>(std::move(w)); }

std::shared_ptr<ContactOperator> make_sparse_operator(SparseMatrix w) {
  return std::make_shared<SparseOperator>(std::move(w));
}

std::shared_ptr<ContactOperator> make_product_operator(Index rows,
                                                       std::function<void(const Vector& x, Vector& y)> product) {
  return std::make_shared<ProductOperator>(rows, std::move(product));
}

}  // namespace ricochet
