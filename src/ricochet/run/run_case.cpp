#include "ricochet/run/run_case.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ricochet/base/log.hpp"
#include "ricochet/run/session.hpp"

namespace ricochet {

void warn_of_end(const TimeSection& time) {
  if (time.adaptive) return;
  const double end = run_end(time);
  if (std::abs(end - time.end) <= 1e-9 * time.end) return;
  log::warning(
      fmt::format("{}{:.9g} is not a whole number of steps of {:.9g}: the run ends at t = {:.9g}, after step {}",
                  end_warning, time.end, time.step, end, step_count(time)));
}

RunSummary run_case(Session& session, const RunOptions& options) {
  RunOptions own = options;
  own.resume_load = false;  // nobody would set it again
  session.write_to(own);
  session.run();
  return session.finish();
}

RunSummary run_case(const Case& input, const RunOptions& options) {
  Session session(input);
  return run_case(session, options);
}

}  // namespace ricochet
