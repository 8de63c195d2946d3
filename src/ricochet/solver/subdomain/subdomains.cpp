#include "ricochet/solver/subdomain/subdomains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"
#include "ricochet/solver/subdomain/contact_clusters.hpp"

namespace ricochet {

namespace {

/// Contact points of the smallest clusters that are tried: smaller ones save no work.
constexpr std::size_t min_cluster_size = 256;
/// Entries of the contact problems, which are dense. With many layers and few points, clusters have nearly the same
/// points around them, and a single subdomain is cheaper.
double dense_work(const std::vector<Subdomain::Extent>& extents) {
  double sum = 0.0;
  for (const Subdomain::Extent& extent : extents) sum += double(extent.points.size()) * double(extent.points.size());
  return sum;
}

std::vector<int> solved_dofs_of(const std::vector<Index>& nodes, const std::vector<char>& solved, int d) {
  std::vector<int> dofs;
  for (const Index node : nodes) {
    for (Index dof = node * d; dof < (node + 1) * d; ++dof) {
      if (solved[std::size_t(dof)] != 0) dofs.push_back(int(dof));
    }
  }
  return dofs;
}

/// Analyses A on the dofs of the subdomain that are solved for.
SparseCholesky analyse_subdomain(const std::vector<Index>& nodes, const std::vector<char>& solved, int d,
                                 const StageProduct& product) {
  std::vector<int> number(nodes.size() * std::size_t(d), -1);
  int count = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    const Index dof = nodes[i / std::size_t(d)] * d + Index(i) % d;
    if (solved[std::size_t(dof)] != 0) number[i] = count++;
  }
  SparseCholesky factor;
  factor.analyse(extract(product.principal(nodes), number, count, number, count));
  return factor;
}

}  // namespace

Subdomain::Subdomain(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                     const std::vector<char>& solved, const Extent& extent, const StageProduct& product,
                     SharedContact& shared, FactoredStage* condensed_stage)
    : has_(std::size_t(problem.contact.size()), 0), own_points_(extent.own_points) {
  for (const Index point : extent.points) has_[std::size_t(point)] = 1;
  own_dofs_ = solved_dofs_of(extent.own_nodes, solved, problem.dimension);
  // A principal block of a positive definite matrix is positive definite; if A is not, conjugate gradients report it,
  // too.
  stage_ = std::make_unique<FactoredStage>(
      problem, coefficients, solved_dofs_of(extent.nodes, solved, problem.dimension),
      analyse_subdomain(extent.nodes, solved, problem.dimension, product), shared, condensed_stage);
}

void Subdomain::choose_points(const std::vector<char>& eligible, std::vector<char>& own) const {
  for (std::size_t i = 0; i < has_.size(); ++i) own[i] = has_[i] != 0 ? eligible[i] : char{0};
}

void Subdomain::solve(const LinearStage& stage, const Vector& residual, Vector& correction, Vector& x,
                      StageSolution& solution) {
  stage_->solve(stage, residual, solution, correction);
  for (const int dof : own_dofs_) x[dof] += correction[dof];
  for (const int dof : stage_->dofs()) correction[dof] = 0.0;
}

void Subdomain::restrict_to_own(const StageSolution& local, StageSolution& solution) const {
  const Index tangents = solution.tangential_reaction.size() / std::max<Index>(1, solution.normal_reaction.size());
  for (const Index point : own_points_) {
    solution.normal_reaction[point] = local.normal_reaction[point];
    solution.tangential_reaction.segment(point * tangents, tangents) =
        local.tangential_reaction.segment(point * tangents, tangents);
    solution.contact_status[std::size_t(point)] = local.contact_status[std::size_t(point)];
  }
}

Subdomains::Subdomains(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                       const std::vector<char>& solved, const StageProduct& product,
                       ContactNeighbourhood& neighbourhood, SharedContact& shared, FactoredStage* condensed_stage)
    : problem_(problem),
      coefficients_(coefficients),
      solved_(solved),
      product_(product),
      neighbourhood_(neighbourhood),
      shared_(shared),
      condensed_stage_(condensed_stage) {
  correction_.setZero(problem.dof_count());
  if (condensed_stage != nullptr)
    massless_nodes_ = std::make_unique<MasslessContactNodes>(problem, coefficients, *condensed_stage);
}

