#include "ricochet/solver/subdomain/contact_clusters.hpp"

#include <algorithm>
#include <map>

#include "ricochet/mesh/disjoint_sets.hpp"

namespace ricochet {

namespace {

/// Points that must stay together: their indices in the list, and their position.
struct Bundle {
  std::vector<std::size_t> members;
  SpaceVector centre;
};

/// Bundles points with a common node, in the order of their first points.
std::vector<Bundle> bundle_points(const SemidiscreteProblem& problem, const std::vector<Index>& points) {
  DisjointSets together(static_cast<Index>(points.size()));
  std::map<Index, Index> first_at;
  Index first_that_slides = -1;
  for (Index i = 0; i < Index(points.size()); ++i) {
    const Index point = points[std::size_t(i)];
    problem.contact.visit_nodes(
        point, [&](Index node, double) { together.join(i, first_at.try_emplace(node, i).first->second); });
    if (!problem.contact.slides(point)) continue;
    if (first_that_slides < 0) first_that_slides = i;
    together.join(i, first_that_slides);
  }
  std::vector<Bundle> bundles;
  std::vector<std::size_t> bundle_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto root = std::size_t(together.root(Index(i)));
    if (root == i) {
      bundle_of[i] = bundles.size();
      bundles.push_back({{}, problem.nodes.col(problem.contact.first_own_node(points[i]))});
    }
    bundles[bundle_of[root]].members.push_back(i);
  }
  return bundles;
}

void bisect(const SemidiscreteProblem& problem, const std::vector<Index>& points, std::vector<Bundle>::iterator begin,
            std::vector<Bundle>::iterator end, std::size_t max_points, std::vector<std::vector<Index>>& clusters) {
  std::size_t count = 0;
  for (auto bundle = begin; bundle != end; ++bundle) count += bundle->members.size();
  if (count <= max_points || end - begin == 1) {
    std::vector<std::size_t> members;
    for (auto bundle = begin; bundle != end; ++bundle)
      members.insert(members.end(), bundle->members.begin(), bundle->members.end());
    std::ranges::sort(members);
    std::vector<Index>& cluster = clusters.emplace_back();
    for (const std::size_t member : members) cluster.push_back(points[member]);
    return;
  }
  SpaceVector low = begin->centre, high = begin->centre;
  for (auto bundle = begin; bundle != end; ++bundle) {
    low = low.cwiseMin(bundle->centre);
    high = high.cwiseMax(bundle->centre);
  }
  Index axis = 0;
  (high - low).head(problem.dimension).maxCoeff(&axis);
  std::stable_sort(begin, end, [axis](const Bundle& a, const Bundle& b) { return a.centre[axis] < b.centre[axis]; });
  std::size_t before = 0;
  auto middle = begin;
  while (middle + 1 < end && 2 * (before + middle->members.size()) <= count) before += (middle++)->members.size();
  if (middle == begin) ++middle;
  bisect(problem, points, begin, middle, max_points, clusters);
  bisect(problem, points, middle, end, max_points, clusters);
}

}  // namespace

std::vector<std::vector<Index>> cluster_points(const SemidiscreteProblem& problem, const std::vector<Index>& points,
                                               std::size_t max_points) {
  std::vector<std::vector<Index>> clusters;
  if (points.size() <= max_points) {
    if (!points.empty()) clusters.push_back(points);
    return clusters;
  }
  std::vector<Bundle> bundles = bundle_points(problem, points);
  bisect(problem, points, bundles.begin(), bundles.end(), max_points, clusters);
  return clusters;
}

}  // namespace ricochet
