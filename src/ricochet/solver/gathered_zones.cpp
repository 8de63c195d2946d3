#include "ricochet/solver/gathered_zones.hpp"

#include <algorithm>

#include "ricochet/solver/contact_zones.hpp"

namespace ricochet {

namespace {

class GatheredZones final : public NearContact {
 public:
  GatheredZones(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                const std::vector<char>& solved, const StageProduct& product, PointsNearby& nearby, bool all_points,
                GatheredContact& contact, FactoredStage* layer)
      : problem_(problem),
        coefficients_(coefficients),
        solved_(solved),
        product_(product),
        nearby_(nearby),
        all_points_(all_points),
        contact_(contact),
        layer_(layer) {}

  void make(const std::vector<Index>& points) override;
  void clear() override;
  [[nodiscard]] bool are_made() const override { return are_made_; }
  void solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution) override;
  void find_motion(const ContactRows& rows, const StageSolution& solution, const Vector& increment,
                   Vector& motion) override;

  void save(Snapshot& snapshot, const std::string& name) const override {
    if (zones_) zones_->save(snapshot, name);
  }
  void load(const Snapshot& snapshot, const std::string& name, const std::vector<Index>& points) override {
    make(points);
    problem_.ranks->together([&] {
      if (zones_) zones_->load_made(snapshot, name);
    });
  }
  void report() const override {
    if (zones_) zones_->report();
  }
  void observe(const ContactObserver& observer) override {
    observer_ = observer;
    if (zones_) zones_->observe(observer);
  }
  [[nodiscard]] double contact_seconds() const override {
    return earlier_seconds_ + (zones_ ? zones_->contact_seconds() : 0.0);
  }
  [[nodiscard]] std::size_t factor_entries() const override { return zones_ ? zones_->factor_entries() : 0; }

 private:
  void make_at_home(SparseMatrix matrix, MatrixGraph graph, const Vector& solved, int layers);
  [[nodiscard]] MatrixGraph gather_graph(const std::vector<Index>& nodes);
  void gather_points();

  const SemidiscreteProblem& problem_;
  OperatorCoefficients coefficients_;
  const std::vector<char>& solved_;
  const StageProduct& product_;
  PointsNearby& nearby_;
  bool all_points_;
  GatheredContact& contact_;
  FactoredStage* layer_;
  ContactObserver observer_;
  double earlier_seconds_ = 0.0;
  bool are_made_ = false;
  std::vector<Index> points_;  ///< of this rank
  GatheredNodes nodes_;
  Vector correction_, layer_motion_;  ///< per dof
  // At home:
  std::vector<Index> points_at_home_;
  std::unique_ptr<SemidiscreteProblem> near_;
  std::vector<char> near_solved_;
  StageProduct near_product_;
  std::unique_ptr<PointsNearby> near_nearby_;
  std::unique_ptr<ContactZones> zones_;
  Stage stage_;
  StageSolution solution_;
  Vector near_x_, near_motion_;
};

void GatheredZones::clear() {
  earlier_seconds_ = contact_seconds();
  are_made_ = false;
  zones_.reset();
}

void GatheredZones::gather_points() {
  const Ranks& ranks = *problem_.ranks;
  Ranks::ForEach<std::int64_t> told(static_cast<std::size_t>(ranks.size()));
  told[static_cast<std::size_t>(nodes_.home())].assign(points_.begin(), points_.end());
  const Ranks::ForEach<std::int64_t> known = ranks.exchange(std::move(told));
  points_at_home_.clear();
  for (std::size_t rank = 0; rank < known.size(); ++rank) {
    for (const std::int64_t point : known[rank])
      points_at_home_.push_back(contact_.number(static_cast<int>(rank), point));
  }
}

/// Who is a neighbour of whom by the cells of all ranks.
MatrixGraph GatheredZones::gather_graph(const std::vector<Index>& nodes) {
  const Ranks& ranks = *problem_.ranks;
  Ranks::ForEach<std::int64_t> told(static_cast<std::size_t>(ranks.size()));
  std::vector<std::int64_t>& message = told[static_cast<std::size_t>(nodes_.home())];
  for (const Index node : nodes) {
    for (const int other : nearby_.graph().neighbours(node)) {
      if (!std::binary_search(nodes.begin(), nodes.end(), Index{other})) continue;
      message.push_back(ranks.number_of(node));
      message.push_back(ranks.number_of(other));
    }
  }
  const Ranks::ForEach<std::int64_t> known = ranks.exchange(std::move(told));
  if (!contact_.is_home()) return {};
  std::vector<Eigen::Triplet<double>> entries;
  for (const std::vector<std::int64_t>& pairs : known) {
    for (std::size_t i = 0; i < pairs.size(); i += 2)
      entries.emplace_back(static_cast<int>(nodes_.place_of(pairs[i])), static_cast<int>(nodes_.place_of(pairs[i + 1])),
                           1.0);
  }
  SparseMatrix pattern(nodes_.count(), nodes_.count());
  pattern.setFromTriplets(entries.begin(), entries.end());
  return MatrixGraph(pattern, 1);
}

void GatheredZones::make_at_home(SparseMatrix matrix, MatrixGraph graph, const Vector& solved, int layers) {
  near_solved_.assign(static_cast<std::size_t>(solved.size()), 0);
  for (Index dof = 0; dof < solved.size(); ++dof) near_solved_[static_cast<std::size_t>(dof)] = solved[dof] > 0.0;
  near_product_ = StageProduct(matrix, problem_.dimension);
  near_nearby_ = std::make_unique<PointsNearby>(*near_, std::move(graph));
  zones_ = std::make_unique<ContactZones>(*near_, coefficients_, near_solved_, near_product_, *near_nearby_,
                                          all_points_, layer_);
  zones_->set_layers(layers);
  zones_->observe(observer_);
  zones_->make(points_at_home_);
}

void GatheredZones::make(const std::vector<Index>& points) {
  clear();
  points_ = points;
  const Ranks& ranks = *problem_.ranks;
  const int d = problem_.dimension;
  const int layers = nearby_.layers_to_solve(points, coefficients_, product_);
  const std::vector<Index> nodes = nearby_.nodes_around(points, layers);
  nodes_ = GatheredNodes(ranks, contact_.nodes().home(), nodes, &contact_.nodes());
  gather_points();
  near_ = contact_.make_problem(nodes_);
  const Vector solved = nodes_.gather(
      Eigen::Map<const Eigen::Matrix<char, Eigen::Dynamic, 1>>(solved_.data(), static_cast<Index>(solved_.size()))
          .cast<double>(),
      d);
  SparseMatrix matrix = gather_matrix(ranks, product_.principal(nodes), nodes, d, nodes_);
  MatrixGraph graph = gather_graph(nodes);
  ranks.together([&] {
    if (contact_.is_home()) make_at_home(std::move(matrix), std::move(graph), solved, layers);
  });
  are_made_ = true;
}

void GatheredZones::solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution) {
  const Ranks& ranks = *problem_.ranks;
  const int d = problem_.dimension;
  contact_.gather(stage, x, points_, stage_);
  const Vector near_residual = nodes_.gather(residual, d);
  ranks.together([&] {
    if (!contact_.is_home()) return;
    const Index count = contact_.point_count();
    solution_.normal_reaction.setZero(count);
    solution_.tangential_reaction.setZero(near_->contact.has_friction() ? count * (d - 1) : 0);
    solution_.contact_status.assign(static_cast<std::size_t>(count), ContactStatus::open);
    solution_.clear_mean();
    solution_.iterations = 0;
    near_x_.setZero(near_->dof_count());
    zones_->solve(stage_, near_residual, near_x_, solution_);
  });
  if (correction_.size() != x.size()) correction_.setZero(x.size());
  nodes_.spread(near_x_, d, correction_);
  for (const Index node : nodes_.nodes()) {
    x.segment(node * d, d) += correction_.segment(node * d, d);
    correction_.segment(node * d, d).setZero();
  }
  contact_.spread(solution_, points_, solution);
}

