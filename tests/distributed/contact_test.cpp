#include <gtest/gtest.h>

#include <cmath>
#include <list>
#include <span>

#include "ricochet/base/log.hpp"
#include "ricochet/distributed/cut_model.hpp"
#include "ricochet/run/session.hpp"
#include "support/case_run.hpp"

// Distributed bodies that meet obstacles: contact points anywhere, and obstacles across the boundaries of ranks.

namespace ricochet::test_support {
namespace {

struct ContactCase {
  const char* name;
  int dimension;
  const char* contact;   ///< more keys of [[contact]]
  const char* obstacle;  ///< type, position and motion
  const char* rest;      ///< [mass], [time] and other sections
  double allowed;        ///< relative to the largest value of a column
  const char* preconditioner = "auto";
  bool is_static = false;  ///< lies on the floor in equilibrium, and is pushed
  bool is_long = false;    ///< so many points touch that there are several subdomains, some on each rank
};

constexpr const char* floor_2d = "type = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.05, 1.0]\n";
constexpr const char* level_2d = "type = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n";
constexpr const char* floor_3d = "type = \"plane\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.02, 0.03, 1.0]\n";
constexpr const char* ball_2d = "type = \"sphere\"\ncentre = [0.45, -2.0]\nradius = 2.0\nside = \"outside\"\n";

std::string toml_of(const ContactCase& test, const std::string& mesh) {
  const bool flat = test.dimension == 2;
  return "[mesh]\nfile = \"" + mesh +
         "\"\n[[material]]\ngroup = \"block\"\ndensity = 1000.0\nyoung = 1.0e6\npoisson = 0.3\n[obstacle.floor]\n" +
         test.obstacle + "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + test.contact +
         "[load]\ngravity = " + (flat ? "[0.0, -10.0]" : "[0.0, 0.0, -10.0]") + "\n[initial]\n" +
         (test.is_static ? std::string("displacement = \"static\"")
                         : std::string("velocity = ") + (flat ? "[1.0, -2.0]" : "[1.0, 0.0, -2.0]") +
                               "\ndisplacement = " + (flat ? "[0.0, 0.003]" : "[0.0, 0.0, 0.003]")) +
         "\n[solver]\nmethod = \"iterative\"\ntolerance = 1e-12\n[[probe]]\nname = \"corner\"\nat = " +
         (flat ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]") +
         "\n[[probe]]\nname = \"all\"\ngroup = \"block\"\n[[probe]]\nname = \"wall\"\nboundary = \"bottom\"\n"
         "[[probe]]\nname = \"floor\"\ncontact = 0\n" +
         test.rest + (std::string(test.rest).find("step =") == std::string::npos ? "step = 2e-3\n" : "") +
         "end = 0.06\n";
}

std::string mesh_of(const ContactCase& test) {
  if (test.is_long)
    return mesh_geometry("ranks-long",
                         "Rectangle(1)={0,0,0,40,0.2}; Physical Surface(\"block\")={1}; Physical "
                         "Curve(\"bottom\")={1}; Physical Curve(\"side\")={4};",
                         0.07, 1);
  return test.dimension == 2 ? mesh_geometry("ranks-2d",
                                             "Rectangle(1)={0,0,0,1,0.5}; Physical Surface(\"block\")={1}; Physical "
                                             "Curve(\"bottom\")={1}; Physical Curve(\"side\")={4};",
                                             0.07, 1)
                             : mesh_geometry("ranks-3d",
                                             "Box(1)={0,0,0,1,0.8,0.4}; Physical Volume(\"block\")={1}; Physical "
                                             "Surface(\"bottom\")={5}; Physical Surface(\"side\")={1};",
                                             0.15, 1);
}

class Contact : public testing::TestWithParam<std::tuple<ContactCase, PartitionMethod>> {};

TEST_P(Contact, IsThatOfOneRank) {
  const auto& [test, method] = GetParam();
  log::set_level(log::Level::error);
  const Communicator world = Communicator::world();
  const auto wait = [&] { (void)world.gather(std::vector<double>{0.0}); };
  std::string path;
  // One rank writes the files that all of them read.
  for (int rank = 0; rank < world.size(); ++rank) {
    if (rank == world.rank()) path = write_temporary("case.toml", toml_of(test, mesh_of(test)));
    wait();
  }
  Session whole(path), own(path, {std::string("solver.preconditioner=") + test.preconditioner});
  own.set_model_builder([&, method = method](const Case& input, BuildTimes*) {
    return build_divided_model(input, world, {.method = method, .seed = 5});
  });
  const auto recorder_of = [](Session& session) {
    const Model& model = session.model();
    return HistoryRecorder(model.problem, *model.rotation, model.sensors, model.history_bodies);
  };
  HistoryRecorder expected = recorder_of(whole), found = recorder_of(own);
  ASSERT_EQ(expected.columns(), found.columns());
  std::vector<std::vector<double>> expected_rows, rows;
  double most_points = 0.0;
  const std::size_t active = column_index(expected.columns(), "active_contacts");
  const auto take_rows = [&] {
    expected_rows.push_back(expected.row(whole.state(), whole.simulation().account()));
    rows.push_back(found.row(own.state(), own.simulation().account()));
    most_points = std::max(most_points, expected_rows.back()[active]);
  };
  take_rows();
  while (whole.step()) {
    ASSERT_TRUE(own.step());
    take_rows();
  }
  EXPECT_GT(most_points, test.is_long ? 512.0 : 2.0);  // there is contact
  const Ranks& ranks = *own.model().problem.ranks;
  const double homes = ranks.sum(own.simulation().factor_entries() > 0 ? 1.0 : 0.0);
  EXPECT_EQ(homes, test.is_long ? std::min(ranks.size(), 4) : 1.0);
  const auto largest = [&](const std::string& name) {
    const std::size_t column = column_index(expected.columns(), name);
    double result = 0.0;
    for (const auto& row : expected_rows) result = std::max(result, std::abs(row[column]));
    return result;
  };
  // The rounding of quantities that vanish is that of their largest terms.
  const double energy = largest("kinetic_energy"), force = largest("corner.reaction_normal");
  for (std::size_t column = 0; column < expected.columns().size(); ++column) {
    const std::string& name = expected.columns()[column];
    if (name == "iterations") continue;
    // In a body at rest some points are at the limit of slipping; the touching points are the same.
    if (test.is_static && (name == "sticking" || name == "slipping")) continue;
    double scale = largest(name), error = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i)
      error = std::max(error, std::abs(rows[i][column] - expected_rows[i][column]));
    if (name.ends_with("_work") || name.ends_with("_residual") || name.ends_with("_dissipation")) scale = energy;
    if (name.find("reaction_tangential") != std::string::npos) scale = force;
    // A body at rest on a level floor moves along it only.
    if (test.is_static && name.ends_with("_y")) scale = std::max(scale, largest(name.substr(0, name.size() - 1) + "x"));
    if (name == "max_penetration" || name == "corner.gap") scale = std::max(scale, 1e-3);
    EXPECT_LE(error, test.allowed * scale) << name;
  }
}

const char* const newmark = "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"newmark\"\npreset = \"textbook-half\"\n";
const char* const kane = "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"reduced-kane\"\n";
const char* const push_2d = "[[traction]]\ngroup = \"side\"\nvalue = [\"2e3*sin(60*t)\", \"0\"]\n";
const char* const pushed_kane =
    "[[traction]]\ngroup = \"side\"\nvalue = [\"2e3*sin(60*t)\", \"0\"]\n"
    "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"reduced-kane\"\n";
const char* const pushed_newmark =
    "[[traction]]\ngroup = \"side\"\nvalue = [\"2e3*sin(60*t)\", \"0\", \"0\"]\n"
    "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"newmark\"\npreset = \"textbook-half\"\n";
const char* const midpoint = "[mass]\ntype = \"consistent\"\n[time]\nscheme = \"midpoint\"\n";

INSTANTIATE_TEST_SUITE_P(
    All, Contact,
    testing::Combine(
        testing::Values(ContactCase{"newmark", 2, "", floor_2d, newmark, 1e-9},
                        ContactCase{"kane", 2, "friction = 0.3\n", floor_2d, kane, 1e-9},
                        ContactCase{"kane3d", 3, "friction = 0.3\n", floor_3d, kane, 1e-9},
                        ContactCase{"dual3d", 3, "friction = 0.3\nmultipliers = \"dual\"\n", floor_3d, newmark, 1e-9},
                        ContactCase{"p1", 2, "multipliers = \"p1\"\n", floor_2d, kane, 1e-9},
                        ContactCase{"midpoint", 2, "friction = 0.2\n", floor_2d, midpoint, 1e-9},
                        ContactCase{"statickane", 2, "friction = 0.3\n", floor_2d, pushed_kane, 1e-8, "auto", true},
                        ContactCase{"staticnewmark", 3, "friction = 0.3\n", floor_3d, pushed_newmark, 1e-8, "auto",
                                    true},
                        ContactCase{"gamg", 3, "friction = 0.3\n", floor_3d, kane, 1e-9, "gamg"},
                        ContactCase{"boomeramg", 2, "friction = 0.3\n", floor_2d, newmark, 1e-9, "boomeramg"},
                        ContactCase{"mumps", 3, "", floor_3d, newmark, 1e-9, "mumps"},
                        ContactCase{"long", 2, "friction = 0.3\n", level_2d, newmark, 1e-9, "auto", false, true},
                        ContactCase{"cylinder", 2, "friction = 0.2\n", ball_2d, kane, 1e-8}),
        testing::Values(PartitionMethod::graph, PartitionMethod::random)),
    [](const auto& info) {
      return std::get<0>(info.param).name +
             std::string(std::get<1>(info.param) == PartitionMethod::random ? "random" : "graph");
    });

/// Schemes without friction, on a plane.
constexpr const char* other_schemes[][2] = {
    {"contact-stabilized", "consistent"},
    {"kane", "consistent"},
    {"laursen-chawla", "consistent"},
    {"klr-conserving", "consistent"},
    {"bathe", "equivalent"},
    {"reduced-midpoint", "equivalent"},
    {"mean-reaction", "equivalent"},
    {"semi-explicit", "equivalent-lumped"},
    {"hht-alpha", "equivalent"},
    {"wbz-alpha", "equivalent"},
    {"generalized-alpha", "equivalent"},
    {"nonsmooth-generalized-alpha", "consistent"},
    {"moreau-jean", "consistent"},
    {"paoli-schatzman", "lumped"},
    {"taylor-flanagan", "lumped"},
    {"cd-lagrange", "lumped"},
};

/// Schemes that have work of their own to do at the start.
constexpr const char* starting_schemes[][2] = {
    {"generalized-alpha", "equivalent"},
    {"nonsmooth-generalized-alpha", "consistent"},
    {"semi-explicit", "equivalent-lumped"},
};

/// Thrown at an inclined floor, or in equilibrium on a level one and then pushed. The texts live as long as the tests.
std::vector<ContactCase> cases_of_schemes(std::span<const char* const[2]> schemes, bool is_static) {
  static std::list<std::string> texts;
  std::vector<ContactCase> result;
  for (const auto& [scheme, mass] : schemes) {
    const bool is_explicit = std::string(mass).ends_with("lumped");
    texts.push_back(std::string(is_static ? push_2d : "") + "[mass]\ntype = \"" + mass + "\"\n[time]\nscheme = \"" +
                    scheme + "\"\n" + (is_explicit ? "step = 2e-4\n" : "step = 2e-3\n"));
    result.push_back({scheme, 2, "", is_static ? level_2d : floor_2d, texts.back().c_str(), is_static ? 1e-8 : 1e-9,
                      "auto", is_static});
  }
  return result;
}

std::string name_of_scheme(const testing::TestParamInfo<Contact::ParamType>& info) {
  std::string name = std::get<0>(info.param).name;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Schemes, Contact,
                         testing::Combine(testing::ValuesIn(cases_of_schemes(other_schemes, false)),
                                          testing::Values(PartitionMethod::graph)),
                         name_of_scheme);
INSTANTIATE_TEST_SUITE_P(StaticStarts, Contact,
                         testing::Combine(testing::ValuesIn(cases_of_schemes(starting_schemes, true)),
                                          testing::Values(PartitionMethod::graph)),
                         name_of_scheme);

}  // namespace
}  // namespace ricochet::test_support
