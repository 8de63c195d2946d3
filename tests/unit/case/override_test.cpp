#include <gtest/gtest.h>

#include "case_text.hpp"
#include "ricochet/case/keys_override.hpp"

namespace ricochet::case_test {

namespace {

const std::string contact_case =
    edited_case(0,
                "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n"
                "[[contact]]\ngroup = \"a\"\nobstacle = \"floor\"\n[[contact]]\ngroup = \"b\"\nobstacle = \"floor\"\n"
                "[[traction]]\ngroup = \"top\"\nvalue = [0, \"p*t\"]\nparameters = { p = 1.0 }\n"
                "[[expect]]\nquantity = \"summary.steps\"\nminimum = 1\n");

}  // namespace

TEST(Overrides, ReplaceAndAddValues) {
  const Case read = read_text(
      contact_case, {"time.step=1e-3", "time.scheme=klr-conserving", "title=two words", "contact.1.group = \"c\"",
                     "obstacle.floor.normal=[1, 0]", "material.0.damping.mass=0.5", "traction.0.parameters.p=7",
                     "output.history_every=3", "initial.velocity=[\"x\", 1]", "expect.0.when.time.scheme=midpoint"});
  EXPECT_EQ(read.time.step, 1e-3);
  EXPECT_EQ(read.time.scheme, "klr-conserving");
  EXPECT_EQ(read.title, "two words");
  EXPECT_EQ(read.contacts.at(1).group, "c");
  EXPECT_EQ(read.obstacles.at(0).parameters.vector("normal"), (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(read.materials.at(0).damping.mass, 0.5);
  EXPECT_EQ(read.materials.at(0).damping.stiffness, 0.0);
  EXPECT_EQ(read.tractions.at(0).value.at(1)(0, 0, 0, 2.0), 14.0);
  EXPECT_EQ(read.output.history_every, 3);  // in a section that the file does not have
  EXPECT_EQ(read.initial.velocity.at(0)(5.0, 0, 0, 0), 5.0);
  EXPECT_EQ(read.expectations.at(0).when.at("time.scheme"), "midpoint");
  EXPECT_EQ(read.overridden.size(), 10U);
  EXPECT_EQ(read.overridden.at(0), "time.step");
  EXPECT_EQ(read.overridden.at(3), "contact.1.group");
  EXPECT_EQ(read.values.at("time.step"), "0.001");
  EXPECT_EQ(read.where("time.step").text(), "--set time.step=1e-3");
  EXPECT_EQ(read.where("time.step").line, 0);
}

TEST(Overrides, TheLastOneCounts) {
  const Case read = read_text(contact_case, {"time.step=0.2", "time.step=0.3"});
  EXPECT_EQ(read.time.step, 0.3);
  EXPECT_EQ(read.overridden, std::vector<std::string>{"time.step"});
}

TEST(Overrides, MakeANamedSection) {
  const Case read =
      read_text(contact_case, {"obstacle.wall.type=plane", "obstacle.wall.point=[1,0]", "obstacle.wall.normal=[-1,0]"});
  EXPECT_EQ(read.obstacles.at(1).name, "wall");
}

TEST(Overrides, KeepTheMeshRelativeToTheCase) {
  EXPECT_EQ(read_text(contact_case, {"mesh.file=b.msh"}).mesh.file,
            (std::filesystem::temp_directory_path() / "b.msh").string());
}

TEST(Overrides, RepairAFileBeforeItIsChecked) {
  EXPECT_EQ(read_text(edited_case(10, ""), {"time.step=0.5"}).time.step, 0.5);
  EXPECT_EQ(read_text(edited_case(5, "density = \"heavy\""), {"material.0.density=2"}).materials.at(0).density, 2.0);
}

TEST(Overrides, SayWhatIsWrongWithThem) {
  const std::vector<std::pair<std::string, std::string>> expected{
      {"contact.7.friction=0.3", "there is no entry 7 of [[contact]]: the entries are 0 to 1"},
      {"support.0.value=0.3", "there is no entry 0 of [[support]]: the case has none"},
      {"material.1.density=1", "there is no entry 1 of [[material]]: there is only entry 0"},
      {"contact.friction=0.3", "[[contact]] is a list: specify the entry, counted from 0, as in contact.0.group"},
      {"contact.-1.friction=0.3", "[[contact]] is a list: specify the entry, counted from 0, as in contact.0.group"},
      {"contact.01.friction=0.3",
       "\"01\" is not a valid number of an entry of [[contact]]: write 1, as in contact.1.friction"},
      {"contact.00=0.3", "\"00\" is not a valid number of an entry of [[contact]]: write 0, as in contact.0.group"},
      {"contact[0].friction=0.3", "the number of an entry, counted from 0, follows a dot: write contact.0.friction"},
      {"contact=3", "[[contact]] is a list: specify the entry, counted from 0, as in contact.0.group"},
      {"obstacle=3", "the sections [obstacle.NAME] have names: specify one, as in obstacle.floor.type"},
      {"time=3", "\"time\" is a section: specify one of its keys, as in time.scheme"},
      {"time.stp=1", "unknown key \"stp\" in [time]; did you mean \"step\"?"},
      {"tme.step=1", "unknown section \"tme\"; did you mean [time]?"},
      {"material.0.damping.mas=1", "unknown key \"mas\" in material.damping; did you mean \"mass\"?"},
      {"obstacle.floor.normal.1=1", "\"normal\" is a vector of 2 or 3 numbers: it has no key \"1\""},
      {"time.step=fast", "\"step\" must be a positive number, or \"adaptive\" (unit: time); found the text \"fast\""},
      {"time.step=", "\"step\" must be a positive number, or \"adaptive\" (unit: time); found the text \"\""},
      {"time.step=nan",
       "\"step\" must be a positive number, or \"adaptive\" (unit: time); found the number nan, which is not finite"},
      {"time.step=1\nfoo=2",
       "\"step\" must be a positive number, or \"adaptive\" (unit: time); found the text \"1\nfoo=2\""},
      {"contact.0.friction=-0.3", "\"friction\" must be a number of at least 0; found the number -0.3"},
      {"obstacle.wall.type=plane",
       "[obstacle.wall] has no \"point\": a vector of 2 or 3 numbers (unit: length). A point on "
       "the plane.\n--set obstacle.wall.type=plane: [obstacle.wall] has no \"normal\": a vector "
       "of 2 or 3 numbers. Normal of the plane, pointing out of the obstacle; of any length "
       "but zero."},
      {"traction.0.parameters.t=1", "\"t\" cannot be the name of a parameter: x, y, z, t and pi are reserved"},
  };
  for (const auto& [text, problem] : expected) {
    EXPECT_EQ(problems_of(contact_case, {text}), "--set " + text + ": " + problem);
  }
}

TEST(Overrides, AreTheSameHoweverTheyAreWritten) {
  for (const char* text : {"time.step=0.2", " time.step = 0.20 ", "time.step=2e-1"})
    EXPECT_EQ(normal_override(text), "time.step=0.2") << text;
  EXPECT_EQ(override_value_text("[0,-1]"), override_value_text("[0, -1.0]"));
  EXPECT_EQ(override_value_text("\"a b\""), override_value_text(" a b"));
  EXPECT_NE(override_value_text("1"), override_value_text("1.0000000000000002"));
  EXPECT_NE(override_value_text("1979-05-27"), override_value_text("1979-05-28"));
}

TEST(Overrides, ComeAfterTheProblemsOfTheFile) {
  EXPECT_EQ(problems_of(edited_case(10, "step = 0"), {"mesh.degree=3", "tim.end=3"}),
            "10:8: \"step\" must be a positive number, or \"adaptive\" (unit: time); found the integer 0\n"
            "--set tim.end=3: unknown section \"tim\"; did you mean [time]?\n"
            "--set mesh.degree=3: \"degree\" must be 1 or 2; found the integer 3");
}

TEST(Overrides, NeedAnEqualsSign) {
  for (const std::string text : {"time.step", "", "=3", "  =3"}) {
    const CaseFile file(contact_case);
    EXPECT_EQ(message_of([&] { static_cast<void>(read_case(file.path(), {text})); }, ErrorKind::usage),
              "--set " + text + ": write --set key.path=value, as in --set time.step=1e-4");
  }
}

}  // namespace ricochet::case_test
