#include "ricochet/contact/sliding/sliding_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "ricochet/base/log.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/contact/mortar/pair_integration.hpp"
#include "ricochet/contact/sliding/moving_surfaces.hpp"

namespace ricochet {

namespace {

/// Fraction of a multiplier's whole area below which a point faces nothing.
constexpr double least_sliding_cover = 1e-3;

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
    double weight = 0.0, gap = 0.0;
    SlidingVector force = SlidingVector::Zero();  ///< ∫ψ ν/(n·ν)
    SlidingVector pull = SlidingVector::Zero();   ///< ∫ψ h ν/(n·ν) over the current own facet
  };

  Data data;
  ContactPatch patch;
  std::unique_ptr<MultiplierSpace> space;
  bool plane;
  bool is_self;
  mutable MovingSurfaces surfaces;
  double least_height = std::numeric_limits<double>::infinity();
  double detection_depth = least_height;  ///< see SlidingPair::detection_depth()
  /// Per own facet, in the order of the space's anchors there: number of the point, or −1.
  std::vector<std::vector<int>> points_of;
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
        surfaces(data.body, data.facets, data.opposite_facets) {
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
    const FacetIntegration whole(data.body);
    FacetQuadrature quadrature;
    for (const FacetSurface::Facet& facet : surfaces.own().facets()) {
      whole.evaluate(facet.number, quadrature);
      space->evaluate(quadrature, functions);
      std::vector<int>& here = points_of.emplace_back();
      for (const Index anchor : functions.anchors) {
        const auto found = by_anchor.find(anchor);
        here.push_back(found != by_anchor.end() ? found->second : -1);
      }
    }
  }

  void integrate_from(int facet, Content content, const std::vector<char>& left_out, const std::vector<char>& any_depth,
                      std::vector<SlidingView>& views) const;
  void integrate(int facet, const FacetSegments& segments, const SlidingVector& n, Content content,
                 std::vector<SlidingView>& views) const;
  void add_normal_derivative(int facet, const SlidingVector& n, std::vector<SlidingView>& views) const;
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
    surfaces.map().displacement(segment.opposite, segment.opposite_local, shapes);
    const IndexInBlocks location = locate_facet(*data.body.space, segment.opposite);
    const Index* const nodes = data.body.space->facets[location.block].cell(location.local);
    for (Index q = 0; q < segment.weights.size(); ++q) {
      const PolynomialMap<3>::Evaluation projection = map.evaluate(segment.opposite_local.col(q).data());
      const auto [normal, sight_weight] = sight_of(projection, plane, n);
      if (sight_weight == 0.0) continue;
      const double gap = n.head(d).dot(at.positions.col(begin + q) - projection.at.head(d));
      for (std::size_t k = 0; k < here.size(); ++k) {
        if (included[k] == 0) continue;
        const auto point = std::size_t(here[k]);
        const double weight = sight_weight * weighted(Index(k), begin + q);
        Sums& sum = sums[point];
        sum.weight += weight;
        sum.gap += weight * gap;
        sum.force += weight * normal;
        if (content == Content::gap) continue;
        sum.pull += weight * gap * normal;
        SlidingView& view = views[point];
        for (Index j = 0; j < at.node_count(); ++j) {
          const double part = weight * (*at.displacement)(j, begin + q);
          entry_of(view.own, at.nodes[j], 0.0) += part;
          entry_of<SlidingVector>(view.row, at.nodes[j], SlidingVector::Zero()) += part * normal;
        }
        for (Index j = 0; j < shapes.rows(); ++j) {
          const double part = weight * shapes(j, q);
          entry_of(view.opposite, nodes[j], 0.0) += part;
          entry_of<SlidingVector>(view.row, nodes[j], SlidingVector::Zero()) -= part * normal;
        }
      }
    }
    begin += segment.weights.size();
  }
  if (content == Content::row) add_normal_derivative(facet, n, views);
}

/// Adds −(∂n/∂x)ᵀ ∫ψ h ν/(n·ν).
void SlidingPair::Implementation::add_normal_derivative(int facet, const SlidingVector& n,
                                                        std::vector<SlidingView>& views) const {
  const std::vector<int>& here = points_of[std::size_t(facet)];
  const double length = current_normals[std::size_t(facet)].norm();
  for (std::size_t k = 0; k < here.size(); ++k) {
    if (included[k] == 0) continue;
    const auto point = std::size_t(here[k]);
    SlidingVector& pull = sums[point].pull;
    const SlidingVector w = (n * n.dot(pull) - pull) / length;
    normals[std::size_t(facet)].visit_derivative(
        data.body.space->nodes, evaluated_displacement, w, [&](Index node, const SlidingVector& value) {
          entry_of<SlidingVector>(views[point].row, node, SlidingVector::Zero()) += value;
        });
    pull.setZero();
  }
}

/// Converts integrals to means.
void SlidingPair::Implementation::finish(std::size_t point, Content content, SlidingView& view) const {
  const Sums& sum = sums[point];
  const Point& of = data.points[point];
  view.faces = sum.weight > least_sliding_cover * of.multiplier.weight;
  if (!view.faces) {
    view.own.clear();
    view.opposite.clear();
    view.row.clear();
    return;
  }
  const double scale = 1.0 / sum.force.norm();
  view.gap = sum.gap * scale + of.offset;
  view.direction = scale * sum.force;
  if (content == Content::gap) return;
  for (auto& [node, value] : view.own) value /= sum.weight;
  for (auto& [node, value] : view.opposite) value /= sum.weight;
  for (auto& [node, value] : view.row) value *= scale;
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
    view.gap = 0.0;
    view.own.clear();
    view.opposite.clear();
    view.row.clear();
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
