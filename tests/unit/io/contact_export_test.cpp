#include "ricochet/io/contact_export.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/failure_bundle.hpp"
#include "ricochet/version.hpp"
#include "support/errors.hpp"
#include "support/fclib_support.hpp"

namespace ricochet::test_support {
namespace {

namespace fs = std::filesystem;

struct TemporaryDirectory {
  std::string path = TemporaryFile().path + ".d";
  ~TemporaryDirectory() { fs::remove_all(path); }
};

TEST(ContactExport, Steps) {
  const std::vector<StepRange> steps = parse_steps("10,20,50:60,7:7");
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[1].first, 20);
  EXPECT_EQ(steps[1].last, 20);
  EXPECT_EQ(steps[2].first, 50);
  EXPECT_EQ(steps[2].last, 60);
  EXPECT_EQ(steps[3].last, 7);
}

TEST(ContactExport, StepsThatAreNone) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "\"\" is empty"},
      {"10,", "\"\" is empty"},
      {",10", "\"\" is empty"},
      {"x", "\"x\" is neither a step nor a range of steps"},
      {"10,1.5", "\"1.5\" is neither"},
      {"1 0", "\"1 0\" is neither"},
      {"1:2:3", "\"1:2:3\" is neither"},
      {":3", "\":3\" is neither"},
      {"3:", "\"3:\" is neither"},
      {"5:3", "\"5:3\" ends before it begins"},
      {"0:3", "names step 0, the initial state"},
      {"-1", "names a negative step"},
      {"99999999999999999999", "is too large for a step number"},
  };
  for (const auto& [text, expected] : cases)
    expect_error(ErrorKind::usage, {expected}, [steps = text] { (void)parse_steps(steps); });
}

/// Two points without friction, one of them eligible.
ContactProblem problem() {
  ContactProblem result(1, Matrix::Identity(2, 2) * 4.0, Vector::Constant(2, -8.0), 0.0);
  result.eligible = {0, 1};
  result.reaction_scale = 0x1p-20;
  return result;
}

ContactSolution solution() {
  ContactSolution result;
  result.reaction = Eigen::Vector2d(0.0, 2.0);
  result.motion = Eigen::Vector2d(-8.0, 0.0);
  result.outcome = ContactOutcome::solved;
  return result;
}

TEST(ContactExport, WritesTheStepsAskedForInUnitsOfTheCase) {
  const TemporaryDirectory directory;
  ContactExport contact_export({{2, 3}, {5, 5}, {9, 9}}, directory.path, {"Title", "origin", 2, 0.5});
  for (long step = 1; step <= 5; ++step) {
    contact_export.begin_step(step);
    if (step == 5) continue;  // no point may touch
    contact_export.write(problem(), solution());
    if (step == 3) contact_export.write(problem(), solution());
  }
  const std::vector<std::string> files = exported_contact_problems(directory.path);
  ASSERT_EQ(files.size(), 3u);
  EXPECT_TRUE(files[0].ends_with("/step-000002.hdf5"));
  EXPECT_TRUE(files[1].ends_with("/step-000003-stage-2.hdf5"));
  EXPECT_TRUE(files[2].ends_with("/step-000003.hdf5"));
  const FclibProblem read = read_fclib(files[0]);
  EXPECT_EQ(read.points, std::vector<Index>{1});
  EXPECT_EQ(read.w.coeff(0, 0), 0x1p-18);
  EXPECT_EQ(read.w.coeff(1, 1), 0x1p-18);
  EXPECT_EQ(read.q, Eigen::Vector2d(-8.0, 0.0));
  ASSERT_TRUE(read.solution.has_value());
  EXPECT_EQ(read.solution->reaction, Eigen::Vector2d(0x1p21, 0.0));
  EXPECT_EQ(read.solution->motion, Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(read.title, "Title: step 2, t = 1");
  EXPECT_EQ(read_fclib(files[1]).title, "Title: step 3, stage 2, t = 1.5");
  EXPECT_TRUE(has(read.description, "origin"));
  EXPECT_EQ(contact_export.report(), "contact problems of 2 steps in " + directory.path +
                                         " (3 files); 1 had none (no point could touch); steps after 5 were not "
                                         "reached");
}

TEST(ContactExport, OnlyItsOwnFilesCount) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(exported_contact_problems(directory.path).empty());
  fs::create_directories(directory.path);
  for (const char* name :
       {"notes.txt", "step-1.hdf5", "step-000001.hdf5.part", "step-000001.hdf5", "step-1000000.hdf5"})
    std::ofstream(fs::path(directory.path) / name) << "x";
  EXPECT_EQ(exported_contact_problems(directory.path).size(), 2u);
}

