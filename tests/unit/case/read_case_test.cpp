#include <gtest/gtest.h>

#include "case_text.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/fem/material_law.hpp"

namespace ricochet::case_test {

namespace {

const std::string full_case = R"toml(title = "A disc"
[mesh]
file = "sub/../disc.geo"
size = 0.002
scale = 2
degree = 2
plane = "stress"
[[material]]
group = "body"
density = 6000
young = 2.5
poisson = 0.25
damping = { mass = 0.5, stiffness = 0.25 }
[[material]]
group = "core"
density = 1.0
lambda = -0.5
mu = 1.0
[obstacle.wall]
type = "plane"
point = [1, 0.5]
normal = [-2, 0]
[obstacle.floor]
type = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
[[contact]]
group = "lower"
obstacle = "floor"
friction = 0.0
multipliers = "nodal"
[[support]]
group = "left"
components = ["y", "x"]
value = "a*t"
parameters = { a = 3 }
[[traction]]
group = "top"
value = ["x*t", "-p*min(t/0.1, 1)"]
parameters = { p = 100.0 }
[load]
gravity = [0.0, -9.81]
body_force = [1, "x + b"]
parameters = { b = 1.0 }
[initial]
displacement = "static"
velocity = ["-y", 0.5]
[mass]
type = "equivalent-nearest"
[time]
scheme = "newmark"
beta = 0.3
gamma = 0.55
step = 1.0e-4
end = 0.15
[[probe]]
name = "lowest-1_a"
at = [0.0, 0.001]
[output]
fields_every = 0
history_every = 5
[[expect]]
quantity = "history.lowest-1_a.displacement_y[-1]"
value = 0.0376
relative = 1.0e-2
absolute = 1
when = { "time.scheme" = "midpoint", mesh.scale = 2.0 }
[[expect]]
name = "a part"
quantity = "max_abs(history.energy_residual)"
over = "max(history.total_energy, 0, 0.1)"
times = 4
published = "elsewhere: 0.5"
minimum = -1
maximum = 1
)toml";

}  // namespace

TEST(ReadCase, BranchesThatRelax) {
  const Case read = read_text(edited_case(7, "mu = 1.0\nrelaxation = { modulus = [0.5, 2], time = [1e-3, 0.1] }"));
  EXPECT_EQ(read.materials[0].relaxation.modulus, (std::vector<double>{0.5, 2.0}));
  EXPECT_EQ(read.materials[0].relaxation.time, (std::vector<double>{1e-3, 0.1}));
  EXPECT_EQ(read.values.at("material.0.relaxation.time"), "[0.001, 0.1]");
}

TEST(ReadCase, ReadsEveryKey) {
  const Case read = read_text(full_case);
  EXPECT_EQ(read.title, "A disc");
  EXPECT_EQ(read.mesh.file, (std::filesystem::temp_directory_path() / "disc.geo").string());
  EXPECT_EQ(read.mesh.size, 0.002);
  EXPECT_EQ(read.mesh.scale, 2.0);
  EXPECT_EQ(read.mesh.degree, 2);
  EXPECT_EQ(read.mesh.plane, "stress");
  ASSERT_EQ(read.materials.size(), 2U);
  EXPECT_EQ(read.materials[0].group, "body");
  EXPECT_EQ(read.materials[0].density, 6000.0);
  EXPECT_DOUBLE_EQ(make_material_law("linear", read.materials[0].parameters)->lambda(),
                   1.0);  // the three-dimensional parameter, for plane stress too
  EXPECT_DOUBLE_EQ(make_material_law("linear", read.materials[0].parameters)->mu(), 1.0);
  EXPECT_EQ(read.materials[0].damping.mass, 0.5);
  EXPECT_EQ(read.materials[0].damping.stiffness, 0.25);
  EXPECT_EQ(read.materials[1].parameters.number("lambda"), -0.5);
  EXPECT_EQ(read.mass.type, "equivalent-nearest");
  EXPECT_EQ(read.time.scheme, "newmark");
  EXPECT_EQ(read.time.parameters.number("beta"), 0.3);
  EXPECT_EQ(read.time.parameters.number("gamma"), 0.55);
  EXPECT_FALSE(read.time.parameters.has("preset"));
  EXPECT_EQ(read.time.step, 1e-4);
  EXPECT_EQ(read.time.end, 0.15);
  EXPECT_EQ(read.output.fields_every, 0);
  EXPECT_EQ(read.output.history_every, 5);
}

