#include "ricochet/report/runs_figure.hpp"

#include <algorithm>

#include "ricochet/report/reading_runs.hpp"
#include "ricochet/report/run_data.hpp"
#include "ricochet/study/line_labels.hpp"

namespace ricochet {

std::string describe_figure_of(const std::vector<std::string>& directories, FigureOptions options) {
  if (options.labels.empty()) options.labels = labels_in_study(directories);
  const bool needs_fields = std::ranges::count(options.what, "pressure-map") > 0;
  std::string description;
  read_with_retries(directories, [&] { description = describe_figure(read_runs(directories, needs_fields), options); });
  return description;
}

}  // namespace ricochet
