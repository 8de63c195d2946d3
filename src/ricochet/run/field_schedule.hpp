#pragma once

#include <string>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/results_size.hpp"
#include "ricochet/model/model.hpp"

/// @file Steps after which fields are written, and how much a run writes.
namespace ricochet {

/// Text like "12 MB", "1.2 GB".
[[nodiscard]] std::string size_text(double bytes);
[[nodiscard]] ResultsOptions results_options(const OutputSection& output);

class FieldSchedule {
 public:
  /// If the case does not say how often, that depends on the number of steps and on the size of a frame. A run that
  /// goes on keeps what it began with, as its end may have been moved.
  FieldSchedule(const Case& input, const Model& model, long steps, const Snapshot* snapshot = nullptr);
  void save(Snapshot& snapshot) const;
  [[nodiscard]] bool any() const { return every_ > 0 || interval_ > 0.0; }
  /// Asks whether a frame follows a step; asked of every step, in order.
  [[nodiscard]] bool includes(const State& state);
  /// Whether this step was the last that was included.
  [[nodiscard]] bool is_last(const State& state) const { return last_ == state.step; }
  /// Number of frames of a run of so many steps up to a time, those of its start and its end included.
  [[nodiscard]] long frames(long steps, double end) const;
  /// Whether there are fewer than a small body would have.
  [[nodiscard]] bool is_limited() const { return is_limited_; }

 private:
  [[nodiscard]] double intervals(double time) const;

  long every_ = 0;
  double interval_ = 0.0;  ///< time, instead
  double intervals_before_ = 0.0;
  long last_ = -1;  ///< step that was included
  bool is_limited_ = false;
};

/// Files of a run, in bytes, before it begins and without compression.
struct OutputEstimate {
  long frames = 0, rows = 0;
  double frame_bytes = 0.0, results_bytes = 0.0, history_bytes = 0.0;
  bool is_limited = false;     ///< fewer frames than a small body would have
  bool is_adaptive = false;    ///< rows are those of the longest steps
  bool is_compressed = false;  ///< what is written is less
};
[[nodiscard]] OutputEstimate estimate_output(const Case& input, const Model& model);
/// Text like "101 frames of fields of 1.9 MB, 190 MB in all; history.csv of some 4.2 MB".
[[nodiscard]] std::string output_text(const OutputEstimate& estimate);

}  // namespace ricochet