TEST(ReadCase, ReadsBoundariesAndLoads) {
  const Case read = read_text(full_case);
  ASSERT_EQ(read.obstacles.size(), 2U);
  EXPECT_EQ(read.obstacles[0].name, "wall");  // in the order of the file, not of the alphabet
  EXPECT_EQ(read.obstacles[1].name, "floor");
  EXPECT_EQ(read.obstacles[0].type, "plane");
  EXPECT_EQ(read.obstacles[0].parameters.vector("point"), (std::vector<double>{1.0, 0.5}));
  EXPECT_EQ(read.obstacles[0].parameters.vector("normal"), (std::vector<double>{-2.0, 0.0}));
  ASSERT_EQ(read.contacts.size(), 1U);
  EXPECT_EQ(read.contacts[0].group, "lower");
  EXPECT_EQ(read.contacts[0].obstacle, "floor");
  ASSERT_EQ(read.supports.size(), 1U);
  EXPECT_EQ(read.supports[0].components, (std::vector<int>{0, 1}));
  EXPECT_EQ(read.supports[0].value(0, 0, 0, 2.0), 6.0);
  ASSERT_EQ(read.tractions.size(), 1U);
  ASSERT_EQ(read.tractions[0].value.size(), 2U);
  EXPECT_EQ(read.tractions[0].value[0](3.0, 0, 0, 2.0), 6.0);
  EXPECT_EQ(read.tractions[0].value[1](3.0, 0, 0, 2.0), -100.0);
  EXPECT_EQ(read.load.gravity, (std::vector<double>{0.0, -9.81}));
  ASSERT_EQ(read.load.body_force.size(), 2U);
  EXPECT_EQ(read.load.body_force[1](3.0, 0, 0, 0), 4.0);
  EXPECT_TRUE(read.initial.static_equilibrium);
  EXPECT_TRUE(read.initial.displacement.empty());
  ASSERT_EQ(read.initial.velocity.size(), 2U);
  EXPECT_EQ(read.initial.velocity[0](0, 3.0, 0, 0), -3.0);
}

TEST(ReadCase, ReadsProbesAndExpectations) {
  const Case read = read_text(full_case);
  ASSERT_EQ(read.probes.size(), 1U);
  EXPECT_EQ(read.probes[0].name, "lowest-1_a");
  EXPECT_EQ(read.probes[0].kind, "at");
  EXPECT_EQ(read.probes[0].values.vector("at"), (std::vector<double>{0.0, 0.001}));
  ASSERT_EQ(read.expectations.size(), 2U);
  EXPECT_EQ(read.expectations[0].value, 0.0376);
  EXPECT_EQ(read.expectations[0].relative, 0.01);
  EXPECT_EQ(read.expectations[0].absolute, 1.0);
  EXPECT_FALSE(read.expectations[0].minimum.has_value());
  EXPECT_EQ(read.expectations[0].times, 1.0);
  EXPECT_EQ(read.expectations[0].name + read.expectations[0].over + read.expectations[0].published, "");
  // Both spellings of a path, and 2.0 written for the 2 of the file.
  const std::map<std::string, std::string> when{{"time.scheme", "midpoint"}, {"mesh.scale", "2"}};
  EXPECT_EQ(read.expectations[0].when, when);
  EXPECT_EQ(read.expectations[1].name, "a part");
  EXPECT_EQ(read.expectations[1].over, "max(history.total_energy, 0, 0.1)");
  EXPECT_EQ(read.expectations[1].times, 4.0);
  EXPECT_EQ(read.expectations[1].published, "elsewhere: 0.5");
  EXPECT_EQ(read.expectations[1].minimum, -1.0);
  EXPECT_EQ(read.expectations[1].maximum, 1.0);
  EXPECT_FALSE(read.expectations[1].relative.has_value());
}

