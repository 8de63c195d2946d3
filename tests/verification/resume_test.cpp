#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/case/names.hpp"
#include "ricochet/run/run_case.hpp"
#include "support/case_run.hpp"
#include "support/same_snapshots.hpp"
#include "support/thrown_body.hpp"

// A simulation resumed from a snapshot gives the same bits as an uninterrupted one: for every registered scheme, mass
// and multiplier space, for every way to solve a step, with friction, moving obstacles, varying loads, damping and
// supports. The whole snapshot at the end is compared, so that it includes everything on which a later step could
// depend.

namespace ricochet {
namespace resume_test {

using test_support::CaseRun;
using test_support::dragged_case;
using test_support::expect_same;
using test_support::snapshot_of;
using test_support::thrown_bodies;
using test_support::ThrownBody;

/// Runs a case with snapshots and resumes from each of them. Returns false if the program refuses such a case.
bool resumes_to_the_same_bits(const std::string& text, const std::set<long>& at) {
  std::unique_ptr<CaseRun> run;
  try {
    run = std::make_unique<CaseRun>(text);
  } catch (const Error& problem) {
    EXPECT_EQ(problem.kind(), ErrorKind::invalid_input) << problem.what() << text;
    return false;
  }
  std::map<long, Snapshot> snapshots;
  bool touches = false;
  run->run([&] {
    const State& state = run->state();
    touches = touches || (state.forces.normal_reaction.array() > 0.0).any();
    if (at.contains(state.step)) snapshots[state.step] = snapshot_of(run->simulation());
  });
  EXPECT_TRUE(touches) << text;
  EXPECT_EQ(snapshots.size(), at.size());
  const Snapshot end = snapshot_of(run->simulation());
  for (const auto& [step, snapshot] : snapshots) {
    const std::unique_ptr<Scheme> scheme = make_scheme(run->input().time);
    Simulation resumed(run->problem(), *scheme, snapshot, step_solver_options(run->input()),
                       step_control_options(run->input().time));
    expect_same(snapshot, snapshot_of(resumed), "before a step");
    while (resumed.state().step < run->state().step) resumed.advance();
    expect_same(end, snapshot_of(resumed), "from step " + std::to_string(step) + " of\n" + text);
    const Energies energies = resumed.account().energies(resumed.state());
    EXPECT_EQ(resumed.account().residual(energies), run->simulation().account().residual(energies));
  }
  return true;
}

TEST(Resume, EverySchemeMassAndMultiplierSpace) {
  // With contact on one side, which admits every mass.
  const ThrownBody block = test_support::one_sided_block();
  std::map<std::string, int> runs;
  for (const test_support::Discretization& each : test_support::all_discretizations()) {
    std::string text = dragged_case(block, each.mass, each.time(), each.contact());
    text.replace(text.find("end = 1.5"), 9, "end = 0.4");
    EXPECT_EQ(resumes_to_the_same_bits(text, {0, 1, 7, 23, 39}), each.is_possible()) << each.label();
    if (!each.is_possible()) continue;
    for (const std::string& name : {each.scheme, each.mass, each.multipliers}) ++runs[name];
  }
  for (const auto& names : {scheme_names(), mass_names(), multiplier_space_names()}) {
    for (const std::string& name : names) EXPECT_GT(runs[name], 0) << name;
  }
}

struct Variant {
  std::string name, time, mass, contact, more;
  std::size_t body;
};

class ResumeVariant : public ::testing::TestWithParam<Variant> {};

TEST_P(ResumeVariant, GoesOnWithTheSameBits) {
  const Variant& variant = GetParam();
  const ThrownBody body = thrown_bodies()[variant.body];
  EXPECT_TRUE(resumes_to_the_same_bits(dragged_case(body, variant.mass, variant.time, variant.contact) + variant.more,
                                       {2, 40, 75, 149}));
}

const std::string newmark = "scheme = \"newmark\"\npreset = \"trapezoidal\"\n";
const std::string friction = "friction = 0.3\n";

INSTANTIATE_TEST_SUITE_P(
    All, ResumeVariant,
    ::testing::Values(Variant{"Frictionless", newmark, "equivalent", "", "", 0},
                      Variant{"AllPoints", newmark, "equivalent", friction, "[solver]\ncontact_points = \"all\"\n", 1},
                      Variant{"Iterative", newmark, "equivalent", friction, "[solver]\nmethod = \"iterative\"\n", 0},
                      Variant{"IterativeBall", newmark, "consistent", friction, "[solver]\nmethod = \"iterative\"\n",
                              3},
                      Variant{"Ball", newmark, "equivalent", friction, "", 3},
                      Variant{"ReducedKaneBall", "scheme = \"reduced-kane\"\n", "equivalent", friction, "", 3},
                      Variant{"AdaptiveBall", "scheme = \"reduced-kane\"\nreaction_weight = \"adaptive\"\n",
                              "equivalent", friction, "", 3},
                      Variant{"MeanReactionBall", "scheme = \"mean-reaction\"\n", "equivalent", "",
                              "[solver]\nmethod = \"iterative\"\n", 3},
                      Variant{"CurvedBall", "scheme = \"klr-conserving\"\n", "consistent", friction, "", 4},
                      Variant{"CurvedDiscP1", newmark, "equivalent", "friction = 0.5\nmultipliers = \"p1\"\n", "", 2},
                      Variant{"ExplicitBall", "scheme = \"semi-explicit\"\n", "equivalent-lumped", friction, "", 3}),
    [](const auto& info) { return info.param.name; });

/// Rows that follow the motion: a disc that slides and rolls in a moving hollow.
TEST(Resume, CurvedObstacle) {
  for (const char* const scheme : {"newmark", "klr-conserving", "contact-stabilized"}) {
    const std::string mass = scheme == std::string("newmark") ? "equivalent" : "consistent";
    std::string text = dragged_case(thrown_bodies()[0], mass, test_support::time_of(scheme), "friction = 0.3\n");
    const std::string plane = "type = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.1, 1.0]\n";
    text.replace(text.find(plane), plane.size(),
                 "type = \"sphere\"\ncentre = [0.1, 3.0]\nradius = 3.0\nside = \"inside\"\n");
    EXPECT_TRUE(resumes_to_the_same_bits(text, {0, 3, 40, 75, 149})) << scheme;
  }
}

/// Lengths of steps, their operators and refused attempts.
TEST(Resume, AdaptiveSteps) {
  for (const char* const scheme : {"reduced-kane", "generalized-alpha", "bathe", "laursen-love"}) {
    const std::string mass = test_support::masses_of(scheme).back();
    std::string text =
        dragged_case(test_support::one_sided_block(), mass, test_support::time_of(scheme), "friction = 0.3\n");
    text.replace(text.find("step = 0.01\n"), 12, "step = \"adaptive\"\nlargest = 0.1\ntolerance = 1e-3\n");
    EXPECT_TRUE(resumes_to_the_same_bits(text, {0, 1, 7, 23, 61})) << scheme;
  }
}

/// Entries that another one of the same type takes the place of: the next number, none, and one too many.
std::vector<Snapshot::Value> damaged(const Snapshot::Value& value) {
  if (const auto* texts = std::get_if<Snapshot::Texts>(&value)) {
    std::vector<Snapshot::Value> result{Snapshot::Texts(texts->size(), "x")};
    for (std::size_t k = 0; k < texts->size(); ++k) {
      Snapshot::Texts fewer = *texts;
      fewer.erase(fewer.begin() + std::ptrdiff_t(k));
      result.emplace_back(fewer);
    }
    return result;
  }
  if (const auto* integers = std::get_if<Snapshot::Integers>(&value)) {
    std::vector<Snapshot::Value> result{Snapshot::Integers{}};
    for (const std::int64_t change : {std::int64_t{-1}, std::int64_t{1}, std::int64_t{1} << 40}) {
      Snapshot::Integers changed = *integers;
      for (std::int64_t& each : changed) each += change;
      result.emplace_back(changed);
    }
    return result;
  }
  const auto& reals = std::get<Vector>(value);
  return {Vector(), Vector(Vector::Constant(reals.size() + 1, 1.0)), Vector(Vector::Constant(reals.size(), -1e300)),
          Vector(Vector::Constant(reals.size(), std::nan("")))};
}

/// A snapshot may contain anything: with a changed entry the simulation goes on, or an Error says what is wrong.
TEST(Resume, DamagedEntriesEndInNoOtherError) {
  const ThrownBody disc = thrown_bodies()[0];
  const std::string linear = dragged_case(disc, "equivalent", "scheme = \"reduced-kane\"\n", friction);
  std::string finite = linear;
  finite.insert(finite.find("density"), "law = \"neo-hookean\"\n");
  const std::string iterative =
      dragged_case(disc, "equivalent", newmark, friction) + "[solver]\nmethod = \"iterative\"\n";
  const auto with_memory = [&](const std::string& scheme) {
    return dragged_case(disc, test_support::masses_of(scheme).back(), test_support::time_of(scheme),
                        test_support::takes_friction(scheme) ? friction : "");
  };
  for (const std::string& text : {linear, finite, iterative, with_memory("nonsmooth-generalized-alpha"),
                                  with_memory("semi-explicit"), with_memory("paoli-schatzman")}) {
    CaseRun run(text);
    for (int step = 0; step < 75; ++step) run.simulation().advance();
    const Snapshot whole = snapshot_of(run.simulation());
    int refused = 0;
    for (const auto& [name, value] : whole.values()) {
      for (const Snapshot::Value& other : damaged(value)) {
        Snapshot changed = whole;
        changed.set(name, other);
        try {
          const std::unique_ptr<Scheme> scheme = make_scheme(run.input().time);
          Simulation resumed(run.problem(), *scheme, changed, step_solver_options(run.input()),
                             step_control_options(run.input().time));
          resumed.advance();
        } catch (const Error&) {
          ++refused;
        } catch (const std::exception& problem) {
          ADD_FAILURE() << name << ": " << problem.what() << "\n" << text;
        }
      }
    }
    EXPECT_GT(refused, int(whole.values().size())) << text;
  }
}

/// Cases in which schemes keep more than the state vectors.
TEST(Resume, MovingSupports) {
  for (const auto& [scheme, text] : test_support::moving_support_cases())
    EXPECT_TRUE(resumes_to_the_same_bits(text, {0, 3, 60, 61, 150, 199})) << scheme;
}

}  // namespace resume_test
}  // namespace ricochet
