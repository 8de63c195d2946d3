#include <limits>
#include <map>
#include <optional>

#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/history/quantity_sensor.hpp"

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
        const double weight = integration.rule.weights[q] *
                              integration.ring(body.mesh->nodes, geometry[b].cell(local), q) *
                              measure(geometry[b].cell(local), integration.geometry.gradients[std::size_t(q)]);
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

/// Statistics of the components of a quantity over a group.
struct Statistics {
  SpaceVector average, least, largest;

  void start(Index components) {
    average = SpaceVector::Zero(components);
    least = SpaceVector::Constant(components, std::numeric_limits<double>::infinity());
    largest = -least;
  }
  template <class Values>
  void enter(double weight, const Values& own) {
    average += weight * own;
    least = least.cwiseMin(own);
    largest = largest.cwiseMax(own);
  }
};

class GroupSensor final : public QuantitySensor<GroupSensor> {
 public:
  GroupSensor(const std::string& name, const Body& body, std::vector<WeightedNode> nodes,
              std::optional<std::vector<Index>> cells, const Ranks& ranks)
      : QuantitySensor(name + ".", body.mesh->dimension),
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

  static const Quantities& quantities() {
    static const Quantities all = [] {
      Quantities result;
      add_statistics({"displacement", "length", "displacement", ColumnComponents::vector}, &GroupSensor::displacement_,
                     result);
      add_statistics({"velocity", "length/time", "velocity", ColumnComponents::vector}, &GroupSensor::velocity_,
                     result);
      add_statistics({"von_mises", "stress", "von Mises stress"}, &GroupSensor::von_mises_, result,
                     {"groups of cells", [](const GroupSensor& self) { return self.is_of_cells_; }});
      return result;
    }();
    return all;
  }

  void evaluate(const Observation& observation) {
    enter_nodes(observation.state.displacement, displacement_);
    enter_nodes(observation.state.velocity, velocity_);
    if (is_of_cells_) enter_stress(observation.state);
  }

 private:
  static void add_statistics(const RowQuantity& of, Statistics GroupSensor::*statistics, Quantities& result,
                             Condition<GroupSensor> condition = {}) {
    const auto add = [&](const char* name, const char* text, Reduction reduction, SpaceVector Statistics::*values) {
      auto& added = result.emplace_back(ValuedQuantity<GroupSensor>{
          of, [statistics, values](const GroupSensor& self, Index k) { return (self.*statistics.*values)[k]; },
          condition});
      added.name += name;
      added.reduction = reduction;
      added.text = text + of.text + " in the group";
    };
    add("_average", "mean, over volume or area, of the ", Reduction::sum, &Statistics::average);
    add("_minimum", "least value of the ", Reduction::minimum, &Statistics::least);
    add("_maximum", "largest value of the ", Reduction::maximum, &Statistics::largest);
  }

  void enter_nodes(const Vector& values, Statistics& statistics) const {
    statistics.start(dimension_);
    for (const auto& [node, weight] : nodes_) statistics.enter(weight, values.segment(node * dimension_, dimension_));
  }
  void enter_stress(const State& state) {
    if (!cells_.empty()) stress_of_.evaluate(state.displacement, stress_, energy_density_, state.internal_strain);
    von_mises_.start(1);
    for (std::size_t i = 0; i < cells_.size(); ++i)
      von_mises_.enter(cell_weights_[i],
                       SpaceVector::Constant(1, von_mises_stress(stress_.data() + tensor_components * cells_[i])));
  }

  int dimension_;
  std::vector<WeightedNode> nodes_;  ///< weights sum to 1
  bool is_of_cells_;                 ///< otherwise of facets
  std::vector<Index> cells_;         ///< those on this rank, for a group of cells
  std::vector<double> cell_weights_, stress_, energy_density_;
  CellStress stress_of_;
  Statistics displacement_, velocity_, von_mises_;
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

SensorList make_group_probe(const ProbeContext& probe, const ProbeTargets&) {
  const Mesh& mesh = *probe.body.mesh;
  const std::string& name = probe.values.text("group");
  const bool is_of_facets =
      mesh.find_group(name, mesh.dimension - 1) != nullptr && mesh.find_group(name, mesh.dimension) == nullptr;
  const Group& group = probe.group("group", is_of_facets ? mesh.dimension - 1 : mesh.dimension);
  const auto make = is_of_facets ? make_facet_group_sensor : make_cell_group_sensor;
  return {make(probe.name, probe.body, group.members, *probe.problem.ranks)};
}

}  // namespace

Registration<ProbeKind> group_probe() {
  return {.name = "group",
          .type = {.quantities = GroupSensor::descriptions(), .find = nullptr, .make = make_group_probe},
          .keys = {typed_key(
              "group", KeyType::groups, "", {},
              "Group of cells or of boundary facets, or a list of groups. Columns NAME.displacement_average_x …, "
              "_minimum_, _maximum_, the same for the velocity, and for cells von_mises_average, _minimum, "
              "_maximum. Averages are over volume or area.")},
          .alternatives = {{"group"}}};
}

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
