#include "ricochet/solver/gathered/gathered_subdomains.hpp"

#include <algorithm>

#include "ricochet/solver/gathered/root_subdomains.hpp"

namespace ricochet {

namespace {

/// Largest number of roots: each has all contact points and everything near them, and receives all data in every
/// iteration.
constexpr std::size_t max_roots = 16;

class GatheredSubdomains final : public ContactRegion {
 public:
  GatheredSubdomains(const DistributedRegion& body, SharedContact& shared, GatheredContact& contact,
                     FactoredStage* condensed_stage)
      : body_(body), shared_(shared) {
    roots_.push_back({nullptr, std::make_unique<RootSubdomains>(body, shared, contact, condensed_stage)});
  }

  void make(const std::vector<Index>& points) override;
  void clear() override {
    for (const Root& root : roots_) root.subdomains->clear();
    active_ = 0;
  }
  [[nodiscard]] bool are_made() const override { return active_ > 0; }
  [[nodiscard]] const std::vector<Index>& nodes() const override { return nodes_; }
  void solve(const LinearStage& stage, const Vector& residual, Vector& x, StageSolution& solution) override;
  void find_motion(const ContactRows& rows, const StageSolution& solution, const Vector& increment,
                   Vector& motion) override;

  void persist(const SnapshotVisitor& state, const std::vector<Index>& points) override {
    const auto persist_made = [&] { visit([&](Subdomains& subdomains) { subdomains.persist_made(state); }); };
    if (!state.loads()) return persist_made();
    make(points);  // with as many layers: their number follows from the points and the operator
    body_.problem.ranks->run_collectively(persist_made);
  }
  void report() const override {
    visit([](const Subdomains& subdomains) { subdomains.report(); });
  }

 private:
  struct Root {
    std::unique_ptr<GatheredContact> contact;  ///< null for the first, whose contact others keep
    std::unique_ptr<RootSubdomains> subdomains;
  };
  /// Visits the subdomains of this rank.
  template <class Visit>
  void visit(const Visit& visit) const {
    for (std::size_t i = 0; i < active_; ++i) {
      if (roots_[i].subdomains->subdomains() != nullptr) visit(*roots_[i].subdomains->subdomains());
    }
  }
  void choose_roots(std::size_t subdomain_count);

  DistributedRegion body_;
  SharedContact& shared_;
  std::vector<Root> roots_;
  std::size_t active_ = 0;     ///< roots with subdomains
  std::vector<Index> points_;  ///< of this rank
  std::vector<Index> nodes_;   ///< of this rank, near the points of all ranks
};

/// Chooses the roots of so many subdomains.
void GatheredSubdomains::choose_roots(std::size_t subdomain_count) {
  const auto ranks = std::size_t(body_.problem.ranks->size());
  active_ = std::min({subdomain_count, ranks, max_roots});
  while (roots_.size() < active_) {
    auto contact = std::make_unique<GatheredContact>(body_.problem, roots_.size());
    auto at_root = std::make_unique<RootSubdomains>(body_, shared_, *contact, nullptr);
    roots_.push_back({std::move(contact), std::move(at_root)});
  }
}

void GatheredSubdomains::make(const std::vector<Index>& points) {
  clear();
  points_ = points;
  RegionNodes region;
  region.layers = body_.neighbourhood.layers_to_solve(points, body_.coefficients, body_.product);
  region.nodes = body_.neighbourhood.nodes_around(points, region.layers);
  region.matrix = body_.product.principal(region.nodes);
  const Ranks& ranks = *body_.problem.ranks;
  roots_.front().subdomains->gather_body(points, region);
  std::size_t subdomain_count = 0;
  ranks.run_collectively([&] { subdomain_count = roots_.front().subdomains->partition_on_root(); });
  choose_roots(std::size_t(ranks.maximum(double(subdomain_count))));
  for (std::size_t i = 1; i < active_; ++i) roots_[i].subdomains->gather_body(points, region);
  ranks.run_collectively([&] {
    for (std::size_t i = 0; i < active_; ++i) {
      if (i > 0) roots_[i].subdomains->partition_on_root();
      roots_[i].subdomains->make_on_root(i, active_);
    }
  });
  nodes_ = std::move(region.nodes);
}

void GatheredSubdomains::solve(const LinearStage& stage, const Vector& residual, Vector& x, StageSolution& solution) {
  for (std::size_t i = 0; i < active_; ++i) roots_[i].subdomains->gather(stage, x, points_, residual);
  body_.problem.ranks->run_collectively([&] {
    for (std::size_t i = 0; i < active_; ++i) roots_[i].subdomains->solve_on_root();
  });
  solution.open_all(body_.problem.contact.size(),
                    body_.problem.contact.has_friction() ? body_.problem.dimension - 1 : 0);
  for (std::size_t i = 0; i < active_; ++i) roots_[i].subdomains->scatter(points_, x, solution);
}

void GatheredSubdomains::find_motion(const ContactRows&, const StageSolution& solution, const Vector& increment,
                                     Vector& motion) {
  const int d = body_.problem.dimension;
  if (motion.size() != body_.problem.dof_count()) motion.setZero(body_.problem.dof_count());
  for (const Index node : roots_.front().subdomains->contact().nodes().nodes())
    motion.segment(node * d, d) = increment.segment(node * d, d);
  const auto is_zero = [](const Vector& values) { return values.isZero(0.0); };
  const bool acts = !is_zero(solution.normal_reaction) || !is_zero(solution.tangential_reaction) ||
                    !is_zero(solution.acting_normal()) || !is_zero(solution.acting_tangential());
  if (body_.problem.ranks->any(acts)) roots_.front().subdomains->add_motion(motion);
}

}  // namespace

std::unique_ptr<ContactRegion> make_gathered_subdomains(const SemidiscreteProblem& problem,
                                                        const OperatorCoefficients& coefficients,
                                                        const std::vector<char>& solved, const StageProduct& product,
                                                        ContactNeighbourhood& neighbourhood, SharedContact& shared,
                                                        GatheredContact& contact, FactoredStage* condensed_stage) {
  return std::make_unique<GatheredSubdomains>(DistributedRegion{problem, coefficients, solved, product, neighbourhood},
                                              shared, contact, condensed_stage);
}

}  // namespace ricochet
