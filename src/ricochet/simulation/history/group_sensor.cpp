#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

namespace {

/// Node of the group with ∫ φ_i over the group, which for second-order elements may be zero or negative.
struct WeightedNode {
  Index node;
  double weight;
};

/// ∫ φ_i over some cells of one dimension, numbered through all blocks. `measure`: that of a cell per reference
/// measure, in the meridian plane for axisymmetric bodies.
template <class Measure>
std::vector<WeightedNode> weighted_nodes(const Body& body, const std::vector<CellBlock>& geometry,
                                         const std::vector<CellBlock>& cells, const std::vector<Index>& members,
                                         const Ranks& ranks, const Measure& measure) {
  std::map<Index, double> weights;
  Index first = 0;
  auto member = members.begin();
  const int geometry_degree = body.mesh->degree, displacement_degree = body.space->degree;
  const bool axisymmetric = is_axisymmetric(body);
  for (std::size_t b = 0; b < cells.size(); ++b) {
    const int degree = product_quadrature_degree(cells[b].shape, geometry_degree, displacement_degree, axisymmetric);
    const BlockIntegration integration(cells[b].shape, geometry_degree, displacement_degree, degree, axisymmetric);
    for (; member != members.end() && *member < first + cells[b].size(); ++member) {
      const Index local = *member - first;
      for (Index q = 0; q < integration.rule.weights.size(); ++q) {
        const double weight =
            integration.rule.weights[q] * integration.ring(body.mesh->nodes, geometry[b].cell(local), q) *
            measure(geometry[b].cell(local), integration.geometry.gradients[static_cast<std::size_t>(q)]);
        for (int i = 0; i < cells[b].nodes_per_cell; ++i)
          weights[cells[b].cell(local)[i]] += weight * integration.displacement.values(i, q);
      }
    }
    first += cells[b].size();
  }
  std::vector<WeightedNode> result;
  double sum = 0.0;
  for (const auto& [node, weight] : weights) sum += weight;
  sum = ranks.sum(sum);
  for (const auto& [node, weight] : weights) result.push_back({node, weight / sum});
  return result;
}

class GroupSensor final : public Sensor {
 public:
  GroupSensor(std::string name, const Body& body, std::vector<WeightedNode> nodes,
              std::optional<std::vector<Index>> cells, const Ranks& ranks)
      : name_(std::move(name)),
        dimension_(body.mesh->dimension),
        nodes_(std::move(nodes)),
        is_of_cells_(cells.has_value()),
        cells_(std::move(cells).value_or(std::vector<Index>())),
        stress_of_(body) {
    if (!is_of_cells_) return;
    const Vector volumes = cell_volumes(body);
    double sum = 0.0;
    for (const Index cell : cells_) sum += volumes[cell];
    sum = ranks.sum(sum);
    for (const Index cell : cells_) cell_weights_.push_back(volumes[cell] / sum);
  }

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    const std::array<Column, 3> statistics{
        {{"_average"}, {"_minimum", Reduction::minimum}, {"_maximum", Reduction::maximum}}};
    for (const char* motion : {".displacement", ".velocity"}) {
      for (const Column& statistic : statistics)
        add_vector_columns(columns, name_ + motion + statistic.name, dimension_, statistic.by);
    }
    if (is_of_cells_) {
      for (const Column& statistic : statistics)
        columns.emplace_back(name_ + ".von_mises" + statistic.name, statistic.by);
    }
    return columns;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    observe_vector(observation.state.displacement, row);
    observe_vector(observation.state.velocity, row);
    if (is_of_cells_) observe_stress(observation.state, row);
  }

 private:
  void observe_vector(const Vector& values, std::vector<double>& row) const {
    const Index d = dimension_;
    SpaceVector average = SpaceVector::Zero(d);
    SpaceVector least = SpaceVector::Constant(d, std::numeric_limits<double>::infinity());
    SpaceVector largest = -least;
    for (const auto& [node, weight] : nodes_) {
      const auto own = values.segment(node * d, d);
      average += weight * own;
      least = least.cwiseMin(own);
      largest = largest.cwiseMax(own);
    }
    append(average, row);
    append(least, row);
    append(largest, row);
  }
  void observe_stress(const State& state, std::vector<double>& row) {
    if (!cells_.empty()) stress_of_.evaluate(state.displacement, stress_, energy_density_, state.internal_strain);
    double average = 0.0, least = std::numeric_limits<double>::infinity(), largest = 0.0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const double own = von_mises_stress(stress_.data() + tensor_components * cells_[i]);
      average += cell_weights_[i] * own;
      least = std::min(least, own);
      largest = std::max(largest, own);
    }
    for (const double value : {average, least, largest}) row.push_back(value);
  }

  std::string name_;
  int dimension_;
  std::vector<WeightedNode> nodes_;  ///< weights sum to 1
  bool is_of_cells_;                 ///< otherwise of facets
  std::vector<Index> cells_;         ///< those on this rank, for a group of cells
  std::vector<double> cell_weights_, stress_, energy_density_;
  CellStress stress_of_;
};

template <int d>
std::vector<WeightedNode> nodes_of_cells(const Body& body, const std::vector<Index>& cells, const Ranks& ranks) {
  return weighted_nodes(body, body.mesh->cells, body.space->cells, cells, ranks,
                        [&](const Index* nodes, const Matrix& gradients) {
                          return std::abs(jacobian<d>(body.mesh->nodes, nodes, gradients).determinant());
                        });
}

template <int d>
std::vector<WeightedNode> nodes_of_facets(const Body& body, const std::vector<Index>& facets, const Ranks& ranks) {
  return weighted_nodes(body, body.mesh->facets, body.space->facets, facets, ranks,
                        [&](const Index* nodes, const Matrix& gradients) {
                          return facet_measure<d>(jacobian<d, d - 1>(body.mesh->nodes, nodes, gradients));
                        });
}

}  // namespace

std::unique_ptr<Sensor> make_cell_group_sensor(const std::string& name, const Body& body,
                                               const std::vector<Index>& cells, const Ranks& ranks) {
  auto nodes =
      body.mesh->dimension == 2 ? nodes_of_cells<2>(body, cells, ranks) : nodes_of_cells<3>(body, cells, ranks);
  return std::make_unique<GroupSensor>(name, body, std::move(nodes), cells, ranks);
}

std::unique_ptr<Sensor> make_facet_group_sensor(const std::string& name, const Body& body,
                                                const std::vector<Index>& facets, const Ranks& ranks) {
  auto nodes =
      body.mesh->dimension == 2 ? nodes_of_facets<2>(body, facets, ranks) : nodes_of_facets<3>(body, facets, ranks);
  return std::make_unique<GroupSensor>(name, body, std::move(nodes), std::nullopt, ranks);
}

}  // namespace ricochet
