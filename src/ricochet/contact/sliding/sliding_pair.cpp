#include "ricochet/contact/sliding/sliding_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "ricochet/base/log.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/contact/mortar/pair_integration.hpp"
#include "ricochet/contact/sliding/moving_surfaces.hpp"
#include "ricochet/contact/sliding/rim_distance.hpp"

namespace ricochet {

namespace {

/// Cover below which a point faces nothing.
constexpr double least_cover = 1e-9;

/// Entry of a node, created if there is none.
template <class Value>
Value& entry_of(std::vector<std::pair<Index, Value>>& entries, Index node, const Value& nothing) {
  for (auto& [entry, value] : entries) {
    if (entry == node) return value;
  }
  return entries.emplace_back(node, nothing).second;
}

template <class Value>
void sort_by_node(std::vector<std::pair<Index, Value>>& entries) {
  std::ranges::sort(entries, [](const auto& one, const auto& other) { return one.first < other.first; });
}

/// n·ν from which a point counts fully, and up to which it is ignored.
constexpr double full_weight_cosine = 0.7, zero_weight_cosine = 0.15;

/// Projection onto a point of the opposite surface.
struct Sight {
  SlidingVector normal;  ///< along ν, with n·normal = 1
  double part;           ///< weight, which vanishes gradually for points that are seen nearly edge-on and may disappear
};
Sight sight_of(const PolynomialMap<3>::Evaluation& at, bool plane, const SlidingVector& n) {
  const auto& [along, across] = at.slopes;
  const SlidingVector normal = plane ? SlidingVector(along[1], -along[0], 0.0) : SlidingVector(along.cross(across));
  const double product = n.dot(normal);
  const double well = std::clamp(
      (std::abs(product) / normal.norm() - zero_weight_cosine) / (full_weight_cosine - zero_weight_cosine), 0.0, 1.0);
  return {normal / product, well * well * (3.0 - 2.0 * well)};
}

}  // namespace

struct SlidingPair::Implementation {
  /// Sums of one point.
  struct Sums {
    double weight = 0.0, cover = 0.0, gap = 0.0;
    SlidingVector force = SlidingVector::Zero();     ///< ∫ψ ν/(n·ν)
    SlidingVector pull = SlidingVector::Zero();      ///< ∫ψ h ν/(n·ν) over the current own facet
    SlidingVector rim_pull = SlidingVector::Zero();  ///< ∫ψ h k over it, k of rim_direction()
  };

  Data data;
  ContactPatch patch;
  std::unique_ptr<MultiplierSpace> space;
  bool plane;
  bool is_self;
  mutable MovingSurfaces surfaces;
  RimDistance rim;  ///< of the opposite surface
  double least_height = std::numeric_limits<double>::infinity();
  double detection_depth = least_height;  ///< see SlidingPair::detection_depth()
  /// Per own facet, in the order of the space's anchors there: number of the point, or −1.
  std::vector<std::vector<int>> points_of;
  std::vector<double> sizes;            ///< per point: the largest facet of its support, L
  std::vector<RotatingNormal> normals;  ///< per own facet, into its body
  // State of the current evaluation.
  mutable Vector evaluated_displacement;
  mutable std::vector<Sums> sums;
  mutable std::vector<SlidingVector> current_normals;  ///< N of each own facet
  mutable std::vector<char> included;                  ///< per anchor of the current own facet
  mutable FacetPoints points;
  mutable FacetMultipliers functions;
  mutable Matrix shapes, weighted;
  mutable long projection_count = 0;

  explicit Implementation(Data of_data)
      : data(std::move(of_data)),
        patch{&data.body, {{0, data.facets}}},
        space(make_multiplier_space(data.multipliers, patch)),
        plane(data.body.space->dimension == 2),
        is_self(data.is_self()),
        surfaces(data.body, data.facets, data.opposite_facets),
        rim(*data.body.space, surfaces.opposite()) {
    for (const FacetSurface* const surface : {&surfaces.own(), &surfaces.opposite()}) {
      for (const FacetSurface::Facet& facet : surface->facets())
        least_height = std::min(least_height, facet.cell_height);
    }
    if (is_self) surfaces.enable_self_contact();
    for (const FacetSurface::Facet& facet : surfaces.own().facets())
      detection_depth = std::min(detection_depth, deepest_overlap * facet.body_depth);
    find_points_of_facets();
    for (const FacetSurface::Facet& facet : surfaces.own().facets()) {
      const Vector direction = -facet.area_vector.normalized().head(data.body.space->dimension);
      normals.emplace_back(*data.body.space, std::vector{facet.number}, direction);
    }
    sums.resize(data.points.size());
    current_normals.resize(normals.size());
  }

