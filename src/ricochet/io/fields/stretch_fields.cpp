#include <fmt/format.h>

#include <array>
#include <cmath>

#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/elastic_cells.hpp"
#include "ricochet/io/fields/field_source.hpp"

namespace ricochet {

namespace {

/// √(1 + 2 E_i) of the principal values of each cell's mean of Green's strain, the first the largest: the principal
/// stretches if the deformation is uniform in the cell. Available for laws of finite strain only.
class StretchFields final : public FieldSource {
 public:
  explicit StretchFields(const FieldContext& context) : body_(context.body) {
    if (!has_finite_strain(body_)) return;
    cells_ = std::make_unique<ElasticCells>(body_);
    for (std::size_t k = 0; k < stretches_.size(); ++k) {
      const std::string name = fmt::format("principal_stretch_{}", k + 1);
      const Index cells = body_.mesh->cell_count();
      stretches_[k].assign(std::size_t(cells), 1.0);
      if (context.is_requested(name))
        fields_.push_back({name, FieldLocation::cells, 1, false, cells, stretches_[k].data()});
    }
  }

  [[nodiscard]] std::vector<Field> fields() const override { return fields_; }

  void evaluate(const State& state) override {
    if (!cells_) return;
    Index first = 0;
    for (std::size_t block = 0; block < body_.space->cells.size(); ++block) {
      const Index count = body_.space->cells[block].size();
      parallel_ranges(count, [&](Index begin, Index end) {
        for (Index local = begin; local < end; ++local) {
          std::array<double, tensor_components> strain;
          cells_->cell_strain(block, local, first + local, state.displacement, strain.data());
          const std::array<double, 3> values = principal_stresses(strain.data());
          for (std::size_t k = 0; k < 3; ++k)
            stretches_[k][std::size_t(first + local)] = std::sqrt(1.0 + 2.0 * values[k]);
        }
      });
      first += count;
    }
  }

 private:
  const Body& body_;
  std::unique_ptr<ElasticCells> cells_;
  std::array<std::vector<double>, 3> stretches_;
  std::vector<Field> fields_;
};

}  // namespace

std::unique_ptr<FieldSource> make_stretch_fields(const FieldContext& context) {
  return std::make_unique<StretchFields>(context);
}

}  // namespace ricochet