/// Returns clusters of at most so many points with the layers around them, as subdomains.
std::vector<Subdomain::Extent> Subdomains::subdomains_of(const std::vector<Index>& points, std::size_t max_points) {
  std::vector<Subdomain::Extent> extents;
  struct Owner {
    std::size_t subdomain;
    int distance;
  };
  std::unordered_map<Index, Owner> owners;
  for (std::vector<Index>& cluster : cluster_points(problem_, points, max_points)) {
    const NodeDistances reached = nodes_within(neighbourhood_.graph(), neighbourhood_.nodes_of(cluster), layers_);
    for (std::size_t i = 0; i < reached.nodes.size(); ++i) {
      Owner& owner = owners.try_emplace(reached.nodes[i], Owner{extents.size(), reached.distance[i]}).first->second;
      if (reached.distance[i] < owner.distance) owner = {extents.size(), reached.distance[i]};
    }
    extents.push_back({.nodes = reached.ascending(), .own_nodes = {}, .points = {}, .own_points = std::move(cluster)});
  }
  for (std::size_t number = 0; number < extents.size(); ++number) {
    Subdomain::Extent& extent = extents[number];
    for (const Index node : extent.nodes) {
      if (owners.at(node).subdomain == number) extent.own_nodes.push_back(node);
    }
    for (const Index point : points) {
      bool inside = true;
      problem_.contact.visit_nodes(
          point, [&](Index node, double) { inside = inside && std::ranges::binary_search(extent.nodes, node); });
      if (inside) extent.points.push_back(point);
    }
  }
  return extents;
}

std::size_t Subdomains::partition(const std::vector<Index>& points) {
  clear();
  if (layers_ == 0) layers_ = neighbourhood_.layers_to_solve(points, coefficients_, product_);
  nodes_ = neighbourhood_.nodes_around(points, layers_);
  // With massless contact nodes the motion of a contact node depends on all reactions near it.
  extents_ = subdomains_of(points, points.size());
  if (condensed_stage_ == nullptr) {
    for (std::size_t max_points = min_cluster_size; max_points < points.size(); max_points *= 2) {
      std::vector<Subdomain::Extent> others = subdomains_of(points, max_points);
      if (dense_work(others) < dense_work(extents_)) extents_ = std::move(others);
    }
  }
  is_one_ = extents_.size() == 1;
  return extents_.size();
}

void Subdomains::make_share(std::size_t number, std::size_t count) {
  for (std::size_t i = number; i < extents_.size(); i += count)
    subdomains_.push_back(std::make_unique<Subdomain>(problem_, coefficients_, solved_, extents_[i], product_, shared_,
                                                      condensed_stage_));
  extents_.clear();
}

/// Solves the stage on the correction: q and p at x instead of at δ = 0. All subdomains start from the same residual.
void Subdomains::solve(const LinearStage& stage, const Vector& residual, Vector& x, StageSolution& solution) {
  supports_at_rest_.prescribed.setZero(stage.right_hand_side.prescribed.size());
  conditions_ = stage.conditions;
  stage.rows.normal_motion(x, motion_);
  conditions_.gap.offset += stage.conditions.gap.factor * motion_;
  if (stage.conditions.slip.offset.size() > 0) {
    stage.rows.tangential_motion(x, slip_);
    conditions_.slip.offset += stage.conditions.slip.factor * slip_;
  }
  const LinearStage on_correction{stage.rows, supports_at_rest_, conditions_, stage.start};
  if (is_one_) {
    subdomains_.front()->choose_points(stage.conditions.eligible, conditions_.eligible);
    subdomains_.front()->solve(on_correction, residual, correction_, x, solution);
    return;
  }
  for (const auto& subdomain : subdomains_) {
    solution_.iterations = 0;
    subdomain->choose_points(stage.conditions.eligible, conditions_.eligible);
    subdomain->solve(on_correction, residual, correction_, x, solution_);
    subdomain->restrict_to_own(solution_, solution);
    solution.iterations += solution_.iterations;
  }
}

void Subdomains::persist(const SnapshotVisitor& visit, const std::vector<Index>& points) {
  visit("layers", layers_, {1, ContactNeighbourhood::max_layers});
  if (visit.loads()) make(points);
  persist_made(visit);
}

void Subdomains::persist_made(const SnapshotVisitor& visit) {
  for (std::size_t i = 0; i < subdomains_.size(); ++i) subdomains_[i]->persist(visit.part(i));
}

void Subdomains::report() const {
  for (const auto& subdomain : subdomains_) subdomain->report();
}

}  // namespace ricochet
