#include "ricochet/linear_algebra/anderson_acceleration.hpp"

#include "ricochet/base/dense_decompositions.hpp"

namespace ricochet {

namespace {

/// Directions of changes that differ by less are the same.
constexpr double same_direction = 1e-10;

void keep_newest(std::vector<Vector>& vectors, Vector newest, std::size_t most) {
  if (vectors.size() == most) vectors.erase(vectors.begin());
  vectors.push_back(std::move(newest));
}

Matrix as_columns(const std::vector<Vector>& vectors) {
  Matrix result(vectors.front().size(), static_cast<Index>(vectors.size()));
  for (std::size_t k = 0; k < vectors.size(); ++k) result.col(static_cast<Index>(k)) = vectors[k];
  return result;
}

}  // namespace

void AndersonAcceleration::restart() {
  image_.resize(0);
  image_changes_.clear();
  residual_changes_.clear();
}

Vector AndersonAcceleration::next(const Vector& point, const Vector& image) {
  const Vector residual = image - point;
  if (image_.size() > 0) {
    keep_newest(image_changes_, image - image_, depth_);
    keep_newest(residual_changes_, residual - residual_, depth_);
  }
  image_ = image;
  residual_ = residual;
  if (residual_changes_.empty()) return image;
  // Changes become smaller by orders of magnitude, the newest count most.
  Matrix directions = as_columns(residual_changes_);
  const Vector lengths = directions.colwise().norm().transpose();
  for (Index k = 0; k < lengths.size(); ++k) directions.col(k) /= lengths[k] > 0.0 ? lengths[k] : 1.0;
  Vector weights = LeastNormSolver(directions, same_direction).solve(residual);
  for (Index k = 0; k < lengths.size(); ++k) weights[k] /= lengths[k] > 0.0 ? lengths[k] : 1.0;
  return image - as_columns(image_changes_) * weights;
}

}  // namespace ricochet
