#include "ricochet/contact/contact_stress.hpp"

#include <algorithm>
#include <map>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/fem/element_matrices.hpp"
#include "ricochet/fem/exterior_facets.hpp"
#include "ricochet/fem/facet_integration.hpp"

namespace ricochet {

namespace {

/// For a block of cells: the rule of the stiffness, and the shape functions at the nodes of the displacement.
struct BlockRules {
  BlockIntegration stiffness;
  Tabulation geometry, displacement;

  BlockRules(CellShape shape, int geometry_degree, int displacement_degree, bool axisymmetric)
      : stiffness(stiffness_integration(shape, geometry_degree, displacement_degree, axisymmetric)) {
    const ReferenceElement& element = ReferenceElement::get(shape, displacement_degree);
    geometry = ReferenceElement::get(shape, geometry_degree).tabulate(element.nodes());
    displacement = element.tabulate(element.nodes());
  }
};

/// Facet of the contact boundary: the cell behind it, and its area.
struct FacetData {
  Index cell = 0;
  double area = 0.0;
};

/// Contribution to a point of the stress vector at a node of a facet: s_i = Σ share · (row · u).
struct Share {
  Index point = 0;
  double share = 0.0;
  Vector row;  ///< D_i n_i·σN, per dof of the cell
};

template <int d>
class StressRows {
 public:
  StressRows(const Body& body, const ContactBoundary& boundary) : body_(body), boundary_(boundary) {
    for (const CellBlock& block : body.mesh->cells)
      cells_.emplace_back(block.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body));
    for (const CellBlock& block : body.mesh->facets) {
      const Points& nodes = ReferenceElement::get(block.shape, body.space->degree).nodes();
      facet_maps_.push_back(ReferenceElement::get(block.shape, body.mesh->degree).tabulate(nodes));
    }
    const std::vector<std::vector<Index>> cells = cells_of_facets(*body.mesh, boundary.facets);
    const FacetIntegration integration(body);
    FacetQuadrature quadrature;
    for (std::size_t k = 0; k < boundary.facets.size(); ++k) {
      integration.evaluate(boundary.facets[k], quadrature);
      facets_.push_back({cells[k].front(), quadrature.measure.sum()});
      for (Index a = 0; a < quadrature.node_count(); ++a) area_[quadrature.nodes[a]] += facets_.back().area;
    }
    for (Index i = 0; i < boundary.size(); ++i)
      boundary.visit_own_nodes(i, [&](Index node, double c) { points_[node].emplace_back(i, c); });
  }