  void find_points_of_facets() {
    std::map<Index, int> by_anchor;
    for (std::size_t i = 0; i < data.points.size(); ++i) {
      const Multiplier& multiplier = data.points[i].multiplier;
      by_anchor[multiplier.node >= 0 ? multiplier.node : multiplier.facet] = int(i);
    }
    sizes.assign(data.points.size(), 0.0);
    const FacetIntegration whole(data.body);
    FacetQuadrature quadrature;
    for (const FacetSurface::Facet& facet : surfaces.own().facets()) {
      whole.evaluate(facet.number, quadrature);
      space->evaluate(quadrature, functions);
      std::vector<int>& here = points_of.emplace_back();
      for (const Index anchor : functions.anchors) {
        const auto found = by_anchor.find(anchor);
        here.push_back(found != by_anchor.end() ? found->second : -1);
        if (here.back() >= 0) sizes[std::size_t(here.back())] = std::max(sizes[std::size_t(here.back())], facet.size);
      }
    }
  }

  void integrate_from(int facet, Content content, const std::vector<char>& left_out, const std::vector<char>& any_depth,
                      std::vector<SlidingView>& views) const;
  void integrate(int facet, const FacetSegments& segments, const SlidingVector& n, Content content,
                 std::vector<SlidingView>& views) const;
  void add_normal_derivative(int facet, const SlidingVector& n, std::vector<SlidingView>& views) const;
  void add_traces(const Index* opposite_nodes, Index own, Index opposite, double weight, SlidingView& view) const;
  void add_row(const Index* opposite_nodes, Index own, Index opposite, const SlidingVector& force,
               SlidingView::Vectors& row) const;
  void finish(std::size_t point, Content content, SlidingView& view) const;
};

/// Integrates once for the points that do not admit deep overlaps, and once for those that do.
void SlidingPair::Implementation::integrate_from(int facet, Content content, const std::vector<char>& left_out,
                                                 const std::vector<char>& any_depth,
                                                 std::vector<SlidingView>& views) const {
  const std::vector<int>& here = points_of[std::size_t(facet)];
  for (const bool deep : {false, true}) {
    included.assign(here.size(), 0);
    for (std::size_t k = 0; k < here.size(); ++k) {
      if (here[k] < 0) continue;
      const auto point = std::size_t(here[k]);
      const bool is_out = !left_out.empty() && left_out[point] != 0;
      const bool admits_depth = !is_self && !any_depth.empty() && any_depth[point] != 0;
      included[k] = !is_out && admits_depth == deep ? 1 : 0;
    }
    if (std::ranges::find(included, 1) == included.end()) continue;
    const SlidingVector n = current_normals[std::size_t(facet)].normalized();
    const FacetSegments segments = surfaces.finder().find(facet, n, deep);
    if (!segments.segments.empty()) integrate(facet, segments, n, content, views);
  }
}

void SlidingPair::Implementation::integrate(int facet, const FacetSegments& segments, const SlidingVector& n,
                                            Content content, std::vector<SlidingView>& views) const {
  const std::vector<int>& here = points_of[std::size_t(facet)];
  const Index number = surfaces.own().facets()[std::size_t(facet)].number, d = plane ? 2 : 3;
  gather_points(surfaces.map(), number, segments, points);
  const FacetQuadrature& at = points.quadrature;
  space->evaluate(at, functions);
  weighted = functions.values * at.measure.asDiagonal();
  surfaces.scale_to_reference(number, points.local, weighted);
  Index begin = 0;
  for (const SurfaceSegment& segment : segments.segments) {
    const PolynomialMap<3> map = surfaces.map().map_of(segment.opposite);
    std::optional<PolynomialMap<3>> reference;
    if (rim.is_near(segment.opposite)) reference.emplace(surfaces.reference_map().map_of(segment.opposite));
    surfaces.map().displacement(segment.opposite, segment.opposite_local, shapes);
    const IndexInBlocks location = locate_facet(*data.body.space, segment.opposite);
    const Index* const nodes = data.body.space->facets[location.block].cell(location.local);
    for (Index q = 0; q < segment.weights.size(); ++q) {
      const double* const local = segment.opposite_local.col(q).data();
      const PolynomialMap<3>::Evaluation projection = map.evaluate(local);
      const auto [normal, sight_weight] = sight_of(projection, plane, n);
      if (sight_weight == 0.0) continue;
      RimDistance::Value to_rim;
      if (reference) to_rim = rim.evaluate(segment.opposite, reference->evaluate(local));
      const SlidingVector along_rim =
          to_rim.rises() ? rim_direction(projection, plane, n, to_rim) : SlidingVector(SlidingVector::Zero());
      const double gap = n.head(d).dot(at.positions.col(begin + q) - projection.at.head(d));
      for (std::size_t k = 0; k < here.size(); ++k) {
        if (included[k] == 0) continue;
        const auto point = std::size_t(here[k]);
        const double weight = sight_weight * weighted(Index(k), begin + q);
        Sums& sum = sums[point];
        sum.weight += weight;
        sum.cover += weight * to_rim.distance;
        sum.gap += weight * gap;
        sum.force += weight * normal;
        if (content == Content::gap) continue;
        SlidingView& view = views[point];
        add_traces(nodes, begin + q, q, weight, view);
        add_row(nodes, begin + q, q, weight * normal, view.row);
        sum.pull += weight * gap * normal;
        if (!to_rim.rises()) continue;
        add_row(nodes, begin + q, q, weight * along_rim, view.rim);
        sum.rim_pull += weight * gap * along_rim;
      }
    }
    begin += segment.weights.size();
  }
  if (content == Content::row) add_normal_derivative(facet, n, views);
}

/// Adds the shape functions at points of the current own facet and of a segment, by their numbers there.
void SlidingPair::Implementation::add_traces(const Index* opposite_nodes, Index own, Index opposite, double weight,
                                             SlidingView& view) const {
  const FacetQuadrature& at = points.quadrature;
  for (Index j = 0; j < at.node_count(); ++j)
    entry_of(view.own, at.nodes[j], 0.0) += weight * (*at.displacement)(j, own);
  for (Index j = 0; j < shapes.rows(); ++j)
    entry_of(view.opposite, opposite_nodes[j], 0.0) += weight * shapes(j, opposite);
}

/// Adds a force that acts on the own facet there, and against it on the opposite one.
void SlidingPair::Implementation::add_row(const Index* opposite_nodes, Index own, Index opposite,
                                          const SlidingVector& force, SlidingView::Vectors& row) const {
  const FacetQuadrature& at = points.quadrature;
  const SlidingVector nothing = SlidingVector::Zero();
  for (Index j = 0; j < at.node_count(); ++j) entry_of(row, at.nodes[j], nothing) += (*at.displacement)(j, own) * force;
  for (Index j = 0; j < shapes.rows(); ++j) entry_of(row, opposite_nodes[j], nothing) -= shapes(j, opposite) * force;
}

/// Adds −(∂n/∂x)ᵀ ∫ψ h ν/(n·ν), and likewise for the rim.
void SlidingPair::Implementation::add_normal_derivative(int facet, const SlidingVector& n,
                                                        std::vector<SlidingView>& views) const {
  const std::vector<int>& here = points_of[std::size_t(facet)];
  const double length = current_normals[std::size_t(facet)].norm();
  const auto add = [&](SlidingVector& pull, SlidingView::Vectors& row) {
    const SlidingVector w = (n * n.dot(pull) - pull) / length;
    normals[std::size_t(facet)].visit_derivative(data.body.space->nodes, evaluated_displacement, w,
                                                 [&](Index node, const SlidingVector& value) {
                                                   entry_of<SlidingVector>(row, node, SlidingVector::Zero()) += value;
                                                 });
    pull.setZero();
  };
  for (std::size_t k = 0; k < here.size(); ++k) {
    if (included[k] == 0) continue;
    const auto point = std::size_t(here[k]);
    add(sums[point].pull, views[point].row);
    if (!views[point].rim.empty()) add(sums[point].rim_pull, views[point].rim);
  }
}

/// Converts integrals to means.
void SlidingPair::Implementation::finish(std::size_t point, Content content, SlidingView& view) const {
  const Sums& sum = sums[point];
  const Point& of = data.points[point];
  const double cover = sum.cover / of.multiplier.weight;
  view.faces = cover > least_cover;
  if (!view.faces) {
    view.own.clear();
    view.opposite.clear();
    view.row.clear();
    view.rim.clear();
    return;
  }
  const double scale = 1.0 / sum.force.norm();
  const RimAllowance allowance(cover);
  view.distance = sum.gap * scale + of.offset;
  view.gap = view.distance + sizes[point] * allowance.value;
  view.direction = scale * sum.force;
  if (content == Content::gap) return;
  for (auto& [node, value] : view.own) value /= sum.weight;
  for (auto& [node, value] : view.opposite) value /= sum.weight;
  for (auto& [node, value] : view.row) value *= scale;
  if (allowance.slope != 0.0) {
    const double factor = sizes[point] * allowance.slope / of.multiplier.weight;
    for (const auto& [node, value] : view.rim)
      entry_of<SlidingVector>(view.row, node, SlidingVector::Zero()) += factor * value;
  }
  sort_by_node(view.own);
  sort_by_node(view.opposite);
  sort_by_node(view.row);
}

SlidingPair::SlidingPair(Data data) : implementation_(std::make_unique<Implementation>(std::move(data))) {}

SlidingPair::~SlidingPair() = default;

const SlidingPair::Data& SlidingPair::data() const { return implementation_->data; }

bool SlidingPair::is_self() const { return implementation_->is_self; }

double SlidingPair::detection_depth() const { return implementation_->detection_depth; }

int SlidingPair::dimension() const { return implementation_->data.body.space->dimension; }

int SlidingPair::degree() const { return implementation_->data.body.space->degree; }

const std::vector<Index>& SlidingPair::nodes() const { return implementation_->surfaces.nodes(); }

double SlidingPair::height() const { return implementation_->least_height; }

SlidingVector SlidingPair::normal(std::size_t point, const Vector& displacement) const {
  return points()[point].normal.at(implementation_->data.body.space->nodes, displacement).normalized();
}

void SlidingPair::compute_views(const Vector& displacement, Content content, const std::vector<char>& left_out,
                                const std::vector<char>& any_depth, std::vector<SlidingView>& views) const {
  const Implementation& own = *implementation_;
  ++own.projection_count;
  own.surfaces.move(displacement);
  own.evaluated_displacement = displacement;
  for (std::size_t facet = 0; facet < own.normals.size(); ++facet)
    own.current_normals[facet] = own.normals[facet].at(own.data.body.space->nodes, displacement);
  views.resize(points().size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    own.sums[i] = {};
    SlidingView& view = views[i];
    view.faces = false;
    view.gap = view.distance = 0.0;
    view.own.clear();
    view.opposite.clear();
    view.row.clear();
    view.rim.clear();
  }
  for (std::size_t facet = 0; facet < own.points_of.size(); ++facet)
    own.integrate_from(int(facet), content, left_out, any_depth, views);
  for (std::size_t i = 0; i < views.size(); ++i) own.finish(i, content, views[i]);
}

long SlidingPair::projection_count() const { return implementation_->projection_count; }

double SlidingPair::node_gap(Index node, const SlidingVector& direction, const Vector& displacement) const {
  const Implementation& own = *implementation_;
  own.surfaces.move(displacement);
  const double reach = deepest_overlap * own.surfaces.depth_at(node);
  const SegmentFinder::Hit hit = own.surfaces.finder().find_point(
      own.surfaces.position(node), direction, reach, SegmentFinder::on_rim, own.surfaces.ignored_facets_of(node));
  return hit.facet >= 0 ? hit.gap : std::numeric_limits<double>::quiet_NaN();
}

double largest_motion(const SlidingPair& pair, const Vector& to, const Vector& from) {
  const Index d = pair.dimension();
  const auto way = [&](Index node) -> SpaceVector { return to.segment(node * d, d) - from.segment(node * d, d); };
  SpaceVector mean = SpaceVector::Zero(d);
  if (pair.is_self()) {
    for (const Index node : pair.nodes()) mean += way(node);
    mean /= double(pair.nodes().size());
  }
  double longest = 0.0;
  for (const Index node : pair.nodes()) longest = std::max(longest, (way(node) - mean).norm());
  return longest;
}

bool warn_of_undetected_contact(const SlidingPair& pair, const Vector& to, const Vector& from) {
  if (!pair.is_self()) return false;
  const double longest = largest_motion(pair, to, from);
  if (2.0 * longest <= pair.detection_depth()) return false;
  log::warning(
      fmt::format("a surface that may touch itself moves in one step by up to {:.3g} to either side of its mean "
                  "motion, but detects contact with itself only up to a depth of {:.3g}: its parts may pass through "
                  "each other undetected; use a time.step that is {:.2g} times smaller",
                  longest, pair.detection_depth(), rounded_up(2.0 * longest / pair.detection_depth(), 2)));
  return true;
}

}  // namespace ricochet
