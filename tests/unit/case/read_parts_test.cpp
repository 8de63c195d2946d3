#include <gtest/gtest.h>

#include "case_text.hpp"

// Sections [part.NAME] and [[motion]].
namespace ricochet::case_test {

namespace {

const std::string rest_of_case =
    "[[material]]\ngroup = \"all\"\ndensity = 1.0\nlambda = 1.0\nmu = 1.0\n[time]\nscheme = \"midpoint\"\nstep = 0.1\n"
    "end = 1.0\n";
const std::string two_parts = "[part.wall]\nfile = \"w.msh\"\n[part.ball]\nfile = \"b.step\"\n" + rest_of_case;

std::string expected_path(const std::string& name) { return (std::filesystem::temp_directory_path() / name).string(); }

}  // namespace

TEST(ReadParts, EveryKeyInTheOrderOfTheFile) {
  const Case read = read_text(
      "[mesh]\ndegree = 2\n[part.wall]\nfile = \"w.msh\"\n[part.ball]\nfile = \"b.step\"\nsize = 0.5\nscale = 2.0\n"
      "move = [0.0, 0.0, 12.0]\nturn = { axis = [0, 0, 1], angle = 30.0, about = [1, 2, 3] }\n"
      "velocity = [0.0, 0.0, -1.0]\nspin = [1, 2.5, 100.0]\n" +
      rest_of_case);
  ASSERT_EQ(read.parts.size(), 2U);  // not by name
  EXPECT_EQ(read.mesh.degree, 2);
  EXPECT_EQ(read.mesh.file, "");
  EXPECT_EQ(read.parts[0].name, "wall");
  EXPECT_EQ(read.parts[0].file, expected_path("w.msh"));
  EXPECT_FALSE(read.parts[0].size.has_value());
  EXPECT_EQ(read.parts[0].scale, 1.0);
  const PartSection& ball = read.parts[1];
  EXPECT_EQ(ball.name, "ball");
  EXPECT_EQ(ball.file, expected_path("b.step"));
  EXPECT_EQ(ball.size, 0.5);
  EXPECT_EQ(ball.scale, 2.0);
  EXPECT_EQ(ball.placement.move, (std::vector<double>{0.0, 0.0, 12.0}));
  ASSERT_EQ(ball.placement.rotations.size(), 1U);
  EXPECT_EQ(ball.placement.rotations[0].axis, (std::vector<double>{0.0, 0.0, 1.0}));
  EXPECT_EQ(ball.placement.rotations[0].about, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(ball.placement.rotations[0].angle, 30.0);
  ASSERT_EQ(read.motions.size(), 1U);  // the wall has none
  EXPECT_EQ(read.motions[0].section, "part.ball");
  EXPECT_EQ(read.motions[0].part, "ball");
  EXPECT_EQ(read.motions[0].velocity, (std::vector<double>{0.0, 0.0, -1.0}));
  EXPECT_EQ(read.motions[0].spin, (std::vector<double>{1.0, 2.5, 100.0}));
  EXPECT_EQ(read.values.at("part.ball.spin"), "[1, 2.5, 100]");
  EXPECT_EQ(read.values.at("part.wall.scale"), "1");
  EXPECT_FALSE(read.values.contains("mesh.scale"));
  EXPECT_EQ(read.where("part.ball.size").line, 7);
}

TEST(ReadParts, SeveralTurns) {
  const std::string text =
      "[part.ball]\nfile = \"b.msh\"\nturn = [{ angle = 30, axis = [0, 0, 1] }, { angle = 40, axis = "
      "[1, 0, 0] }]\n" +
      rest_of_case;
  const Case read = read_text(text, {"part.ball.turn.1.angle=50"});
  const std::vector<MeshRotation>& turns = read.parts.at(0).placement.rotations;
  ASSERT_EQ(turns.size(), 2U);
  EXPECT_EQ(turns[0].angle, 30.0);
  EXPECT_EQ(turns[1].angle, 50.0);
  EXPECT_EQ(turns[1].axis, (std::vector<double>{1.0, 0.0, 0.0}));
  EXPECT_EQ(read.values.at("part.ball.turn.1.angle"), "50");
  const auto problem = [&](const std::string& override) { return problems_of(text, {override}); };
  EXPECT_TRUE(has(problem("part.ball.turn.angle=3"),
                  "\"turn\" is a list: specify the entry, from turn.0.angle to turn.1.angle"));
  EXPECT_TRUE(has(problem("part.ball.turn.2.angle=3"), "from turn.0.angle to turn.1.angle"));
  EXPECT_TRUE(has(problem("part.ball.turn=[]"), "\"turn\" must be a table with"));
  EXPECT_TRUE(has(problem("part.ball.turn=[{ axis = [1, 0, 0] }]"), "\"turn\" of [part.ball] has no \"angle\""));
}

/// v = sqrt(2 g H) along gravity is added to the velocity: 5 m/s from 1.25 m under 10 m/s².
TEST(ReadParts, DroppedFromAHeight) {
  const std::string text =
      "[part.ball]\nfile = \"b.msh\"\ndrop_height = 1.25\nvelocity = [2, 0]\n[load]\ngravity = [0, -10]\n" +
      rest_of_case;
  const Case read = read_text(text);
  ASSERT_EQ(read.motions.size(), 1U);
  ASSERT_EQ(read.motions[0].velocity.size(), 2U);
  EXPECT_EQ(read.motions[0].velocity[0], 2.0);
  EXPECT_DOUBLE_EQ(read.motions[0].velocity[1], -5.0);
  EXPECT_TRUE(has(problems_of(text, {"load.gravity=[0, 0]"}), "the case has none: set \"gravity\" of [load]"));
  const Case whole =
      read_text("[mesh]\nfile = \"b.msh\"\ndrop_height = 5\n[load]\ngravity = [0, 0, -10]\n" + rest_of_case);
  ASSERT_EQ(whole.motions.size(), 1U);
  EXPECT_EQ(whole.motions[0].section, "mesh");
  ASSERT_EQ(whole.motions[0].velocity.size(), 3U);
  EXPECT_DOUBLE_EQ(whole.motions[0].velocity[2], -10.0);
}

TEST(ReadParts, RestOnAnObstacleThatIsThere) {
  const std::string floor = "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n";
  const std::string text =
      "[part.ball]\nfile = \"b.msh\"\nrest_on = \"floor\"\nrest_gap = 0.5\n" + floor + rest_of_case;
  const Case read = read_text(text);
  EXPECT_EQ(read.parts.at(0).rest_on, "floor");
  EXPECT_EQ(read.parts.at(0).rest_gap, 0.5);
  EXPECT_TRUE(
      has(problems_of(text, {"part.ball.rest_on=flor"}), "there is no [obstacle.flor]; did you mean \"floor\"?"));
  EXPECT_TRUE(
      has(problems_of("[part.ball]\nfile = \"b.msh\"\nrest_gap = 0.5\n" + rest_of_case), "set \"rest_on\", too"));
}

TEST(ReadParts, MeshMayBeLeftOut) {
  const Case read = read_text(two_parts);
  EXPECT_EQ(read.parts.size(), 2U);
  EXPECT_EQ(read.mesh.degree, 1);
  EXPECT_EQ(read.mesh.plane, "strain");
  EXPECT_TRUE(read.motions.empty());
}

TEST(ReadParts, MotionsOfPartsComeFirst) {
  const Case read = read_text(two_parts +
                                  "[[motion]]\ngroup = [\"wall.all\", \"x\"]\nspin = 2\nabout = [1, 0]\n"
                                  "[[motion]]\ngroup = \"y\"\nvelocity = [0, 1]\n",
                              {"part.ball.spin=3"});
  ASSERT_EQ(read.motions.size(), 3U);
  EXPECT_EQ(read.motions[0].part, "ball");
  EXPECT_EQ(read.motions[0].spin, std::vector<double>{3.0});
  EXPECT_EQ(read.motions[1].section, "motion.0");
  EXPECT_EQ(read.motions[1].group, "[wall.all, x]");
  EXPECT_EQ(read.group_lists.at("[wall.all, x]"), (std::vector<std::string>{"wall.all", "x"}));
  EXPECT_EQ(read.motions[1].spin, std::vector<double>{2.0});
  EXPECT_EQ(read.motions[1].about, (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(read.motions[2].section, "motion.1");
  EXPECT_TRUE(read.motions[2].spin.empty());
  EXPECT_EQ(read.values.at("motion.0.spin"), "2");
}

TEST(ReadParts, AreChangedByOverrides) {
  const Case read = read_text(two_parts, {"part.ball.size=0.25", "part.ball.move=[1, 2]", "part.third.file=t.msh"});
  EXPECT_EQ(read.parts.at(1).size, 0.25);
  EXPECT_EQ(read.parts.at(1).placement.move, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(read.parts.at(2).name, "third");
  EXPECT_EQ(read.parts.at(2).file, expected_path("t.msh"));
}

TEST(ReadParts, ExcludeAFileAndAPlaceOfTheWhole) {
  const std::vector<std::pair<std::string, std::string>> keys{
      {"file", "\"a.msh\""}, {"size", "1"}, {"scale", "2"}, {"turn", "{ angle = 3 }"}, {"move", "[1, 2]"}};
  for (const auto& [key, value] : keys) {
    EXPECT_EQ(problems_of("[mesh]\n" + key + " = " + value + "\n" + two_parts),
              "2:" + std::to_string(key.size() + 4) + ": \"" + key +
                  "\" of [mesh] and [part.NAME] exclude each other: each [part.NAME] has its own \"" + key +
                  "\"; remove it here");
  }
  EXPECT_TRUE(has(problems_of(two_parts, {"mesh.file=a.msh"}), "exclude each other"));
}

TEST(ReadParts, OrAFileMustBeThere) {
  const std::string nothing = problems_of(rest_of_case);
  EXPECT_TRUE(
      nothing.starts_with("1:1: there is no section [mesh], which must have \"file\", and no [part.NAME] either."))
      << nothing;
  EXPECT_TRUE(has(problems_of("[mesh]\ndegree = 2\n" + rest_of_case), "[mesh] has no \"file\""));
  EXPECT_TRUE(has(problems_of("[part]\n" + rest_of_case), "no [part.NAME] either"));
  EXPECT_TRUE(has(problems_of("[part.ball]\nsize = 1\n" + rest_of_case), "1:1: [part.ball] has no \"file\""));
  // The misspelling is the only message.
  EXPECT_EQ(problems_of("[parts.ball]\nfile = \"a.msh\"\n" + rest_of_case),
            "1:2: unknown section \"parts\"; did you mean [part.NAME]?");
  EXPECT_EQ(problems_of("[mesh]\nfile = \"a.msh\"\n[parts.ball]\nfile = \"a.msh\"\n" + rest_of_case),
            "3:2: unknown section \"parts\"; did you mean [part.NAME]?");
}

TEST(ReadParts, NamesHaveNoOddCharacters) {
  const auto named = [](const std::string& name) {
    return problems_of("[part." + name + "]\nfile = \"a.msh\"\n" + rest_of_case);
  };
  EXPECT_EQ(named("\"a.b\""), "1:7: the name of [part.a.b] can only contain letters, digits, _ and -");
  EXPECT_EQ(named("\"ball 1\""), "1:7: the name of [part.ball 1] can only contain letters, digits, _ and -");
  EXPECT_EQ(named("a.b"), "1:9: [part.a.b]: a name must not contain a dot; write [part.a-b], for instance");
  EXPECT_EQ(named("ball_2-x"), "");
}

TEST(ReadParts, WrongValues) {
  const std::vector<std::pair<std::string, std::string>> expected{
      {"part.ball.spin=[1, 2]",
       "\"spin\" must be a number in two dimensions, a vector of 3 numbers in three (unit: 1/time); found a list of 2 "
       "values"},
      {"part.ball.spin=fast",
       "\"spin\" must be a number in two dimensions, a vector of 3 numbers in three (unit: 1/time); found the text "
       "\"fast\""},
      {"part.ball.spin=nan",
       "\"spin\" must be a number in two dimensions, a vector of 3 numbers in three (unit: 1/time); found the number "
       "nan"},
      {"part.wall.size=1", "\"size\" is only for geometry that the gmsh program meshes; \"w.msh\" is already a mesh"},
      {"part.ball.axis=1", "unknown key \"axis\" in [part.NAME] (\"axis\" is a key of [obstacle.NAME]); its keys are"},
      {"part.ball.turn={angle = 3, axis = [0, 0, 0]}", "\"axis\" must not be zero"}};
  for (const auto& [change, problem] : expected) EXPECT_TRUE(has(problems_of(two_parts, {change}), problem));
}

TEST(ReadParts, SpinsHaveTheDimensionOfTheVectors) {
  const std::string plane = two_parts + "[load]\ngravity = [0, -1]\n";
  EXPECT_EQ(problems_of(plane + "[[motion]]\ngroup = \"a\"\nspin = [0, 0, 1]\n"),
            "18:8: \"spin\" of [[motion]] is a vector, as in three dimensions, but \"gravity\" of [load] at 15:11 has "
            "2: all vectors must have as many entries as the mesh has dimensions");
  EXPECT_EQ(problems_of("[part.top]\nfile = \"t.msh\"\nspin = 1\n" + two_parts + "[load]\ngravity = [0, 0, -1]\n"),
            "18:11: \"gravity\" of [load] has 3 entries, but \"spin\" of [part.top] at 3:8 is a number, as in two "
            "dimensions: all vectors must have as many entries as the mesh has dimensions");
}

TEST(ReadParts, MotionsThatMoveNothing) {
  EXPECT_EQ(problems_of(two_parts + "[[motion]]\ngroup = \"a\"\n"),
            "14:1: [[motion]] moves nothing: set \"velocity\", \"spin\" or both");
  EXPECT_EQ(problems_of(two_parts + "[[motion]]\ngroup = \"a\"\nvelocity = [0, 1]\nabout = [0, 0]\n"),
            "17:9: \"about\" is a point on the axis of \"spin\": set \"spin\", or remove \"about\"");
}

}  // namespace ricochet::case_test