  ContactStress make() {
    std::map<Index, std::vector<Share>> of_cells;
    for (std::size_t k = 0; k < facets_.size(); ++k) add_facet(k, of_cells[facets_[k].cell]);
    ContactStress result;
    Vector shares = Vector::Zero(boundary_.size());
    result.stiffness.setZero(boundary_.size());
    std::vector<Eigen::Triplet<double>> entries;
    const auto enter = [&](Index point, Index node, Index component, double value) {
      if (body_.tied == nullptr || !body_.tied->is_tied(node)) {
        entries.emplace_back(point, node * d + component, value);
        return;
      }
      for (const auto& [other, weight] : body_.tied->spread({{node, value}}))
        entries.emplace_back(point, other * d + component, weight);
    };
    for (const auto& [cell, all] : of_cells) {
      const IndexInBlocks location = locate_cell(*body_.space, cell);
      const Index* nodes = body_.space->cells[location.block].cell(location.local);
      const double largest = largest_of_cell(location, cell, all);
      for (const Share& each : all) {
        shares[each.point] += std::abs(each.share);
        result.stiffness[each.point] = std::max(result.stiffness[each.point], largest);
        for (Index b = 0; b < each.row.size(); ++b) enter(each.point, nodes[b / d], b % d, each.share * each.row[b]);
      }
    }
    result.stiffness.array() *= shares.array();
    result.rows.resize(boundary_.size(), body_.space->dof_count());
    result.rows.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

 private:
  using Space = Eigen::Matrix<double, d, 1>;

  void add_facet(std::size_t k, std::vector<Share>& shares) {
    const IndexInBlocks at = locate_facet(*body_.space, boundary_.facets[k]);
    const IndexInBlocks in = locate_cell(*body_.space, facets_[k].cell);
    const CellBlock& facets = body_.space->facets[at.block];
    const CellBlock& cells = body_.space->cells[in.block];
    const Index *nodes = facets.cell(at.local), *corners = cells.cell(in.local);
    const IsotropicElasticity law = linear_law(body_, material_of(body_, facets_[k].cell));
    for (Index a = 0; a < facets.nodes_per_cell; ++a) {
      const auto points = points_.find(nodes[a]);
      if (points == points_.end()) continue;
      const Index own = std::find(corners, corners + cells.nodes_per_cell, nodes[a]) - corners;
      const Eigen::Matrix<double, Eigen::Dynamic, d> gradients = gradients_at(in, own);
      const Space outward = normal_at(at, a, in);
      for (const auto& [point, c] : points->second) {
        Share share{point, c * facets_[k].area / area_.at(nodes[a]), Vector(gradients.rows() * d)};
        const Space n = boundary_.rows->normals.col(point);
        for (Index b = 0; b < gradients.rows(); ++b) {
          const Space g = gradients.row(b);
          // n·σN of the displacement φ_b e, per component of e.
          share.row.template segment<d>(b * d) =
              boundary_.weights[point] *
              (law.lambda * n.dot(outward) * g + law.mu * (g.dot(outward) * n + n.dot(g) * outward));
        }
        if (is_axisymmetric(body_))
          add_hoop(nodes[a], own, boundary_.weights[point] * law.lambda * n.dot(outward), gradients, share.row);
        shares.push_back(std::move(share));
      }
    }
  }

  /// Adds the contribution of the hoop strain u_x/x at a node, whose number in its cell is `own`: only φ of this node
  /// is not zero there. On the axis the strain is ∂u_x/∂x.
  void add_hoop(Index node, Index own, double factor, const Eigen::Matrix<double, Eigen::Dynamic, d>& gradients,
                Vector& row) const {
    if (!is_on_axis(body_, node)) {
      row[own * d] += factor / body_.space->nodes(0, node);
      return;
    }
    for (Index b = 0; b < gradients.rows(); ++b) row[b * d] += factor * gradients(b, 0);
  }

  /// Gradients of the shape functions of a cell, at one of its nodes.
  Eigen::Matrix<double, Eigen::Dynamic, d> gradients_at(const IndexInBlocks& in, Index node) const {
    const BlockRules& rules = cells_[in.block];
    const auto at = std::size_t(node);
    const Index* nodes = body_.mesh->cells[in.block].cell(in.local);
    return rules.displacement.gradients[at] *
           jacobian<d>(body_.mesh->nodes, nodes, rules.geometry.gradients[at]).inverse();
  }

  /// Normal of the facet `at` of the cell `in`, out of the cell, at a node of the facet.
  Space normal_at(const IndexInBlocks& at, Index node, const IndexInBlocks& in) const {
    const CellBlock& geometry = body_.mesh->facets[at.block];
    const auto along = jacobian<d, d - 1>(body_.mesh->nodes, geometry.cell(at.local),
                                          facet_maps_[at.block].gradients[std::size_t(node)]);
    Space normal;
    if constexpr (d == 2) {
      normal << along(1, 0), -along(0, 0);
    } else {
      const Space first = along.col(0), second = along.col(1);
      normal = first.cross(second);
    }
    normal.normalize();
    const CellBlock& cells = body_.mesh->cells[in.block];
    Space centre = Space::Zero(), here = Space::Zero();
    for (int v = 0; v < vertex_count(cells.shape); ++v)
      centre += body_.mesh->nodes.col(cells.cell(in.local)[v]) / vertex_count(cells.shape);
    for (int v = 0; v < vertex_count(geometry.shape); ++v)
      here += body_.mesh->nodes.col(geometry.cell(at.local)[v]) / vertex_count(geometry.shape);
    return normal.dot(here - centre) < 0.0 ? Space(-normal) : normal;
  }

  /// Largest Σ |share| s² over displacements of the cell with uᵀK_cell u = 1.
  double largest_of_cell(const IndexInBlocks& location, Index cell, const std::vector<Share>& all) const {
    if (all.empty()) return 0.0;
    const CellBlock& geometry = body_.mesh->cells[location.block];
    const BlockIntegration& integration = cells_[location.block].stiffness;
    const int count = int(integration.displacement.values.rows());
    std::vector<double> pairs(static_cast<std::size_t>(pair_number(0, count)) * d * d);
    element_stiffness<d>(integration, body_.mesh->nodes, geometry.cell(location.local),
                         linear_law(body_, material_of(body_, cell)), pairs.data());
    Matrix stiffness(count * d, count * d);
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i <= j; ++i) {
        const Eigen::Map<const Eigen::Matrix<double, d, d, Eigen::RowMajor>> block(pairs.data() +
                                                                                   pair_number(i, j) * d * d);
        stiffness.block<d, d>(i * d, j * d) = block;
        stiffness.block<d, d>(j * d, i * d) = block.transpose();
      }
    }
    Matrix rows(static_cast<Index>(all.size()), stiffness.cols());
    for (std::size_t k = 0; k < all.size(); ++k)
      rows.row(Index(k)) = std::sqrt(std::abs(all[k].share)) * all[k].row.transpose();
    // Uses the eigenvectors of K_cell except its rigid motions, which cause no stress.
    const SymmetricEigen eigen = symmetric_eigen(stiffness);
    const Index rigid = is_axisymmetric(body_) ? 1 : d * (d + 1) / 2, rest = stiffness.cols() - rigid;
    const Matrix scaled =
        rows * eigen.vectors.rightCols(rest) * eigen.values.tail(rest).cwiseSqrt().cwiseInverse().asDiagonal();
    const Vector values = symmetric_eigenvalues(Matrix(scaled * scaled.transpose()));
    return values[values.size() - 1];
  }

  const Body& body_;
  const ContactBoundary& boundary_;
  std::vector<BlockRules> cells_;       ///< per block of cells
  std::vector<Tabulation> facet_maps_;  ///< per block of facets: the geometry at the nodes of the displacement
  std::vector<FacetData> facets_;
  std::map<Index, double> area_;                                   ///< of the contact facets around a node
  std::map<Index, std::vector<std::pair<Index, double>>> points_;  ///< whose trace contains a node, with c
};

}  // namespace

ContactStress make_contact_stress(const Body& body, const ContactBoundary& boundary) {
  return boundary.dimension == 2 ? StressRows<2>(body, boundary).make() : StressRows<3>(body, boundary).make();
}

}  // namespace ricochet
