#include "ricochet/rigid/obstacle_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/input_file.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/number_lines.hpp"

namespace ricochet {

namespace {

class UniformPath final : public ObstaclePath {
 public:
  explicit UniformPath(const Vector& velocity) : velocity_(velocity) {}
  [[nodiscard]] SpaceVector displacement(double time) const override { return time * velocity_; }
  [[nodiscard]] bool is_uniform() const override { return true; }
  [[nodiscard]] SpaceVector velocity() const override { return velocity_; }

 private:
  SpaceVector velocity_;
};

SpaceVector value_of(const std::vector<Expression>& components, double time) {
  SpaceVector result(static_cast<Index>(components.size()));
  for (Index k = 0; k < result.size(); ++k) result[k] = components[std::size_t(k)](0.0, 0.0, 0.0, time);
  return result;
}

class ExpressionPath final : public ObstaclePath {
 public:
  ExpressionPath(std::vector<Expression> displacement, std::vector<Expression> rotation, Index dimension)
      : displacement_(std::move(displacement)), rotation_(std::move(rotation)), dimension_(dimension) {}
  [[nodiscard]] SpaceVector displacement(double time) const override {
    return displacement_.empty() ? SpaceVector(SpaceVector::Zero(dimension_)) : value_of(displacement_, time);
  }
  [[nodiscard]] SpaceVector rotation(double time) const override { return value_of(rotation_, time); }
  [[nodiscard]] bool rotates() const override { return !rotation_.empty(); }

 private:
  std::vector<Expression> displacement_, rotation_;
  Index dimension_;
};

class TablePath final : public ObstaclePath {
 public:
  TablePath(std::vector<double> times, Points values, Index dimension)
      : times_(std::move(times)), values_(std::move(values)), dimension_(dimension) {}
  [[nodiscard]] SpaceVector displacement(double time) const override { return at(time).head(dimension_); }
  [[nodiscard]] SpaceVector rotation(double time) const override { return at(time).tail(values_.rows() - dimension_); }
  [[nodiscard]] bool rotates() const override { return values_.rows() > dimension_; }
  [[nodiscard]] std::string checksum() const override {
    return Checksum().add(times_.data(), times_.size()).add(values_.data(), std::size_t(values_.size())).text();
  }

 private:
  using Row = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
  [[nodiscard]] Row at(double time) const {
    const auto after = std::ranges::upper_bound(times_, time);
    if (after == times_.begin()) return values_.col(0);
    if (after == times_.end()) return values_.col(values_.cols() - 1);
    const auto next = Index(after - times_.begin());
    const double before = times_[std::size_t(next - 1)];
    const double part = (time - before) / (*after - before);
    return (1.0 - part) * values_.col(next - 1) + part * values_.col(next);
  }
  std::vector<double> times_;
  Points values_;
  Index dimension_;
};

/// Refuses a header that names the last of four columns as a length, since it is an angle in the plane.
void refuse_length_header(const NumberLines& lines, const std::string& file) {
  const std::array lengths{"z", "uz", "u_z", "dz", "Z", "UZ", "U_Z", "DZ"};
  const std::string last = lines.header().empty() ? "" : lines.header().back();
  if (std::ranges::find(lengths, last) != lengths.end())
    lines.fail(fmt::format("the fourth column is called \"{}\", but in two dimensions it is the rotation in rad; "
                           "remove it, or call it \"rotation\"",
                           last),
               lines.header_line());
  log::info(fmt::format("{}: each line has the time, two displacements and the rotation in rad", file));
}

}  // namespace

std::unique_ptr<ObstaclePath> make_uniform_path(const Vector& velocity) {
  if (velocity.size() == 0 || velocity.isZero(0.0)) return nullptr;
  return std::make_unique<UniformPath>(velocity);
}

std::unique_ptr<ObstaclePath> make_path(std::vector<Expression> displacement, std::vector<Expression> rotation,
                                        Index dimension) {
  if (displacement.empty() && rotation.empty()) return nullptr;
  return std::make_unique<ExpressionPath>(std::move(displacement), std::move(rotation), dimension);
}

std::unique_ptr<ObstaclePath> read_path(const std::string& file, Index dimension) {
  const std::string text = read_input(file, "motion");
  const std::size_t still = std::size_t(dimension) + 1, with_rotation = dimension == 2 ? 4 : 7;
  std::vector<double> times, values;
  std::size_t columns = 0;
  NumberLines lines(file, text, NumberLines::Header::allowed);
  while (lines.next()) {
    const std::vector<double>& numbers = lines.numbers();
    if (numbers.empty()) continue;
    if (columns == 0) columns = numbers.size();
    if (numbers.size() != columns || (columns != still && columns != with_rotation)) {
      lines.fail(
          fmt::format("{} numbers; each line of a motion in {}D must have {} (t and the displacement), or {} with the "
                      "rotation in rad",
                      numbers.size(), dimension, still, with_rotation));
    }
    if (!times.empty() && !(numbers.front() > times.back()))
      lines.fail(fmt::format("the time {} is not after {}", numbers.front(), times.back()));
    times.push_back(numbers.front());
    values.insert(values.end(), numbers.begin() + 1, numbers.end());
  }
  if (times.empty()) throw Error(ErrorKind::invalid_input, fmt::format("{}: the motion contains no numbers", file));
  if (dimension == 2 && columns == with_rotation) refuse_length_header(lines, file);
  const auto rows = Index(columns) - 1, count = Index(times.size());
  return std::make_unique<TablePath>(std::move(times), Eigen::Map<const Points>(values.data(), rows, count), dimension);
}

}  // namespace ricochet
