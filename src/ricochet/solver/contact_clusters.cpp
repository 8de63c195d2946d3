#include "ricochet/solver/contact_clusters.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace ricochet {

namespace {

/// Points that must stay together: their places in the list, and where they are.
struct Bundle {
  std::vector<std::size_t> members;
  SpaceVector centre;
};

/// Bundles of points that see a node in common, in the order of their first points.
std::vector<Bundle> bundle_points(const SemidiscreteProblem& problem, const std::vector<Index>& points) {
  std::vector<std::size_t> leader(points.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t member) {
    while (leader[member] != member) member = leader[member] = leader[leader[member]];
    return member;
  };
  const auto join = [&](std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    leader[std::max(a, b)] = std::min(a, b);
  };
  std::map<Index, std::size_t> first_at;
  std::size_t first_that_slides = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    problem.contact.visit_nodes(points[i],
                                [&](Index node, double) { join(i, first_at.try_emplace(node, i).first->second); });
    if (!problem.contact.slides(points[i])) continue;
    if (first_that_slides == points.size()) first_that_slides = i;
    join(i, first_that_slides);
  }
  std::vector<Bundle> bundles;
  std::vector<std::size_t> bundle_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (find(i) == i) {
      bundle_of[i] = bundles.size();
      bundles.push_back({{}, problem.nodes.col(problem.contact.first_own_node(points[i]))});
    }
    bundles[bundle_of[find(i)]].members.push_back(i);
  }
  return bundles;
}

void bisect(const SemidiscreteProblem& problem, const std::vector<Index>& points, std::vector<Bundle>::iterator begin,
            std::vector<Bundle>::iterator end, std::size_t most, std::vector<std::vector<Index>>& clusters) {
  std::size_t count = 0;
  for (auto bundle = begin; bundle != end; ++bundle) count += bundle->members.size();
  if (count <= most || end - begin == 1) {
    std::vector<std::size_t> members;
    for (auto bundle = begin; bundle != end; ++bundle)
      members.insert(members.end(), bundle->members.begin(), bundle->members.end());
    std::sort(members.begin(), members.end());
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
  bisect(problem, points, begin, middle, most, clusters);
  bisect(problem, points, middle, end, most, clusters);
}

}  // namespace

std::vector<std::vector<Index>> cluster_points(const SemidiscreteProblem& problem, const std::vector<Index>& points,
                                               std::size_t most) {
  std::vector<std::vector<Index>> clusters;
  if (points.size() <= most) {
    if (!points.empty()) clusters.push_back(points);
    return clusters;
  }
  std::vector<Bundle> bundles = bundle_points(problem, points);
  bisect(problem, points, bundles.begin(), bundles.end(), most, clusters);
  return clusters;
}

}  // namespace ricochet
