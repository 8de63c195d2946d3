#include "ricochet/run/field_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Largest size of results if the case does not state how many frames to write, unless two frames already exceed it.
constexpr double most_bytes = 200e6;

/// Returns 100; fewer for runs of small bodies that take less than a second, in which writing so many frames would take
/// as long as the steps.
long usual_frames(long steps, Index dofs) {
  constexpr double least = 10.0, most = 100.0, work_per_frame = 8e4;
  return std::lround(std::min(most, least + double(steps) * double(dofs) / work_per_frame));
}

/// Returns the number of frames between the first and the last.
long affordable_frames(const ResultsSize& size) {
  return std::max(1L, long((most_bytes - size.mesh) / size.frame) - 2);
}

ResultsSize size_of_results(const Case& input, const Model& model) {
  return results_size(model.body, model.problem, results_options(input.output), model.sizes.nodes, model.sizes.cells);
}

}  // namespace

std::string size_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.3g} MB", 1e-6 * bytes) : fmt::format("{:.3g} GB", 1e-9 * bytes);
}

ResultsOptions results_options(const OutputSection& output) {
  return {output.fields, {output.single_precision, output.compression}, output.format};
}

FieldSchedule::FieldSchedule(const Case& input, const Model& model, long steps, const Snapshot* snapshot) {
  if (snapshot != nullptr) persist(snapshot->loader("fields"));
  if (input.output.fields_interval) {
    interval_ = *input.output.fields_interval;
  } else if (input.output.fields_every && snapshot == nullptr) {
    every_ = *input.output.fields_every;
  } else if (snapshot == nullptr) {
    const long usual = usual_frames(steps, model.sizes.dofs);
    // All ranks must write the same frames.
    const auto affordable = double(affordable_frames(size_of_results(input, model)));
    const long frames = std::min(usual, std::lround(-model.problem.ranks->maximum(-affordable)));
    is_limited_ = frames < usual;
    if (input.time.adaptive) {
      interval_ = input.time.end / double(frames);
    } else {
      every_ = (steps + frames - 1) / frames;
    }
  }
}

void FieldSchedule::persist(const SnapshotVisitor& visit) {
  visit("every", every_);
  visit("last", last_);
  visit.numbers("interval", interval_, intervals_before_);
}

/// Returns the number of whole intervals up to this time; one that a step completes up to rounding counts.
double FieldSchedule::intervals(double time) const { return std::floor(time / interval_ * (1.0 + 1e-12)); }

bool FieldSchedule::includes(const State& state) {
  bool result = every_ > 0 && state.step % every_ == 0;
  if (interval_ > 0.0) {
    const double now = intervals(state.time);
    result = now > intervals_before_;
    intervals_before_ = now;
  }
  if (state.step == 0) result = any();
  if (result) last_ = state.step;
  return result;
}

long FieldSchedule::frames(long steps, double end) const {
  if (interval_ > 0.0) {
    const double all = intervals(end), rest = end - all * interval_;
    return 1 + long(all) + (rest > 1e-9 * end ? 1 : 0);
  }
  if (every_ == 0) return 0;
  return 1 + steps / every_ + (steps % every_ != 0 ? 1 : 0);
}

OutputEstimate estimate_output(const Case& input, const Model& model) {
  constexpr double bytes_of_number = 18.0;  // length of the shortest text that reads back exactly, with its comma
  const long steps = step_count(input.time);
  OutputEstimate result;
  const FieldSchedule schedule(input, model, steps);
  if (schedule.any()) {
    const ResultsSize size = size_of_results(input, model);
    result.frames = schedule.frames(steps, input.time.end);
    result.frame_bytes = size.frame;
    result.results_bytes = size.of(result.frames);
  }
  result.rows = 1 + steps / input.output.history_every.value_or(make_scheme(input.time)->traits().history_every);
  result.history_bytes = bytes_of_number * double(history_columns(model).size()) * double(result.rows);
  result.is_limited = schedule.is_limited();
  result.is_adaptive = input.time.adaptive;
  result.is_compressed = input.output.compression > 0;
  return result;
}

std::string output_text(const OutputEstimate& estimate) {
  std::string text;
  if (estimate.frames > 0) {
    text += fmt::format(
        "{} of fields of {}, {} in total{}{}; ", counted(estimate.frames, "frame"), size_text(estimate.frame_bytes),
        size_text(estimate.results_bytes), estimate.is_compressed ? " before compression" : "",
        estimate.is_limited
            ? fmt::format(" (as many as fit into {}, since the case does not state how many)", size_text(most_bytes))
            : "");
  }
  return text + fmt::format("history.csv of {}{}", estimate.is_adaptive ? "at least " : "about ",
                            size_text(estimate.history_bytes));
}

}  // namespace ricochet
