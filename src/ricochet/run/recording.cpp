#include "ricochet/run/recording.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/problem/penetrating_points.hpp"

namespace ricochet {

namespace {

/// Interval, in seconds, at which rows of the history are flushed for readers.
constexpr double flush_interval = 1.0;

std::optional<SnapshotVisitor> saved_part(const Snapshot* snapshot, const std::string& name) {
  return snapshot != nullptr ? std::optional(snapshot->loader(name)) : std::nullopt;
}

/// Opens the history on the first rank; returns null on the others.
std::unique_ptr<HistoryWriter> open_history(const Ranks& ranks, const std::string& path,
                                            const std::vector<std::string>& columns, const Snapshot* snapshot,
                                            const std::string& name) {
  std::unique_ptr<HistoryWriter> result;
  ranks.run_collectively([&] {
    if (!ranks.is_first()) return;
    result = std::make_unique<HistoryWriter>(path, columns, saved_part(snapshot, name));
  });
  return result;
}

ImpactRecorder make_impact_recorder(const Model& model, const Scheme& scheme, const State& state) {
  ImpactRecorder impacts(model.problem, scheme, state, model.contact_pairs, model.bodies.connected.of_node,
                         model.bodies.crossing_times);
  if (!model.initial.static_equilibrium)
    impacts.begin_inside(initially_penetrating_points(model.problem, model.initial.displacement).points);
  return impacts;
}

std::unique_ptr<ResultsWriter> open_results(const OutputSection& output, const Model& model,
                                            const std::string& directory, const Snapshot* snapshot) {
  const ResultsOptions options = results_options(output);
  GlobalBody global_body;
  if (model.global_output)
    global_body = {&model.global_output->body,
                   &model.global_output->problem,
                   model.global_output->node_rows,
                   model.global_output->cell_rows,
                   model.sizes.nodes,
                   model.sizes.cells};
  return std::make_unique<ResultsWriter>(directory, model.body, model.problem, options, saved_part(snapshot, "results"),
                                         global_body);
}

/// Makes the penetration watch. Steps at finite strain compute stresses and tangents of all cells and refactorize
/// several times, which takes at least as long as this many evaluations of the stress of all cells (measured).
PenetrationWatch make_penetration_watch(const Case& input, const Model& model, std::size_t factor_entries) {
  std::vector<NamedObstacle> obstacles;
  for (std::size_t i = 0; i < input.obstacles.size(); ++i)
    obstacles.push_back({input.obstacles[i].name, model.obstacles[i].get()});
  constexpr double cell_evaluations = 20.0;
  const double of_cells = has_finite_strain(model.body) ? cell_evaluations * evaluation_work(model.body) : 0.0;
  return {model.body, model.problem, model.contact_pairs,
          obstacles,  model.bodies,  step_work(model.sizes.dofs, factor_entries) + of_cells};
}

std::string sampled_name(long every) { return fmt::format("probes-{}", every); }

}  // namespace

Recording::Recording(const Case& input, const Model& model, const Scheme& scheme, const State& state,
                     const std::string& directory, long steps, std::size_t factor_entries, const Snapshot* snapshot)
    : fields_(input, model, steps, snapshot),
      results_(fields_.any() ? open_results(input.output, model, directory, snapshot) : nullptr),
      recorder_(model.problem, *model.rotation, model.sensors, model.history_bodies),
      history_(
          open_history(*model.problem.ranks, directory + "/history.csv", recorder_.columns(), snapshot, "history")),
      checks_(input, model, scheme, state, recorder_.columns()),
      model_(model),
      scheme_(scheme),
      body_names_(names_of_all_bodies(input, model)),
      impacts_(make_impact_recorder(model, scheme, state)),
      peak_stress_(model.body, step_work(model.sizes.dofs, factor_entries), *model.problem.ranks,
                   std::make_unique<StressRaisers>(model.body, model.problem, model.contact_pairs, model.bodies)),
      penetration_(make_penetration_watch(input, model, factor_entries)),
      sliding_(model.body, model.problem, model.contact_pairs),
      late_(model.body, model.problem, model.contact_pairs),
      rotation_(model.body, *model.problem.ranks, column_index(recorder_.columns(), "max_rotation")),
      distortion_(model.body, model.problem),
      method_(scheme.traits_for(model.problem).acting_reactions, *model.problem.ranks,
              scheme.traits().corrects_velocities && has_finite_strain(model.body)),
      history_every_(input.output.history_every.value_or(scheme.traits().history_every)) {
  for (const auto& [every, sensors] : model.sampled_sensors) {
    SensorRecorder recorder(model.problem, sensors);
    std::unique_ptr<HistoryWriter> file =
        open_history(*model.problem.ranks, directory + "/" + sampled_name(every) + ".csv", recorder.columns(), snapshot,
                     sampled_name(every));
    sampled_.push_back({every, std::move(recorder), std::move(file)});
  }
  if (snapshot != nullptr) persist(snapshot->loader(""));
}

void Recording::persist(const SnapshotVisitor& visit) {
  digest_.persist(visit.part("digest"), recorder_.columns().size());
  checks_.persist(visit.part("checks"));
  impacts_.persist(visit.part("impacts"));
  peak_stress_.persist(visit.part("peak_stress"));
  penetration_.persist(visit.part("penetration"));
  sliding_.persist(visit.part("sliding"));
  late_.persist(visit.part("late_contact"));
  rotation_.persist(visit.part("rotation"));
  distortion_.persist(visit.part("distortion"));
  method_.persist(visit.part("method"));
}

/// Returns the energy of the method, summed over all ranks.
double Recording::method_energy(const State& state, EnergyAccount& account) const {
  return model_.problem.ranks->sum(account.method_energy(state));
}

void Recording::enter_part(const State& state, EnergyAccount& account) {
  checks_.enter_part(state);
  method_.enter_part(scheme_.last_step().corrections);
  penetration_.check_part(state);
  impacts_.enter_step(state, method_energy(state, account));
}

void Recording::record(const State& state, EnergyAccount& account) {
  Timer timer;
  if (state.step > 0) {
    method_.enter_step(state, method_energy(state, account));
  }
  const bool is_frame = results_ && fields_.includes(state);
  peak_stress_.enter(state, is_frame);
  if (state.step % history_every_ == 0) write_row(state, account);
  const Timer watch_timer;
  penetration_.check(state);
  sliding_.check(state);
  late_.check(state);
  watch_seconds_ += watch_timer.seconds();
  for (Sampled& sampled : sampled_) {
    if (state.step % sampled.every == 0) write_row_of(sampled, state);
  }
  if (is_frame) results_->write(state);
  if (since_flush_.seconds() > flush_interval) {
    flush();
    since_flush_.restart();
  }
  seconds_ += timer.seconds();
}

void Recording::record_end(const State& state, EnergyAccount& account) {
  Timer timer;
  if (state.step % history_every_ != 0) write_row(state, account);
  for (Sampled& sampled : sampled_) {
    if (state.step % sampled.every != 0) write_row_of(sampled, state);
  }
  if (results_ && !fields_.is_last(state)) {
    peak_stress_.enter_frame(state);
    results_->write(state);
  }
  const Timer watch_timer;
  penetration_.check_end(state);
  watch_seconds_ += watch_timer.seconds();
  flush();
  seconds_ += timer.seconds();
}

void Recording::write_row(const State& state, EnergyAccount& account) {
  const std::vector<double>& row = recorder_.row(state, account);
  check_finite(row);
  model_.problem.ranks->run_collectively([&] {
    if (history_) history_->write(row);
  });
  digest_.add(row);
  rotation_.watch(row, state);
  distortion_.watch(row[1], state);
  checks_.watch(row, state);
}

void Recording::write_row_of(Sampled& sampled, const State& state) {
  const std::vector<double>& row = sampled.recorder.row(state);
  model_.problem.ranks->run_collectively([&] {
    if (sampled.file) sampled.file->write(row);
  });
}

void Recording::flush() {
  if (history_) history_->flush();
  for (Sampled& sampled : sampled_) {
    if (sampled.file) sampled.file->flush();
  }
  if (results_) results_->require_unchanged();
}

void Recording::save(Snapshot& snapshot) {
  if (history_) {
    history_->sync();
    history_->save(snapshot.saver("history"));
  }
  for (Sampled& sampled : sampled_) {
    if (!sampled.file) continue;
    sampled.file->sync();
    sampled.file->save(snapshot.saver(sampled_name(sampled.every)));
  }
  if (results_) {
    results_->sync();
    results_->save(snapshot.saver("results"));
  }
  fields_.persist(snapshot.saver("fields"));
  persist(snapshot.saver(""));
}

void Recording::describe(RunSummary& summary) const {
  summary.frames = results_ ? results_->frames() : 0;
  summary.history_every = history_every_;
  summary.columns = recorder_.columns();
  summary.digests = digest_.columns();
  summary.checks = checks_.results();
  summary.method_energy = method_.energy(summary.energy_scale());
  summary.reactions = method_.reactions();
  summary.velocity_corrections = method_.velocity_corrections();
  summary.distortion_energy = distortion_.largest_energy();
  summary.impacts = impacts_.impacts();
  summary.impacts_left_out = impacts_.left_out();
  summary.penetration = penetration_.report();
  summary.sliding = sliding_.report();
  summary.unsettled = sliding_.unsettled();
  summary.rotation = {rotation_.limit(), rotation_.time_beyond_limit(), {}};
  for (const Impact& impact : summary.impacts)
    summary.rotation.until_impact_end.push_back(rotation_.largest_until(impact.end));
  describe_bodies(summary);
  describe_peak_stress(summary);
}

void Recording::describe_bodies(RunSummary& summary) const {
  summary.bodies.clear();
  for (const RigidBody& body : impacts_.bodies()) {
    const std::size_t number = summary.bodies.size();
    summary.bodies.push_back({body, impacts_.separation(int(number)), body_names_[number]});
  }
}

void Recording::describe_peak_stress(RunSummary& summary) const {
  const PeakStressResult& peak = peak_stress_.result();
  if (peak.cell < 0) return;
  const Body& body = model_.body;
  const CellLocation location = location_of_cell(*body.mesh, peak.cell);
  const auto material = std::size_t(body.cell_material[std::size_t(peak.cell)]);
  PeakStressResult reported = peak;
  if (model_.global_output) reported.cell = model_.global_output->cell_rows[std::size_t(peak.cell)];
  summary.peak_stress = PeakStressDescription{reported,
                                              {location.centre.data(), location.centre.data() + location.centre.size()},
                                              location.tag,
                                              body.materials[material].name};
}

/// Throws if the motion has diverged. Energies are squares: they overflow long before the displacement does.
void Recording::check_finite(const std::vector<double>& row) const {
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (std::isfinite(row[i])) continue;
    throw Error(ErrorKind::not_converged,
                fmt::format("step {:.0f} (t = {:.9g}): {} is no longer finite, so the motion has diverged; use a "
                            "stable scheme (reduced-kane with mass \"equivalent\")",
                            row[0], row[1], recorder_.columns()[i]));
  }
}

}  // namespace ricochet
