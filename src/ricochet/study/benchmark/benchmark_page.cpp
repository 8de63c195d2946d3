#include "ricochet/study/benchmark/benchmark_page.hpp"

#include <fmt/format.h>

#include "ricochet/study/benchmark/scorecard.hpp"
#include "ricochet/study/page_parts.hpp"

namespace ricochet {

namespace {

constexpr const char* benchmark_page_mark = "ricochet benchmark";

std::string wide_table(const ResultTable& table) { return "<div class=\"wide\">\n" + to_html(table) + "</div>\n"; }

std::string matrix_in_html(const ScorecardMatrix& matrix) {
  std::string text = wide_table(matrix.totals);
  for (const ScorecardPart& part : matrix.parts) {
    if (!part.title.empty()) text += fmt::format("<h2>{}</h2>\n", escaped(part.title));
    text += wide_table(part.table);
  }
  if (matrix.reasons.empty()) return text;
  text += "<p>Refused:</p>\n<ol>\n";
  for (const std::string& reason : matrix.reasons) text += fmt::format("<li>{}</li>\n", escaped(reason));
  return text + "</ol>\n";
}

}  // namespace

std::string make_benchmark_page(const BenchmarkPlan& plan, const BenchmarkResults& results, const std::string& folder) {
  std::string page = page_begin(benchmark_page_mark, plan.is_scorecard ? "Scorecard" : "Benchmarks");
  page += html_list(benchmark_notes(plan, results));
  if (plan.is_scorecard) page += matrix_in_html(scorecard_matrix(plan, results)) + "<h2>Values</h2>\n";
  page += wide_table(benchmark_table_for_readers(plan, results, true));
  page += "<h2>Runs</h2>\n<ul>\n";
  for (const BenchmarkRun& run : plan.runs) {
    if (run.refusal.empty())
      page += fmt::format("<li>{}: {}</li>\n", html_link_to_run(plan.path(run), folder),
                          escaped(run.benchmark.description));
  }
  return page + "</ul>\n" + page_end();
}

bool is_benchmark_page(const std::string& path) { return is_page_with(benchmark_page_mark, path); }

}  // namespace ricochet