void GatheredZones::find_motion(const ContactRows&, const StageSolution& solution, const Vector& increment,
                                Vector& motion) {
  const int d = problem_.dimension;
  if (motion.size() != problem_.dof_count()) motion.setZero(problem_.dof_count());
  const GatheredNodes& contact_nodes = contact_.nodes();
  for (const Index node : contact_nodes.nodes()) motion.segment(node * d, d) = increment.segment(node * d, d);
  const auto is_zero = [](const Vector& values) { return values.isZero(0.0); };
  const bool acts = !is_zero(solution.normal_reaction) || !is_zero(solution.tangential_reaction) ||
                    !is_zero(solution.acting_normal()) || !is_zero(solution.acting_tangential());
  if (!problem_.ranks->any(acts)) return;
  problem_.ranks->together([&] {
    if (zones_) zones_->find_motion(*stage_.rows, solution_, Vector::Zero(near_->dof_count()), near_motion_);
  });
  if (layer_motion_.size() != motion.size()) layer_motion_.setZero(motion.size());
  contact_nodes.spread(near_motion_, d, layer_motion_);
  for (const Index node : contact_nodes.nodes()) motion.segment(node * d, d) += layer_motion_.segment(node * d, d);
}

}  // namespace

SparseMatrix gather_matrix(const Ranks& ranks, const SparseMatrix& on_nodes, const std::vector<Index>& nodes, int d,
                           const GatheredNodes& gathered) {
  const auto dof_number = [&](Index dof) {
    return ranks.number_of(nodes[static_cast<std::size_t>(dof / d)]) * d + dof % d;
  };
  const auto size = static_cast<std::size_t>(ranks.size());
  Ranks::ForEach<std::int64_t> places(size);
  Ranks::ForEach<double> values(size);
  const auto home = static_cast<std::size_t>(gathered.home());
  for (Index column = 0; column < on_nodes.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(on_nodes, column); entry; ++entry) {
      places[home].push_back(dof_number(entry.row()));
      places[home].push_back(dof_number(column));
      values[home].push_back(entry.value());
    }
  }
  const Ranks::ForEach<std::int64_t> known_places = ranks.exchange(std::move(places));
  const Ranks::ForEach<double> known_values = ranks.exchange(std::move(values));
  if (!gathered.is_home()) return {};
  const auto place_of = [&](std::int64_t dof) { return static_cast<int>(gathered.place_of(dof / d) * d + dof % d); };
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t rank = 0; rank < size; ++rank) {
    for (std::size_t i = 0; i < known_values[rank].size(); ++i)
      entries.emplace_back(place_of(known_places[rank][2 * i]), place_of(known_places[rank][2 * i + 1]),
                           known_values[rank][i]);
  }
  SparseMatrix result(gathered.count() * d, gathered.count() * d);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

std::unique_ptr<NearContact> make_gathered_zones(const SemidiscreteProblem& problem,
                                                 const OperatorCoefficients& coefficients,
                                                 const std::vector<char>& solved, const StageProduct& product,
                                                 PointsNearby& nearby, bool all_points, GatheredContact& contact,
                                                 FactoredStage* layer) {
  return std::make_unique<GatheredZones>(problem, coefficients, solved, product, nearby, all_points, contact, layer);
}

}  // namespace ricochet
