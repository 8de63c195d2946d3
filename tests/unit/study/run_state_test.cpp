#include "ricochet/study/run_state.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/version.hpp"

namespace ricochet {
namespace {

RunState state(const std::string& summary_status, std::optional<int> exit_status = {}, bool has_checkpoint = false) {
  RunState result;
  if (!summary_status.empty()) {
    result.summary.emplace();
    result.summary->status = summary_status;
  }
  result.exit_status = exit_status;
  result.has_checkpoint = has_checkpoint;
  return result;
}

TEST(RunState, DecidesWhatIsStillToBeDone) {
  EXPECT_EQ(next_action(state("")), NextAction::start);
  EXPECT_EQ(next_action(state("running")), NextAction::resume) << "it was killed";
  EXPECT_EQ(next_action(state("interrupted")), NextAction::resume);
  EXPECT_EQ(next_action(state("", {}, true)), NextAction::resume) << "its summary is lost, its checkpoint is not";
  EXPECT_EQ(next_action(state("done")), NextAction::nothing);
  EXPECT_EQ(next_action(state("", 2)), NextAction::nothing) << "its case is refused again";
  EXPECT_EQ(next_action(state("failed", 3)), NextAction::nothing) << "its step fails again";
  EXPECT_EQ(next_action(state("running", 3)), NextAction::resume) << "out of memory";
  EXPECT_EQ(next_action(state("failed", 4)), NextAction::resume) << "the disk was full";
  EXPECT_EQ(next_action(state("running", 137)), NextAction::resume) << "its process was killed";
  EXPECT_EQ(next_action(state("", 4)), NextAction::start);
  EXPECT_EQ(next_action(state("done", 5)), NextAction::nothing);
  EXPECT_EQ(next_action(state("done", 139)), NextAction::resume) << "its process was killed after its last step";
}

TEST(RunState, SaysWhatHasBecomeOfIt) {
  EXPECT_EQ(state("").status_text(), "not run");
  EXPECT_EQ(state("running").status_text(), "interrupted");
  EXPECT_EQ(state("done").status_text(), "done");
  EXPECT_EQ(state("", 2).status_text(), "refused");
  EXPECT_EQ(state("failed", 3).status_text(), "failed");
  EXPECT_EQ(state("done", 139).status_text(), "failed");
  EXPECT_EQ(state("done", 139).final_status(), 139);
  RunState unexpected = state("done");
  unexpected.summary->expectations.push_back({.quantity = "a", .holds = false});
  EXPECT_EQ(unexpected.final_status(), 5);
  EXPECT_EQ(unexpected.status_text(), "done");
  unexpected.summary->expectations.front().checked = false;
  EXPECT_EQ(unexpected.final_status(), 0);
}

TEST(RunState, IsReadFromItsDirectory) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path(), "ricochet-test");
  const std::string directory = folder.path().string();
  EXPECT_EQ(read_run_state(directory + "/nowhere").status_text(), "not run");
  record_exit_status(directory, 2, "case.toml:3:1: no");
  EXPECT_EQ(read_run_state(directory).exit_status, 2);
  EXPECT_EQ(read_run_state(directory).message, "case.toml:3:1: no");
  record_exit_status(directory, 0, "");
  EXPECT_FALSE(read_run_state(directory).exit_status.has_value());
  RunSummary summary;
  summary.version = version;
  summary.expectations.push_back({.quantity = "q", .expected = "≤ 1", .holds = false});
  write_summary(folder.file("summary.json"), summary);
  EXPECT_EQ(read_run_state(directory).final_status(), 5);
  record_exit_status(directory, 139, "its process was killed by signal 11");
  EXPECT_EQ(read_run_state(directory).final_status(), 139);
  summary.steps = 1;
  write_summary(folder.file("summary.json"), summary);
  EXPECT_EQ(read_run_state(directory).final_status(), 5) << "it was run again by hand";
  record_exit_status(directory, 2, "case.toml:3:1: no");
  summary.status = "interrupted";
  write_summary(folder.file("summary.json"), summary);
  EXPECT_EQ(next_action(read_run_state(directory)), NextAction::resume) << "it was run again by hand, and stopped";
  std::ofstream(folder.file("summary.json")) << "{";
  EXPECT_FALSE(read_run_state(directory).summary.has_value());
}

TEST(RunState, OfAnotherVersionCountsAsNotRun) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path(), "ricochet-test");
  RunSummary summary;
  summary.version = "0.2.9";
  write_summary(folder.file("summary.json"), summary);
  std::ofstream(folder.file("checkpoint-000000007.ckpt")) << "of that version";
  const RunState found = read_run_state(folder.path().string());
  EXPECT_EQ(found.status_text(), "not run");
  EXPECT_EQ(next_action(found), NextAction::start) << "its checkpoint cannot be continued";
  EXPECT_NE(found.message.find("written by Ricochet 0.2.9; this is Ricochet"), std::string::npos) << found.message;
  EXPECT_NE(found.message.find("--resume repeats this run"), std::string::npos) << found.message;
}

TEST(LastError, IsTheFirstLineOfTheLastThatWasSaid) {
  EXPECT_EQ(last_error("warning: a\nricochet: runs/1: one\nand more\nricochet: runs/1: two\nfiles\n", "runs/1"), "two");
  EXPECT_EQ(last_error("ricochet: case.toml:1:1: three", "runs/1"), "case.toml:1:1: three");
  EXPECT_EQ(last_error("nothing of it\n", "runs/1"), "");
}

TEST(WorseStatus, RanksWhatAUserShouldHearFirst) {
  const int ranks[] = {0, 5, 2, 3, 4, 1, 70};
  for (std::size_t i = 0; i + 1 < std::size(ranks); ++i) {
    EXPECT_EQ(worse_status(ranks[i], ranks[i + 1]), ranks[i + 1]);
    EXPECT_EQ(worse_status(ranks[i + 1], ranks[i]), ranks[i + 1]);
  }
}

}  // namespace
}  // namespace ricochet
