#include <gtest/gtest.h>

#include "case_text.hpp"

// Malformed case files: unknown, missing and misplaced keys and sections.
namespace ricochet::case_test {

TEST(MalformedCase, Structure) {
  const std::vector<MalformedCase> cases{
      // keys
      {5, "densty = 1.0", "5:1: unknown key \"densty\" in [[material]]; did you mean \"density\"?"},
      {5, "weight = 1.0",
       "3:1: [[material]] has no \"density\": a positive number (unit: density). Mass per volume.\n5:1: unknown key "
       "\"weight\" in [[material]]; its keys are \"group\", \"density\", \"law\", \"lambda\", \"mu\", \"young\", "
       "\"poisson\", \"c10\", \"c01\", \"bulk_modulus\", \"dilatation\", \"damping\" and \"relaxation\""},
      {0, "[tim]\nstep = 1", "12:2: unknown section \"tim\"; did you mean [time]?"},
      {0, "[rocket]\nstep = 1",
       "12:2: unknown section \"rocket\"; the sections are [mesh], [part.NAME], [[material]], [obstacle.NAME], "
       "[[contact]], "
       "[[support]], [[traction]], [[pressure]], [load], [initial], [[motion]], [mass], [time], [solver], [[probe]], "
       "[output], "
       "[check] and "
       "[[expect]]"},
      {0, "[[contacts]]\ngroup = \"a\"", "12:3: unknown section \"contacts\"; did you mean [[contact]]?"},
      {1, "titel = \"a\"\n[mesh]", "1:1: unknown key \"titel\" in the top level of the file; did you mean \"title\"?"},
      {1, "density = 3\n[mesh]", "1:1: the key \"density\" is outside of any section; it belongs to [[material]]"},
      {1, "qqqqqq = 3\n[mesh]", "1:1: unknown key \"qqqqqq\" in the top level of the file; its only key is \"title\""},
      {2, "",
       "1:1: [mesh] has no \"file\": a text that is not empty. Mesh file (.msh, .inp, .vtu, .med, …; see "
       "docs/meshes.md), or geometry for the gmsh program "
       "(.geo, .step, …). A relative path is relative to the folder of the case file, also when given by --set."},
      {5, "", "3:1: [[material]] has no \"density\": a positive number (unit: density). Mass per volume."},
      {11, "",
       "8:1: [time] has no \"end\": a positive number (unit: time). End time of the run, which starts at t = 0; at "
       "least one step and at most 1e9 steps."},
      {4, "group = \"\"", "4:9: \"group\" must be the name of a group, or a list of them; found the text \"\""},
      {7, "mu = 1.0\ndamping = { mas = 1.0 }",
       "8:13: unknown key \"mas\" in \"damping\" of [[material]]; did you mean \"mass\"?"},
      {7, "mu = 1.0\n[material.damping]\nstifness = 1.0",
       "9:1: unknown key \"stifness\" in \"damping\" of [[material]]; did you mean \"stiffness\"?"},
      {0, "[mass]\nkind = \"lumped\"", "13:1: unknown key \"kind\" in [mass]; its only key is \"type\""},
      {0, "[output]\nevery = 1",
       "13:1: unknown key \"every\" in [output] (\"every\" is a key of [[probe]]); its keys are \"fields_every\", "
       "\"fields_interval\", "
       "\"fields\", \"format\", \"fields_precision\", \"compression\", \"history_every\", \"checkpoint_every\" and "
       "\"checkpoint_seconds\""},
      {0, "[load]\ngravty = [0, -1]", "13:1: unknown key \"gravty\" in [load]; did you mean \"gravity\"?"},
      // sections
      {1, "[[mesh]]", "1:3: there is only one [mesh]: write [mesh], not [[mesh]]"},
      {3, "[material]", "3:2: there can be several [[material]]: write [[material]], not [material]"},
      {8, "[[time]]", "8:3: there is only one [time]: write [time], not [[time]]"},
      {0, "[contact]\ngroup = \"a\"\nobstacle = \"floor\"",
       "12:2: there can be several [[contact]]: write [[contact]], not [contact]"},
      {0, "contact = []\n", "12:1: unknown key \"contact\" in [time]; its keys are " + keys_of_time()},
      {1, "contact = [1, 2]\n[mesh]",
       "1:1: \"contact\" must be a list of tables, [[contact]]; found a list of 2 values"},
      {0, "[[obstacle]]\ntype = \"plane\"", "12:3: each obstacle has a name: write [obstacle.NAME], not [[obstacle]]"},
      {0, "[obstacle]\ntype = \"plane\"\npoint = [0, 0]",
       "13:1: \"type\" is in [obstacle], which needs a name: write [obstacle.NAME]"},
      {0, "[obstacle.\"a b\"]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]",
       "12:11: the name of [obstacle.a b] can only contain letters, digits, _ and -"},
      {1, "mass = \"lumped\"\n[mesh]", "1:1: \"mass\" must be a section, [mass]; found the text \"lumped\""},
      {1, "obstacle = 3\n[mesh]", "1:1: each obstacle has a name: write [obstacle.NAME], not the integer 3"},
      {1, "probe = \"x\"\n[mesh]", "1:1: \"probe\" must be a list of tables, [[probe]]; found the text \"x\""},
      // syntax
      {5, "density = ", "5:11: invalid TOML: Error while parsing key-value pair: expected value, saw '\\n'"},
      {5, "density = 1.0.0",
       "5:14: invalid TOML: Error while parsing floating-point: expected decimal digit or exponent, saw '.'"},
      {5, "density = 1200,0",
       "5:15: invalid TOML: Error while parsing key-value pair: expected a comment or whitespace, saw ','; use a "
       "decimal point: 1200.0"},
      {5, "density = 1200, # kg",
       "5:15: invalid TOML: Error while parsing key-value pair: expected a comment or whitespace, saw ','"},
      {0, "[time]\nstep = 1",
       "12:1: invalid TOML: Error while parsing table header: cannot redefine existing table 'time'"},
      {5, "density = 1.0\ndensity = 2.0",
       "6:11: invalid TOML: Error while parsing key-value pair: cannot redefine existing floating-point 'density'"},
      {4, "group = \"body",
       "4:14: invalid TOML: Error while parsing string: unescaped control characters other than TAB (U+0009) are "
       "explicitly prohibited"},
      {3, "[[material]", "3:12: invalid TOML: Error while parsing table header: expected ']', saw '\\n'"},
      // several
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"z\"]\n[load]\ngravity = [0, -1]",
       "14:15: there is no component \"z\" in two dimensions: \"gravity\" of [load] at 16:11 has 2 entries"},
      {3, "[[materail]]", "3:3: unknown section \"materail\"; did you mean [[material]]?"},
      {0, "[obstacle]\ntype = \"plane\"\npoint = [0, 0]\n[[contact]]\ngroup = \"low\"\nobstacle = \"floor\"",
       "13:1: \"type\" is in [obstacle], which needs a name: write [obstacle.NAME]"},
      {6, "lamda = 1.0", "6:1: unknown key \"lamda\" in [[material]]; did you mean \"lambda\"?"},
      {0, "[[expect]]\nquantity = \"summary.steps\"\nminimum = 0\nwhen = { \"obstacle.floor.type\" = \"plane\" }",
       "15:10: \"when\" names \"obstacle.floor.type\": there is no [obstacle.floor]"},
      {0, "[[expect]]\nquantity = \"summary.steps\"\nminimum = 0\nwhen = { \"material.0.damping\" = 1 }",
       "15:10: \"when\" names \"material.0.damping\": it holds several values: specify one"},
      {0, "[[expect]]\nquantity = \"summary.steps\"\nminimum = 0\nwhen = { \"material.0.damping.mas\" = 1 }",
       "15:10: \"when\" names \"material.0.damping.mas\": unknown key \"mas\" in material.damping; did you mean "
       "\"mass\"?"},
      {0, "[[expect]]\nquantity = \"summary.steps\"\nminimum = 0\nwhen = { \"mesh.scale.x\" = 1 }",
       "15:10: \"when\" names \"mesh.scale.x\": \"scale\" is a positive number: it has no key \"x\""},
      {5, "densty = \"a\"\n[load]\ngravity = [1]",
       "3:1: [[material]] needs either \"lambda\" and \"mu\" or \"young\" and \"poisson\"; found none of them\n5:1: "
       "unknown key \"densty\" in [[material]]; did you mean \"density\"?\n7:11: \"gravity\" must be a vector of 2 or "
       "3 numbers (unit: acceleration); found a list of 1 value\n8:1: unknown key \"lambda\" in [load] (\"lambda\" is "
       "a key of "
       "[[material]]); its keys are \"gravity\", \"body_force\" and \"parameters\"\n9:1: unknown key \"mu\" in [load] "
       "(\"mu\" is a key of [[material]]); its keys are \"gravity\", \"body_force\" and \"parameters\""},
  };
  for (const MalformedCase& malformed : cases) expect_problems(malformed);
}

TEST(MalformedCase, KeysOfOtherSectionsAreNamedWithThem) {
  const std::string wall = "[obstacle.wall]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n";
  const std::vector<std::pair<std::string, std::string>> expected{
      {"friction = 0.3",
       "unknown key \"friction\" in [obstacle.wall] (\"friction\" is a key of [[contact]]); its keys "
       "are \"type\", "},
      {"rest_gap = 0.1", "(\"rest_gap\" is a key of [mesh] and of [part.NAME]); "},
      {"frictoin = 0.3", "unknown key \"frictoin\" in [obstacle.wall]; its keys are "},
      // too many sections have it, or it is one
      {"group = \"a\"", "unknown key \"group\" in [obstacle.wall]; "},
      {"contact = 1", "unknown key \"contact\" in [obstacle.wall]; "}};
  for (const auto& [key, problem] : expected) {
    const std::string found = problems_of(edited_case(0, wall + key));
    EXPECT_NE(found.find(problem), std::string::npos) << found;
  }
}

}  // namespace ricochet::case_test