TEST(ReadCase, FillsInEveryDefault) {
  const Case read = read_text(edited_case(0, ""));
  EXPECT_EQ(read.title, "");
  EXPECT_FALSE(read.mesh.size.has_value());
  EXPECT_EQ(read.mesh.scale, 1.0);
  EXPECT_EQ(read.mesh.degree, 1);
  EXPECT_EQ(read.mesh.plane, "strain");
  ASSERT_EQ(read.materials.size(), 1U);
  EXPECT_TRUE(read.materials[0].relaxation.time.empty());
  EXPECT_EQ(read.materials[0].damping.mass, 0.0);
  EXPECT_EQ(read.materials[0].damping.stiffness, 0.0);
  EXPECT_TRUE(read.obstacles.empty() && read.contacts.empty() && read.supports.empty() && read.tractions.empty());
  EXPECT_TRUE(read.load.gravity.empty() && read.load.body_force.empty());
  EXPECT_FALSE(read.initial.static_equilibrium);
  EXPECT_TRUE(read.initial.displacement.empty() && read.initial.velocity.empty());
  EXPECT_EQ(read.mass.type, "equivalent");
  EXPECT_TRUE(read.probes.empty() && read.expectations.empty() && read.overridden.empty());
  EXPECT_FALSE(read.output.fields_every.has_value());
  EXPECT_FALSE(read.output.fields_interval.has_value());
  EXPECT_TRUE(read.output.fields.empty());
  EXPECT_FALSE(read.output.single_precision);
  EXPECT_EQ(read.output.compression, 0);
  EXPECT_FALSE(read.output.history_every.has_value());
  EXPECT_EQ(read.output.checkpoint_every, 0);
  EXPECT_EQ(read.output.checkpoint_seconds, 300.0);
  EXPECT_EQ(read.check.energy_residual, 1e-8);
  EXPECT_EQ(read.check.momentum, 1e-8);
  EXPECT_EQ(read.check.angular_momentum, 1e-8);
  EXPECT_FALSE(read.check.stops);
  EXPECT_EQ(read.values, (std::map<std::string, std::string>{{"title", ""},
                                                             {"mesh.file", "a.msh"},
                                                             {"mesh.refine", "0"},
                                                             {"mesh.scale", "1"},
                                                             {"mesh.degree", "1"},
                                                             {"mesh.plane", "strain"},
                                                             {"material.0.group", "body"},
                                                             {"material.0.density", "1"},
                                                             {"material.0.law", "linear"},
                                                             {"material.0.dilatation", "automatic"},
                                                             {"material.0.lambda", "1"},
                                                             {"material.0.mu", "1"},
                                                             {"material.0.damping.mass", "0"},
                                                             {"material.0.damping.stiffness", "0"},
                                                             {"mass.type", "equivalent"},
                                                             {"time.scheme", "midpoint"},
                                                             {"time.step", "0.1"},
                                                             {"time.end", "1"},
                                                             {"solver.method", "auto"},
                                                             {"solver.preconditioner", "auto"},
                                                             {"solver.tolerance", "1e-10"},
                                                             {"solver.newton_tolerance", "1e-08"},
                                                             {"solver.contact_points", "near"},
                                                             {"output.format", "xdmf"},
                                                             {"output.fields_precision", "double"},
                                                             {"output.compression", "0"},
                                                             {"output.checkpoint_every", "0"},
                                                             {"output.checkpoint_seconds", "300"},
                                                             {"check.energy_residual", "1e-08"},
                                                             {"check.momentum", "1e-08"},
                                                             {"check.angular_momentum", "1e-08"},
                                                             {"check.on_failure", "warn"}}));
}

TEST(ReadCase, FillsInDefaultsOfOptionalSections) {
  const Case read = read_text(edited_case(0,
                                          "[obstacle.a]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n"
                                          "[[contact]]\ngroup = \"g\"\nobstacle = \"a\"\n"
                                          "[[support]]\ngroup = \"g\"\ncomponents = [\"z\"]\n"));
  EXPECT_EQ(read.contacts.at(0).friction, 0.0);
  EXPECT_EQ(read.contacts.at(0).multipliers, "nodal");
  EXPECT_EQ(read.supports.at(0).components, std::vector<int>{2});
  EXPECT_EQ(read.supports.at(0).value(1, 1, 1, 1), 0.0);
  EXPECT_EQ(read.values.at("contact.0.friction"), "0");
  EXPECT_EQ(read.values.at("support.0.value"), "0");
}

TEST(ReadCase, KnowsWhereThingsStand) {
  const CaseFile file(full_case);
  const Case read = read_case(file.path());
  EXPECT_EQ(read.where("title").text(), file.path() + ":1:9");
  EXPECT_EQ(read.where("mesh.scale").text(), file.path() + ":5:9");
  EXPECT_EQ(read.where("material.0.damping.stiffness").text(), file.path() + ":13:37");
  EXPECT_EQ(read.where("material.1").text(), file.path() + ":14:1");
  EXPECT_EQ(read.where("material.1.damping.mass").text(), file.path() + ":14:1");  // a default: its section
  EXPECT_EQ(read.where("contact.0.group").text(), file.path() + ":28:9");
  EXPECT_EQ(read.where("nothing.at.all").text(), file.path());
  EXPECT_EQ(read.where("").text(), file.path());
  EXPECT_EQ(read.locations.count("material.1.damping.mass"), 0U);
}

