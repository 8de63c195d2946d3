#include <gtest/gtest.h>

#include "case_text.hpp"

// Malformed case files: types, bounds, choices, materials and the time section.
namespace ricochet::case_test {

TEST(MalformedCase, Values) {
  const std::vector<MalformedCase> cases{
      // types
      {5, "density = \"heavy\"",
       "5:11: \"density\" must be a positive number (unit: density); found the text \"heavy\""},
      {5, "density = true", "5:11: \"density\" must be a positive number (unit: density); found the boolean true"},
      {5, "density = 1979-05-27", "5:11: \"density\" must be a positive number (unit: density); found a date or time"},
      {5, "density = [1.0]", "5:11: \"density\" must be a positive number (unit: density); found a list of 1 value"},
      {5, "density = nan",
       "5:11: \"density\" must be a positive number (unit: density); found the number nan, which is not finite"},
      {5, "density = inf",
       "5:11: \"density\" must be a positive number (unit: density); found the number inf, which is not finite"},
      {5, "density = -1.0", "5:11: \"density\" must be a positive number (unit: density); found the number -1.0"},
      {5, "density = 0", "5:11: \"density\" must be a positive number (unit: density); found the integer 0"},
      {2, "file = 3", "2:8: \"file\" must be a text that is not empty; found the integer 3"},
      {2, "file = \"a.msh\"\ndegree = 1.0", "3:10: \"degree\" must be 1 or 2; found the number 1.0"},
      {2, "file = \"a.msh\"\ndegree = 3", "3:10: \"degree\" must be 1 or 2; found the integer 3"},
      {2, "file = \"a.msh\"\nscale = 0.0", "3:9: \"scale\" must be a positive number; found the number 0.0"},
      {2, "file = \"a.msh\"\nplane = \"stres\"",
       "3:9: \"plane\" must be one of \"strain\", \"stress\" or \"axisymmetric\"; found the text \"stres\"; did you "
       "mean \"stress\"?"},
      {2, "file = \"a.msh\"\nplane = \"plane stress\"",
       "3:9: \"plane\" must be one of \"strain\", \"stress\" or \"axisymmetric\"; found the text \"plane stress\"; did "
       "you mean \"stress\"?"},
      {2, "file = \"a.msh\"\nsize = 0.1",
       "3:8: \"size\" is only for geometry that the gmsh program meshes; \"a.msh\" is already a mesh"},
      {2, "file = \"a.MSH\"\nsize = 0.1",
       "3:8: \"size\" is only for geometry that the gmsh program meshes; \"a.MSH\" is already a mesh"},
      {2, "file = \"a.geo\"\nsize = -1",
       "3:8: \"size\" must be a positive number (unit: length); found the integer -1"},
      {7, "mu = 1.0\ndamping = 3",
       "8:11: \"damping\" must be a table with \"mass\" and \"stiffness\"; found the integer 3"},
      {7, "mu = 1.0\ndamping = { mass = -1.0 }",
       "8:20: \"mass\" must be a number of at least 0 (unit: 1/time); found the number -1.0"},
      {7, "mu = 1.0\nrelaxation = { modulus = [0.5, -1.0], time = [1.0, 2.0] }",
       "8:32: entry 2 of \"modulus\" must be a positive number; found the number -1.0"},
      {7, "mu = 1.0\nrelaxation = { modulus = [0.5], time = [1.0, 2.0] }",
       "8:40: \"modulus\" and \"time\" must have one entry for each branch, but have 1 and 2 entries"},
      {9, "scheme = \"newmrk\"",
       "9:10: \"scheme\" must be one of " + all_schemes() +
           "; found the "
           "text \"newmrk\"; "
           "did you mean \"newmark\"?"},
      {9, "scheme = \"euler\"",
       "9:10: \"scheme\" must be one of " + all_schemes() +
           "; found the "
           "text \"euler\""},
      {9, "scheme = 3",
       "9:10: \"scheme\" must be one of " + all_schemes() +
           "; found the "
           "integer 3"},
      {0, "[mass]\ntype = \"equivalent_nearest\"",
       "13:8: \"type\" must be one of \"consistent\", \"lumped\", \"equivalent\", \"equivalent-nodewise\", "
       "\"equivalent-cellwise\", \"equivalent-compact\", "
       "\"equivalent-nearest\" or "
       "\"equivalent-lumped\"; found the "
       "text \"equivalent_nearest\"; did you mean \"equivalent-nearest\"?"},
      {0, "[solver]\nmethod = \"direct solver\"",
       "13:10: \"method\" must be one of \"auto\", \"direct\" or \"iterative\"; found the text \"direct solver\"; did "
       "you mean \"direct\"?"},
      // decimal commas
      {0, "[load]\ngravity = [1,5, -0,5]",
       "13:11: \"gravity\" must be a vector of 2 or 3 numbers (unit: acceleration); found a list of 4 values; if their "
       "commas are decimal ones, use decimal points"},
      {0, "[load]\ngravity = [1, 5, 0, 5]",
       "13:11: \"gravity\" must be a vector of 2 or 3 numbers (unit: acceleration); found a list of 4 values"},
      {0, "[output]\nhistory_every = 0",
       "13:17: \"history_every\" must be an integer of at least 1 (unit: steps); found the integer 0"},
      {0, "[output]\nfields_every = -1",
       "13:16: \"fields_every\" must be an integer of at least 0 (unit: steps); found the integer -1"},
      {0, "[output]\nfields_every = 2.5",
       "13:16: \"fields_every\" must be an integer of at least 0 (unit: steps); found the number 2.5"},
      {0, "[output]\nhistory_every = \"1\"",
       "13:17: \"history_every\" must be an integer of at least 1 (unit: steps); found the text \"1\""},
      {0, "[solver]\nmethod = \"iteratve\"",
       "13:10: \"method\" must be one of \"auto\", \"direct\" or \"iterative\"; found the text \"iteratve\"; did you "
       "mean "
       "\"iterative\"?"},
      {0, "[solver]\ntolerance = 0.0",
       "13:13: \"tolerance\" must be a number above 0 and of at most 0.001; found the number 0.0"},
      {0, "[solver]\ntolerance = 0.01",
       "13:13: \"tolerance\" must be a number above 0 and of at most 0.001; found the number 0.01"},
      {0, "[solver]\nmemory = 0", "13:10: \"memory\" must be a positive number (unit: GB); found the integer 0"},
      {0, "[solver]\ncontact_points = \"none\"",
       "13:18: \"contact_points\" must be \"near\" or \"all\"; found the text \"none\""},
      {1, "title = 3\n[mesh]", "1:9: \"title\" must be a text; found the integer 3"},
      // materials
      {6, "", "3:1: [[material]] needs either \"lambda\" and \"mu\" or \"young\" and \"poisson\"; found \"mu\""},
      {6, "young = 1.0",
       "3:1: [[material]] needs either \"lambda\" and \"mu\" or \"young\" and \"poisson\"; found \"mu\" and \"young\""},
      {7, "mu = 1.0\nyoung = 1.0\npoisson = 0.3",
       "3:1: [[material]] needs either \"lambda\" and \"mu\" or \"young\" and \"poisson\"; found \"lambda\", \"mu\", "
       "\"young\" and \"poisson\""},
      {6, "lambda = -1.0", "6:10: 3 lambda + 2 mu must be positive (the bulk modulus is a third of it); it is -1"},
      {7, "mu = 0.0", "7:6: \"mu\" must be a positive number (unit: stress); found the number 0.0"},
      {6, "young = 1.0\npoisson = 0.3",
       "3:1: [[material]] needs either \"lambda\" and \"mu\" or \"young\" and \"poisson\"; found \"mu\", \"young\" and "
       "\"poisson\""},
      {0, "[[material]]\ngroup = \"b\"\ndensity = 1\nyoung = 1.0\npoisson = 0.5",
       "16:11: \"poisson\" must be a number above -1 and below 0.5; found the number 0.5"},
      {0, "[[material]]\ngroup = \"b\"\ndensity = 1\nyoung = 1.0\npoisson = -1",
       "16:11: \"poisson\" must be a number above -1 and below 0.5; found the integer -1"},
      {0, "[[material]]\ngroup = \"b\"\ndensity = 1\nyoung = 0\npoisson = 0.3",
       "15:9: \"young\" must be a positive number (unit: stress); found the integer 0"},
      {0, "[[material]]\ngroup = \"b\"\ndensity = 1\nyoung = 1e308\npoisson = 0.4999999999",
       "16:11: young = 1e+308 and poisson = 0.4999999999 give infinite lambda or mu"},
      {0, "[[material]]\ngroup = \"b\"\ndensity = 1",
       "12:1: [[material]] needs either \"lambda\" and \"mu\" or \"young\" and \"poisson\"; found none of them"},
      {0, "[[material]]\ngroup = \"body\"\ndensity = 1\nyoung = 1.0\npoisson = 0.3",
       "13:9: the group \"body\" is already in another [[material]], at 4:9"},
      // times
      {9, "scheme = \"newmark\"",
       "9:10: the scheme \"newmark\" needs \"beta\" and \"gamma\", or a \"preset\": \"trapezoidal\" (beta = 0.25, "
       "gamma = 0.5) or \"textbook-half\" (beta = 0.5, gamma = 0.5); \"beta\" is missing"},
      {9, "scheme = \"newmark\"\nbeta = 0.25",
       "9:10: the scheme \"newmark\" needs \"beta\" and \"gamma\", or a \"preset\": \"trapezoidal\" (beta = 0.25, "
       "gamma = 0.5) or \"textbook-half\" (beta = 0.5, gamma = 0.5); \"gamma\" is missing"},
      {9, "scheme = \"newmark\"\nbeta = 0.25\ngamma = 0.5\npreset = \"trapezoidal\"",
       "12:10: \"preset\" and \"beta\" are given together: \"preset\" sets beta and gamma, remove one or the "
       "other"},
      {9, "scheme = \"newmark\"\npreset = \"trapezodal\"",
       "10:10: \"preset\" must be \"trapezoidal\" or \"textbook-half\"; found the text \"trapezodal\"; did you mean "
       "\"trapezoidal\"?"},
      {9, "scheme = \"newmark\"\nbeta = 0.0\ngamma = 0.5",
       "10:8: \"beta\" must be a positive number; found the number 0.0"},
      {9, "scheme = \"newmark\"\nbeta = 0.25\ngamma = -0.5",
       "11:9: \"gamma\" must be a number of at least 0; found the number -0.5"},
      {9, "scheme = \"midpoint\"\nbeta = 0.25",
       "10:8: \"beta\" is for the scheme \"newmark\" only; the scheme is \"midpoint\""},
      {9, "scheme = \"klr-conserving\"\npreset = \"trapezoidal\"",
       "10:10: \"preset\" is for the scheme \"newmark\" only; the scheme is \"klr-conserving\""},
      {10, "step = 0", "10:8: \"step\" must be a positive number, or \"adaptive\" (unit: time); found the integer 0"},
      {10, "step = 2.0", "11:7: \"end\" is 1, before the end of the first step of 2"},
      {10, "step = 1e-10", "10:8: a step of 1e-10 up to the end 1 results in 1e+10 steps; at most 1e+09 are possible"},
      {11, "end = -1.0", "11:7: \"end\" must be a positive number (unit: time); found the number -1.0"},
  };
  for (const MalformedCase& malformed : cases) expect_problems(malformed);
}

TEST(MalformedCase, PartsOfANameSuggestIt) {
  const std::string laws = problems_of(edited_case(7, "mu = 1.0\nlaw = \"neohooke\""));
  EXPECT_NE(laws.find("found the text \"neohooke\"; did you mean \"neo-hookean\"?"), std::string::npos) << laws;
  const std::string fields = problems_of(edited_case(0, "[output]\nfields = [\"stres\"]"));
  EXPECT_NE(fields.find("found the text \"stres\"; did you mean \"stress\"?"), std::string::npos) << fields;
  // Several names have this part.
  const std::string alpha = problems_of(edited_case(9, "scheme = \"alpha\""));
  EXPECT_EQ(alpha.find("did you mean"), std::string::npos) << alpha;
}

}  // namespace ricochet::case_test