TEST(ContactExport, AFileInThePlaceOfTheDirectory) {
  const TemporaryFile file;
  std::ofstream(file.path) << "x";
  expect_error(ErrorKind::file_access, {file.path + ": cannot create this directory"}, [&] {
    ContactExport({{1, 1}}, file.path, {});
  });
}

/// An unsolved contact problem can be read and solved later; a problem that FCLib cannot state is reported.
TEST(FailureBundle, HoldsTheStateAndTheProblem) {
  const TemporaryDirectory directory;
  fs::create_directories(directory.path);
  FailureBundle bundle(directory.path, {"Title", "origin", 2, 0.5});
  ContactSolution unsolved = solution();
  unsolved.outcome = ContactOutcome::not_converged;
  unsolved.reason = "it circles";
  bundle.write_problem(problem(), unsolved, 7);
  Snapshot snapshot;
  snapshot.save("state.step", std::int64_t{6});
  snapshot.save("identity.version", std::string(version));
  const std::string note = bundle.write(7, snapshot, "step 7: what failed");
  const std::vector<std::string> files = failure_files(directory.path);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_TRUE(files[0].ends_with("/failure-000000007.ckpt"));
  EXPECT_TRUE(files[1].ends_with("/failure-000000007.hdf5"));
  for (const std::string& file : files) EXPECT_TRUE(has(note, file));
  const Snapshot read = read_checkpoint(files[0]);
  EXPECT_EQ(read.text("failure.message"), "step 7: what failed");
  EXPECT_EQ(read.integer("state.step"), 6);
  const FclibProblem stated = read_fclib(files[1]);
  EXPECT_TRUE(has(stated.description, "This problem was not solved: it circles."));
  EXPECT_TRUE(has(stated.title, "step 7, t = 3.5"));
  // The reactions at which the solver stopped, in the units of W: those of the case.
  EXPECT_FALSE(stated.solution.has_value());
  ASSERT_EQ(stated.guesses.size(), 1u);
  EXPECT_EQ(stated.guesses[0].reaction, Eigen::Vector2d(0x1p21, 0.0));
  EXPECT_EQ(stated.w.coeff(0, 0), 0x1p-18);

  ContactProblem bounded = problem();
  bounded.friction_bound = Vector::Ones(2);
  FailureBundle other(directory.path, {"Title", "origin", 2, 0.5});
  other.write_problem(bounded, unsolved, 8);
  EXPECT_TRUE(has(other.write(8, snapshot, ""), "the contact problem could not be written"));
}

/// If a second attempt solves the step, no file of the first is left, and a later failure does not name one.
TEST(FailureBundle, ForgetsTheProblemOfAStepThatWasSolved) {
  const TemporaryDirectory directory;
  fs::create_directories(directory.path);
  FailureBundle bundle(directory.path, {"Title", "origin", 2, 0.5});
  ContactSolution unsolved = solution();
  unsolved.outcome = ContactOutcome::not_converged;
  bundle.write_problem(problem(), unsolved, 7);
  EXPECT_EQ(failure_files(directory.path).size(), 1u);
  bundle.remove_problem();
  EXPECT_TRUE(failure_files(directory.path).empty());
  Snapshot snapshot;
  EXPECT_FALSE(has(bundle.write(9, snapshot, ""), "contact problem"));
}

}  // namespace
}  // namespace ricochet::test_support
