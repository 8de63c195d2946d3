#include "ricochet/solver/gathered/gathered_subdomains.hpp"

#include <algorithm>

#include "ricochet/solver/gathered/root_subdomains.hpp"

namespace ricochet {

namespace {

/// Largest number of roots: each has all contact points and everything near them, and receives all data in every
/// iteration.
constexpr std::size_t most_homes = 16;

class GatheredSubdomains final : public ContactRegion {
 public:
  GatheredSubdomains(const DistributedRegion& body, bool all_points, GatheredContact& contact,
                     FactoredStage* condensed_stage)
      : body_(body), all_points_(all_points) {
    homes_.push_back({nullptr, std::make_unique<RootSubdomains>(body, all_points, contact, condensed_stage)});
  }

  void make(const std::vector<Index>& points) override;
  void clear() override {
    for (const Home& home : homes_) home.zones->clear();
    active_ = 0;
  }
  [[nodiscard]] bool are_made() const override { return active_ > 0; }
  [[nodiscard]] const std::vector<Index>& nodes() const override { return nodes_; }
  void solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution) override;
  void find_motion(const ContactRows& rows, const StageSolution& solution, const Vector& increment,
                   Vector& motion) override;

  void save(Snapshot& snapshot, const std::string& name) const override {
    visit([&](const Subdomains& zones) { zones.save(snapshot, name); });
  }
  void load(const Snapshot& snapshot, const std::string& name, const std::vector<Index>& points) override {
    make(points);
    body_.problem.ranks->run_collectively([&] { visit([&](Subdomains& zones) { zones.load_made(snapshot, name); }); });
  }
  void report() const override {
    visit([](const Subdomains& zones) { zones.report(); });
  }
  void observe(const ContactObserver& observer) override {
    observer_ = observer;
    visit([&](Subdomains& zones) { zones.observe(observer); });
  }
  [[nodiscard]] double contact_seconds() const override {
    double sum = 0.0;
    for (const Home& home : homes_) sum += home.zones->earlier_seconds();
    visit([&](const Subdomains& zones) { sum += zones.contact_seconds(); });
    return sum;
  }
  [[nodiscard]] std::size_t factor_entries() const override {
    std::size_t sum = 0;
    visit([&](const Subdomains& zones) { sum += zones.factor_entries(); });
    return sum;
  }

 private:
  struct Home {
    std::unique_ptr<GatheredContact> contact;  ///< null for the first, whose contact others keep
    std::unique_ptr<RootSubdomains> zones;
  };
  /// Visits the subdomains of this rank.
  template <class Visit>
  void visit(const Visit& visit) const {
    for (std::size_t i = 0; i < active_; ++i) {
      if (homes_[i].zones->zones() != nullptr) visit(*homes_[i].zones->zones());
    }
  }
  void find_homes(std::size_t zones);

  DistributedRegion body_;
  bool all_points_;
  std::vector<Home> homes_;
  std::size_t active_ = 0;     ///< roots with subdomains
  std::vector<Index> points_;  ///< of this rank
  std::vector<Index> nodes_;   ///< of this rank, near the points of all ranks
  ContactObserver observer_;
};

/// Chooses the roots of so many subdomains.
void GatheredSubdomains::find_homes(std::size_t zones) {
  const auto ranks = static_cast<std::size_t>(body_.problem.ranks->size());
  active_ = std::min({zones, ranks, most_homes});
  while (homes_.size() < active_) {
    auto contact = std::make_unique<GatheredContact>(body_.problem, homes_.size());
    auto at_root = std::make_unique<RootSubdomains>(body_, all_points_, *contact, nullptr);
    homes_.push_back({std::move(contact), std::move(at_root)});
  }
}

void GatheredSubdomains::make(const std::vector<Index>& points) {
  clear();
  points_ = points;
  RegionNodes near;
  near.layers = body_.neighbourhood.layers_to_solve(points, body_.coefficients, body_.product);
  near.nodes = body_.neighbourhood.nodes_around(points, near.layers);
  near.matrix = body_.product.principal(near.nodes);
  const Ranks& ranks = *body_.problem.ranks;
  homes_.front().zones->gather_body(points, near);
  std::size_t zones = 0;
  ranks.run_collectively([&] { zones = homes_.front().zones->partition_on_root(); });
  find_homes(static_cast<std::size_t>(ranks.maximum(static_cast<double>(zones))));
  for (std::size_t i = 1; i < active_; ++i) homes_[i].zones->gather_body(points, near);
  ranks.run_collectively([&] {
    for (std::size_t i = 0; i < active_; ++i) {
      if (i > 0) homes_[i].zones->partition_on_root();
      homes_[i].zones->make_on_root(i, active_);
    }
  });
  nodes_ = std::move(near.nodes);
  observe(observer_);
}

void GatheredSubdomains::solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution) {
  for (std::size_t i = 0; i < active_; ++i) homes_[i].zones->gather(stage, x, points_, residual);
  body_.problem.ranks->run_collectively([&] {
    for (std::size_t i = 0; i < active_; ++i) homes_[i].zones->solve_on_root();
  });
  solution.open_all(body_.problem.contact.size(),
                    body_.problem.contact.has_friction() ? body_.problem.dimension - 1 : 0);
  for (std::size_t i = 0; i < active_; ++i) homes_[i].zones->scatter(points_, x, solution);
}

void GatheredSubdomains::find_motion(const ContactRows&, const StageSolution& solution, const Vector& increment,
                                     Vector& motion) {
  const int d = body_.problem.dimension;
  if (motion.size() != body_.problem.dof_count()) motion.setZero(body_.problem.dof_count());
  for (const Index node : homes_.front().zones->contact().nodes().nodes())
    motion.segment(node * d, d) = increment.segment(node * d, d);
  const auto is_zero = [](const Vector& values) { return values.isZero(0.0); };
  const bool acts = !is_zero(solution.normal_reaction) || !is_zero(solution.tangential_reaction) ||
                    !is_zero(solution.acting_normal()) || !is_zero(solution.acting_tangential());
  if (body_.problem.ranks->any(acts)) homes_.front().zones->add_motion(motion);
}

}  // namespace

std::unique_ptr<ContactRegion> make_gathered_subdomains(const SemidiscreteProblem& problem,
                                                        const OperatorCoefficients& coefficients,
                                                        const std::vector<char>& solved, const StageProduct& product,
                                                        ContactNeighbourhood& neighbourhood, bool all_points,
                                                        GatheredContact& contact, FactoredStage* condensed_stage) {
  return std::make_unique<GatheredSubdomains>(DistributedRegion{problem, coefficients, solved, product, neighbourhood},
                                              all_points, contact, condensed_stage);
}

}  // namespace ricochet
