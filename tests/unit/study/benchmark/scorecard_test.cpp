#include "ricochet/study/benchmark/scorecard.hpp"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

BenchmarkRun run_of(const std::string& benchmark, const std::string& group, const std::string& scheme,
                    const std::string& mass, bool is_own) {
  BenchmarkRun run;
  run.benchmark = {benchmark, "/" + benchmark + ".toml", group, ""};
  run.method = run.scheme = scheme;
  run.mass = mass;
  run.is_own_method = is_own;
  return run;
}

BenchmarkRunResult outcome_of(const std::string& status, double created, double lost,
                              std::vector<ExpectationResult> expectations) {
  BenchmarkRunResult outcome;
  outcome.state.summary.emplace();
  outcome.state.summary->status = status;
  outcome.state.summary->steps = 30;
  outcome.state.summary->step = 0.01;
  outcome.state.summary->method_energy = MethodEnergy{lost, created, 0.0};
  outcome.expectations = std::move(expectations);
  return outcome;
}

BenchmarkRunResult refused(const std::string& why) {
  BenchmarkRunResult outcome;
  outcome.state.exit_status = 2;
  outcome.message = why;
  return outcome;
}

const ExpectationResult right{.name = "force",
                              .quantity = "max(history.f)",
                              .published = "others: 2.1",
                              .value = 2.25,
                              .expected = "2 within 0.5 absolute",
                              .expected_value = 2.0,
                              .tolerance = 0.5};
const ExpectationResult wrong{.quantity = "history.g[-1]",
                              .value = -3.0,
                              .expected = "≥ -1 and ≤ 1",
                              .minimum = -1.0,
                              .maximum = 1.0,
                              .holds = false};
const ExpectationResult unknown{
    .quantity = "summary.x", .expected = "≤ 1", .maximum = 1.0, .holds = false, .note = "no"};

struct Example {
  BenchmarkPlan plan{{"out"}, true, {}};
  BenchmarkResults results;

  Example() {
    plan.runs = {run_of("bar", "bars", "kane", "lumped", false), run_of("slope", "friction", "kane", "", false),
                 run_of("bar", "bars", "bathe", "equivalent", true),
                 run_of("slope", "friction", "bathe", "consistent", true)};
    BenchmarkRunResult failed = outcome_of("failed", 0.0, 0.0, {unknown});
    failed.state.exit_status = 3;
    failed.message = "step 31 did not converge";
    results.run_results = {outcome_of("done", 0.12, 0.034, {right, wrong}), refused("does not support friction"),
                           outcome_of("done", 1e-5, 0.0, {right}), failed};
  }
};

TEST(BenchmarkTable, HasAValueAndAnErrorForEachReference) {
  const Example example;
  EXPECT_EQ(to_csv(benchmark_table(example.plan, example.results)),
            "case,quantity,reference,value,error,tolerance,published,scheme,mass,holds\n"
            "bar,force,2,2.25,0.25,0.5,others: 2.1,kane,lumped,yes\n"
            "bar,history.g[-1],≥ -1 and ≤ 1,-3,-2,,,kane,lumped,no\n"
            "bar,force,2,2.25,0.25,0.5,others: 2.1,bathe,equivalent,yes\n"
            "slope,summary.x,≤ 1,,,,,bathe,consistent,no\n");
}

TEST(BenchmarkTable, MarksWhatDoesNotHold) {
  const Example example;
  const std::string text = to_aligned_text(benchmark_table_for_readers(example.plan, example.results, false));
  EXPECT_NE(text.find("≥ -1 and ≤ 1     -3     -2             kane    lumped      DOES NOT HOLD\n"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("others"), std::string::npos);
  EXPECT_EQ(benchmark_notes(example.plan, example.results),
            (std::vector<std::string>{"slope, bathe: failed at t = 0.3: step 31 did not converge",
                                      "2 of 4 expected values hold."}));
}

TEST(Scorecard, CountsByMethodAndBenchmark) {
  const Example example;
  const ScorecardMatrix matrix = scorecard_matrix(example.plan, example.results);
  EXPECT_EQ(to_markdown(matrix.totals),
            "| scheme | mass | benchmarks | all values hold | failed | refused | values | max. created | max. lost |\n"
            "|---|---|---:|---:|---:|---:|---|---|---|\n"
            "| kane | lumped | 1 | 0 | 0 | 1 | 1/2 | 12 % | 3.4 % |\n"
            "| bathe | equivalent or consistent | 2 | 1 | 1 | 0 | 1/2 | 0 % | 0 % |\n");
  ASSERT_EQ(matrix.parts.size(), 2u);
  EXPECT_EQ(matrix.parts[0].title, "bars");
  EXPECT_EQ(to_markdown(matrix.parts[0].table),
            "| scheme | mass | bar |\n|---|---|---|\n"
            "| kane | lumped | 1/2 +12 −3.4 % |\n| bathe | equivalent or consistent | 1/1 |\n");
  EXPECT_EQ(to_markdown(matrix.parts[1].table),
            "| scheme | mass | slope |\n|---|---|---|\n"
            "| kane | lumped | refused (1) |\n| bathe | equivalent or consistent | failed at t = 0.3 |\n");
  EXPECT_EQ(matrix.reasons, std::vector<std::string>{"does not support friction"});
}

TEST(Scorecard, IsExactForPrograms) {
  const Example example;
  const ResultTable table = scorecard_table(example.plan, example.results);
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(number_of(table.rows[0][table.find("created_percent")]), 12.0);
  EXPECT_EQ(number_of(table.rows[0][table.find("holds")]), 1.0);
  EXPECT_EQ(text_of(table.rows[1][table.find("applies")]), "");
  EXPECT_EQ(text_of(table.rows[1][table.find("status")]), "refused");
  EXPECT_EQ(text_of(table.rows[1][table.find("message")]), "does not support friction");
  EXPECT_EQ(text_of(table.rows[3][table.find("status")]), "failed at t = 0.3");
}

}  // namespace
}  // namespace ricochet