TEST(ReadCase, ResolvesTheMeshAgainstTheFolderOfTheCase) {
  const Case absolute = read_text(edited_case(2, "file = \"/data/a.msh\""));
  EXPECT_EQ(absolute.mesh.file, "/data/a.msh");
  EXPECT_EQ(absolute.values.at("mesh.file"), "/data/a.msh");
  const CaseFile file(edited_case(2, "file = \"../a.msh\""));
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  EXPECT_EQ(read_case(file.path()).mesh.file, (folder.parent_path() / "a.msh").lexically_normal().string());
}

TEST(ReadCase, WarnsOfFrictionInPerCent) {
  const auto warnings_of = [](const std::string& friction) {
    std::vector<std::string> warnings;
    const log::Silence silence;
    const log::CollectWarnings collect(warnings);
    static_cast<void>(read_text(edited_case(0,
                                            "[obstacle.a]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n"
                                            "[[contact]]\ngroup = \"g\"\nobstacle = \"a\"\nfriction = " +
                                                friction + "\n[[contact]]\ngroup = \"h\"\nobstacle = \"a\"\n")));
    return warnings;
  };
  EXPECT_TRUE(warnings_of("2.0").empty());
  const std::vector<std::string> of_percentage = warnings_of("30");
  ASSERT_EQ(of_percentage.size(), 1U);
  for (const std::string part : {":19:12: ", "the coefficient of friction 30 is unusually large", "not per cent"})
    EXPECT_NE(of_percentage[0].find(part), std::string::npos) << of_percentage[0];
}

TEST(ReadCase, SaysWhenAFileCannotBeRead) {
  for (const std::string path : {"/nowhere/case.toml", "/tmp"}) {
    try {
      static_cast<void>(read_case(path));
      ADD_FAILURE() << path;
    } catch (const Error& problem) {
      EXPECT_EQ(problem.kind(), ErrorKind::file_access);
      EXPECT_EQ(std::string(problem.what()).find(path + ": cannot be read: "), 0U) << problem.what();
    }
  }
}

TEST(ReadCase, AnEmptyFileLacksTheRequiredSections) {
  EXPECT_EQ(problems_of(""),
            "1:1: there is no section [mesh], which must have \"file\", and no [part.NAME] either. The body and its "
            "discretization. With sections [part.NAME], this section contains only `degree` and `plane`, which apply "
            "to all parts.\n1:1: there is no section [[material]], which must have \"group\" and \"density\". The "
            "material of one or more groups of cells.\n1:1: there is no section [time], which must have \"step\" and "
            "\"end\". The time scheme and its steps.");
}

TEST(ReadCase, AdaptiveSteps) {
  const TimeSection time = read_text(edited_case(10, "step = \"adaptive\"\nlargest = 0.25")).time;
  EXPECT_TRUE(time.adaptive);
  EXPECT_EQ(time.step, 0.25);
  EXPECT_EQ(time.tolerance, 1e-3);
  EXPECT_EQ(time.smallest, 0.25 / 1048576);
  const TimeSection fixed = read_text(edited_case(10, "step = \"adaptive\"\nlargest = 0.25"), {"time.step=0.5"}).time;
  EXPECT_FALSE(fixed.adaptive);
  EXPECT_EQ(fixed.step, 0.5);
  EXPECT_EQ(problems_of(edited_case(10, "step = 0.1\nlargest = 0.25")),
            "11:11: \"largest\" is only for adaptive steps; write step = \"adaptive\"");
  EXPECT_EQ(problems_of(edited_case(10, "step = \"adaptive\"")),
            "10:8: adaptive steps require \"largest\", the largest length: at most the time between two rows that you "
            "want to see");
  EXPECT_EQ(problems_of(edited_case(10, "step = \"adaptive\"\nlargest = 0.25\nsmallest = 0.5")),
            "12:12: \"smallest\" is 0.5, above \"largest\", 0.25");
}

}  // namespace ricochet::case_test
