#include "ricochet/solver/gathered/root_subdomains.hpp"

#include <algorithm>

#include "ricochet/solver/gathered/gathered_matrix.hpp"

namespace ricochet {

std::vector<Index> RootSubdomains::gather_points(const std::vector<Index>& points) const {
  const Ranks& ranks = *body_.problem.ranks;
  Ranks::ForEach<std::int64_t> sent(static_cast<std::size_t>(ranks.size()));
  sent[std::size_t(nodes_.root())].assign(points.begin(), points.end());
  const Ranks::ForEach<std::int64_t> received = ranks.exchange(std::move(sent));
  std::vector<Index> result;
  for (std::size_t rank = 0; rank < received.size(); ++rank) {
    for (const std::int64_t point : received[rank]) result.push_back(contact_.number(int(rank), point));
  }
  return result;
}

/// Gathers the graph of neighbouring nodes by the cells of all ranks.
MatrixGraph RootSubdomains::gather_graph(const std::vector<Index>& nodes) {
  const Ranks& ranks = *body_.problem.ranks;
  Ranks::ForEach<std::int64_t> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<std::int64_t>& message = sent[std::size_t(nodes_.root())];
  for (const Index node : nodes) {
    for (const int other : body_.neighbourhood.graph().neighbours(node)) {
      if (!std::ranges::binary_search(nodes, Index{other})) continue;
      message.push_back(ranks.number_of(node));
      message.push_back(ranks.number_of(other));
    }
  }
  const Ranks::ForEach<std::int64_t> received = ranks.exchange(std::move(sent));
  if (!contact_.is_root()) return {};
  std::vector<Eigen::Triplet<double>> entries;
  for (const std::vector<std::int64_t>& pairs : received) {
    for (std::size_t i = 0; i < pairs.size(); i += 2)
      entries.emplace_back(int(nodes_.index_of(pairs[i])), int(nodes_.index_of(pairs[i + 1])), 1.0);
  }
  SparseMatrix pattern(nodes_.count(), nodes_.count());
  pattern.setFromTriplets(entries.begin(), entries.end());
  return MatrixGraph(pattern, 1);
}

void RootSubdomains::gather_body(const std::vector<Index>& points, const RegionNodes& region) {
  clear();
  rows_.reset();
  const Ranks& ranks = *body_.problem.ranks;
  const int d = body_.problem.dimension;
  nodes_ = GatheredNodes(ranks, contact_.nodes().root(), region.nodes, &contact_.nodes());
  points_ = gather_points(points);
  root_problem_ = contact_.make_problem(nodes_);
  const std::vector<char>& is_solved = body_.solved;
  const Vector solved =
      nodes_.gather(Eigen::Map<const Eigen::Matrix<char, Eigen::Dynamic, 1>>(is_solved.data(), Index(is_solved.size()))
                        .cast<double>(),
                    d);
  const SparseMatrix matrix = gather_matrix(ranks, region.matrix, region.nodes, d, nodes_);
  MatrixGraph graph = gather_graph(region.nodes);
  if (!contact_.is_root()) return;
  region_solved_.assign(std::size_t(solved.size()), 0);
  for (Index dof = 0; dof < solved.size(); ++dof) region_solved_[std::size_t(dof)] = solved[dof] > 0.0;
  region_product_ = StageProduct(matrix, d);
  region_neighbourhood_ = std::make_unique<ContactNeighbourhood>(*root_problem_, std::move(graph));
  subdomains_ = std::make_unique<Subdomains>(*root_problem_, body_.coefficients, region_solved_, region_product_,
                                             *region_neighbourhood_, shared_, condensed_stage_);
  subdomains_->set_layers(region.layers);
}

std::size_t RootSubdomains::partition_on_root() { return subdomains_ ? subdomains_->partition(points_) : 0; }

void RootSubdomains::make_on_root(std::size_t number, std::size_t count) {
  if (subdomains_) subdomains_->make_share(number, count);
}

/// Extends the rows of the stage, received on the contact nodes, to all nodes; once for many stages if the obstacle is
/// flat.
void RootSubdomains::widen_rows() {
  if (rows_ != stage_.rows) {
    rows_ = stage_.rows;
    region_rows_ = GatheredContact::rows_on(*rows_, root_problem_->dof_count());
  }
  stage_.rows = region_rows_;
}

void RootSubdomains::gather(const LinearStage& stage, const Vector& x, const std::vector<Index>& points,
                            const Vector& residual) {
  contact_.gather(stage, x, points, stage_);
  if (contact_.is_root()) widen_rows();
  region_residual_ = nodes_.gather(residual, body_.problem.dimension);
}

void RootSubdomains::solve_on_root() {
  if (!contact_.is_root()) return;
  solution_.open_all(contact_.point_count(), root_problem_->contact.has_friction() ? body_.problem.dimension - 1 : 0);
  region_x_.setZero(root_problem_->dof_count());
  subdomains_->solve(stage_.linear(), region_residual_, region_x_, solution_);
}

void RootSubdomains::scatter(const std::vector<Index>& points, Vector& x, StageSolution& solution) {
  const int d = body_.problem.dimension;
  if (correction_.size() != x.size()) correction_.setZero(x.size());
  nodes_.scatter(region_x_, d, correction_);
  for (const Index node : nodes_.nodes()) {
    x.segment(node * d, d) += correction_.segment(node * d, d);
    correction_.segment(node * d, d).setZero();
  }
  contact_.scatter(solution_, points, solution);
}

void RootSubdomains::add_motion(Vector& motion) {
  const int d = body_.problem.dimension;
  const GatheredNodes& contact_nodes = contact_.nodes();
  body_.problem.ranks->run_collectively([&] {
    if (subdomains_)
      subdomains_->find_motion(*stage_.rows, solution_, Vector::Zero(root_problem_->dof_count()), region_motion_);
  });
  if (contact_motion_.size() != motion.size()) contact_motion_.setZero(motion.size());
  contact_nodes.scatter(region_motion_, d, contact_motion_);
  for (const Index node : contact_nodes.nodes()) motion.segment(node * d, d) += contact_motion_.segment(node * d, d);
}

}  // namespace ricochet
