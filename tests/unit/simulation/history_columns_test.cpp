#include "ricochet/simulation/history/history_columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/simulation/history/history.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/history/quantity_sensor.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Descriptions of columns, and a kind of probe that a program adds.
namespace ricochet {
namespace {

using test_support::CaseRun;

TEST(HistoryColumns, AreDocumentedAndUnique) {
  std::set<std::string> names;
  for (const auto& quantity : history_quantities()) {
    EXPECT_FALSE(quantity.unit.empty() || quantity.text.empty()) << quantity.name;
    EXPECT_TRUE(names.insert(quantity.name).second) << quantity.name;
    const bool is_conditional = !std::string(quantity.condition.words).empty();
    const std::vector<std::string> standard = standard_column_names(2);
    if (quantity.components != ColumnComponents::one) continue;
    EXPECT_NE(std::ranges::count(standard, quantity.name) > 0, is_conditional) << quantity.name;
  }
  EXPECT_EQ(standard_column_names(3).size(), standard_column_names(2).size() + 4);  // two vectors and one axial vector
}

/// The residual is E + algorithmic energy − their initial values − Σ works + dissipations − integration error.
TEST(HistoryColumns, OfTheBalanceAddUpToItsResidual) {
  CaseRun run(test_support::thrown_case(test_support::one_sided_block(), "equivalent",
                                        "scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "friction = 0.3\n"));
  const auto balance = [&] {
    const auto terms = balance_of(run.state(), run.simulation().account());
    return std::map<std::string, double>(terms.begin(), terms.end());
  };
  const auto change = [](const std::map<std::string, double>& now) {
    double sum = now.at("total_energy") + now.at("algorithmic_energy") + now.at("numerical_dissipation") +
                 now.at("viscous_dissipation") - now.at("integration_error");
    for (const std::string& work : column_names_of(ColumnGroup::work)) sum -= now.at(work);
    return sum;
  };
  const double start = change(balance());
  for (int step = 0; step < 60; ++step) run.simulation().advance();
  const std::map<std::string, double> now = balance();
  EXPECT_NE(now.at("friction_work"), 0.0);
  EXPECT_NEAR(change(now) - start, now.at("energy_residual"), 1e-12 * now.at("total_energy"));
}

/// Counts the nodes of a boundary.
class NodeCount final : public QuantitySensor<NodeCount> {
 public:
  NodeCount(const ProbeContext& setting, const ProbeTargets& targets)
      : QuantitySensor(setting.name + ".", setting.problem), count_(double(targets.nodes.size())) {}
  static const Quantities& quantities() {
    static const Quantities all{{{"nodes", "1", "number of nodes"}, member_value(&NodeCount::count_)}};
    return all;
  }
  void evaluate(const Observation&) {}

 private:
  double count_;
};

Registration<ProbeKind> count_probe() {
  return {.name = "count",
          .type = {.quantities = NodeCount::descriptions(),
                   .of_boundary = true,
                   .find =
                       [](const ProbeContext& setting, ProbeTargets& targets) {
                         targets.nodes = facet_nodes(*setting.body.space, setting.boundary("count"));
                       },
                   .make = [](const ProbeContext& setting, const ProbeTargets& targets) -> SensorList {
                     return {std::make_shared<NodeCount>(setting, targets)};
                   }},
          .keys = {{.name = "count", .type = KeyType::groups, .doc = "A boundary."}},
          .alternatives = {{"count"}}};
}

TEST(ProbeKinds, OfAProgramAreReadFoundAndRecorded) {
  const std::string text =
      test_support::thrown_case(test_support::one_sided_block(), "consistent", "scheme = \"midpoint\"\n") +
      "\n[[probe]]\nname = \"skin\"\ncount = [\"boundary\"]\n";
  EXPECT_THROW(CaseRun{text}, Error);
  probe_registry().add(count_probe());
  CaseRun run(text);
  HistoryRecorder recorder(run.problem(), *run.model().rotation, run.model().sensors);
  const std::vector<double> row = recorder.row(run.state(), run.simulation().account());
  std::set<Index> nodes;
  for (const CellBlock& block : run.model().space.facets) {
    for (Index facet = 0; facet < block.size(); ++facet)
      nodes.insert(block.cell(facet), block.cell(facet) + block.nodes_per_cell);
  }
  EXPECT_EQ(row[column_index(recorder.columns(), "skin.nodes")], double(nodes.size()));
  EXPECT_NE(column_reference().find("| `NAME.nodes` | 1 | probes with `count` | number of nodes |"), std::string::npos);
  EXPECT_THROW(CaseRun{text + "about = [0, 0]\n"}, Error);  // a key of another kind
  probe_registry().remove("count");
  EXPECT_THROW(CaseRun{text}, Error);
}

}  // namespace
}  // namespace ricochet
