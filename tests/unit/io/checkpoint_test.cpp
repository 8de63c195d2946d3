#include "ricochet/io/checkpoint.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/io/rank_checkpoints.hpp"
#include "ricochet/version.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

Snapshot example() {
  Snapshot snapshot;
  snapshot.save("numbers", Vector(Vector::LinSpaced(100, -1.0, 1.0)));
  Vector special(5);
  special << -0.0, std::numeric_limits<double>::infinity(), std::nan("1"), 5e-324, 1.0 / 3.0;
  snapshot.save("special", special);
  snapshot.save("none", Vector());
  snapshot.save("points", Snapshot::Integers{3, -1, std::numeric_limits<std::int64_t>::max()});
  snapshot.save("no points", Snapshot::Integers{});
  snapshot.save("texts", Snapshot::Texts{"", "two\nlines", std::string("a\0b", 3)});
  snapshot.save("flag", std::int64_t{1});
  return snapshot;
}

/// Corrects the checksum at the end, so that damage is not detected by it.
std::string with_checksum(std::string text) {
  text.resize(text.size() - 4);
  const std::uint32_t sum = Checksum().add(text.data(), text.size()).value();
  return text.append(reinterpret_cast<const char*>(&sum), sizeof(sum));
}

std::string refusal(const std::string& text) {
  return message_of([&] { static_cast<void>(decode_snapshot(text)); });
}

std::string folder_of_test() { return std::filesystem::path(write_temporary("x", "")).parent_path().string(); }

Snapshot of_step(std::int64_t step, const std::string& written_by = version) {
  Snapshot snapshot;
  snapshot.save("step", step);
  if (!written_by.empty()) snapshot.save("identity.version", written_by);
  return snapshot;
}

TEST(Checkpoint, ComesBackBitByBit) {
  const Snapshot snapshot = example();
  const std::string text = encode_snapshot(snapshot);
  const Snapshot again = decode_snapshot(text);
  EXPECT_EQ(encode_snapshot(again), text);
  EXPECT_TRUE(std::signbit(again.reals("special")[0]));
  EXPECT_TRUE(std::isnan(again.reals("special")[2]));
  EXPECT_EQ(again.texts("texts"), snapshot.texts("texts"));
  EXPECT_EQ(again.integers("points"), snapshot.integers("points"));
  EXPECT_EQ(again.integer("flag"), 1);
}

TEST(Checkpoint, EveryBitThatChangesIsSeen) {
  const std::string text = encode_snapshot(example());
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string damaged = text;
    damaged[at] = char(damaged[at] ^ (1 << (at % 8)));
    EXPECT_NE(refusal(damaged), "") << at;
    EXPECT_NE(refusal(text.substr(0, at)), "") << at;
  }
  EXPECT_NE(refusal(text + "x"), "");
}

/// An absurd count is not tried, even if the checksum is right.
TEST(Checkpoint, AbsurdSizesAreRefused) {
  const std::string text = encode_snapshot(example());
  std::mt19937_64 random(3);
  for (std::size_t at = 20; at + 12 < text.size(); ++at) {
    for (const std::uint64_t value : {~std::uint64_t{0}, std::uint64_t{1} << 62, std::uint64_t{1} << 33, random()}) {
      std::string damaged = text;
      damaged.replace(at, 8, reinterpret_cast<const char*>(&value), 8);
      static_cast<void>(refusal(with_checksum(damaged)));  // refused or read, but nothing else happens
    }
  }
  std::string damaged = text;
  const std::uint64_t count = std::uint64_t{1} << 61;
  damaged.replace(damaged.find("numbers") + 8, 8, reinterpret_cast<const char*>(&count), 8);
  EXPECT_EQ(refusal(with_checksum(damaged)), "a value is longer than the file");
}

TEST(Checkpoint, TheLastTwoAreKept) {
  const std::string folder = folder_of_test();
  for (const long step : {7L, 100L, 20L, 3000000000L}) write_checkpoint(folder, step, of_step(step));
  const std::vector<CheckpointFile> files = checkpoint_files(folder);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].step, 100);
  EXPECT_EQ(files[1].step, 3000000000);
  EXPECT_EQ(newest_checkpoint(folder)->integer("step"), 3000000000);
  std::ofstream(files[1].path) << "no checkpoint";
  log::set_level(log::Level::off);
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  EXPECT_EQ(newest_checkpoint(folder)->integer("step"), 100);
  std::ofstream(files[0].path) << "";
  EXPECT_FALSE(newest_checkpoint(folder).has_value());
  EXPECT_EQ(warnings.size(), 3u);
}

TEST(Checkpoint, APipeInItsPlaceIsPassedOver) {
  const std::string folder = folder_of_test();
  write_checkpoint(folder, 7, of_step(7));
  std::filesystem::remove(folder + "/checkpoint-000000008.ckpt");  // left by an earlier run
  ASSERT_EQ(mkfifo((folder + "/checkpoint-000000008.ckpt").c_str(), 0600), 0);
  log::set_level(log::Level::off);
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  EXPECT_EQ(newest_checkpoint(folder)->integer("step"), 7);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(has(warnings.front(), "it is not a regular file"));
}

/// An earlier checkpoint is not used instead: it belongs to the same run.
TEST(Checkpoint, OfAnotherVersionIsRefusedWithBothVersions) {
  const std::string folder = folder_of_test();
  for (const auto& file : checkpoint_files(folder)) std::filesystem::remove(file.path);
  write_checkpoint(folder, 6, of_step(6));
  for (const std::string other : {"0.2.0", ""}) {
    write_checkpoint(folder, 7, of_step(7, other));
    write_rank_checkpoint(one_rank(), folder, 7, of_step(7, other));
    const std::vector<std::string> parts{"checkpoint-000000007.ckpt: written by " +
                                             (other.empty() ? "a version of Ricochet before" : "Ricochet " + other),
                                         "which reads results of version",
                                         "repeat the run with --force, or continue it with the version that wrote it"};
    expect_error(ErrorKind::invalid_input, parts, [&] { static_cast<void>(newest_checkpoint(folder)); });
    expect_error(ErrorKind::invalid_input, parts,
                 [&] { static_cast<void>(newest_rank_checkpoint(one_rank(), folder)); });
  }
  write_rank_checkpoint(one_rank(), folder, 7, of_step(7));
  EXPECT_EQ(newest_rank_checkpoint(one_rank(), folder)->integer("step"), 7);
}

TEST(Snapshot, SaysWhatDoesNotFit) {
  const Snapshot snapshot = example();
  EXPECT_EQ(message_of([&] { static_cast<void>(snapshot.reals("numbers", 99)); }),
            "the saved state does not fit: numbers has 100 numbers where 99 are expected");
  EXPECT_EQ(message_of([&] { static_cast<void>(snapshot.real("other")); }),
            "the saved state does not fit: other is missing");
  EXPECT_EQ(message_of([&] { static_cast<void>(snapshot.text("numbers")); }),
            "the saved state does not fit: numbers does not hold texts");
  EXPECT_EQ(message_of([&] { static_cast<void>(snapshot.integers("points", 0, 10)); }),
            "the saved state does not fit: points has -1, which is not from 0 to 10");
}

}  // namespace
}  // namespace ricochet::test_support
