#include <gtest/gtest.h>

#include "case_text.hpp"

// Malformed case files: obstacles, contact, supports, loads, probes and expectations.
namespace ricochet::case_test {

TEST(MalformedCase, References) {
  const std::string quantities =
      "history.COLUMN[i], history.COLUMN(t=T), max(history.COLUMN), min(history.COLUMN), max_abs(history.COLUMN), "
      "total_variation(history.COLUMN), mean(history.COLUMN), integral(history.COLUMN), first_time(history.COLUMN > "
      "X), last_time(history.COLUMN > X), FUNCTION(history.COLUMN, T0, T1) or summary.PATH";
  const std::vector<MalformedCase> cases{
      // contact
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"flor\"",
       "18:12: there is no [obstacle.flor]; did you mean \"floor\"?"},
      {0, "[[contact]]\ngroup = \"low\"\nobstacle = \"floor\"",
       "14:12: there is no [obstacle.floor]; the case has no obstacles"},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"ceiling\"",
       "18:12: there is no [obstacle.ceiling]; the obstacles are \"floor\""},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"floor\"\nfriction_bound = -1",
       "19:18: \"friction_bound\" must be a number of at least 0 (unit: stress); found the integer -1"},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"floor\"\nfriction = \"0.3\"",
       "19:12: \"friction\" must be a number of at least 0; found the text \"0.3\""},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"floor\"\nfrictoin = 0.3",
       "19:1: unknown key \"frictoin\" in [[contact]]; did you mean \"friction\"?"},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"floor\"\nunstable_multipliers = true",
       "19:24: \"unstable_multipliers\" must be \"refuse\" or \"allow\"; found the boolean true"},
      {0, "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\nvelocity = 1.0",
       "16:12: \"velocity\" must be a vector of 2 or 3 numbers (unit: length/time); found the number 1.0"},
      {0, "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\nvelocity = [1.0, 0, 0]",
       "16:12: \"velocity\" of [obstacle.floor] has 3 entries, but \"point\" of [obstacle.floor] at 14:9 has 2: all "
       "vectors must have as many entries as the mesh has dimensions"},
      {0, "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\nrotation_rate = [1.0]",
       "16:17: \"rotation_rate\" must be a number (unit: angle/time); found a list of 1 value"},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"floor\"\nfriction = -0.3",
       "19:12: \"friction\" must be a number of at least 0; found the number -0.3"},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"floor\"\nmultipliers = \"mortar\"",
       "19:15: \"multipliers\" must be one of \"nodal\", \"p0\", \"p1\" or \"dual\"; found the text \"mortar\""},
      {0,
       "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\ngroup = \"low\"\nobstacle = "
       "\"floor\"\n[[contact]]\ngroup = \"low\"\nobstacle = \"floor\"",
       "20:9: the group \"low\" is already in another [[contact]], at 17:9"},
      {0, "[obstacle.floor]\ntype = \"teapot\"\npoint = [0, 0]\nnormal = [0, 1]",
       "13:8: \"type\" must be one of \"plane\", \"sphere\", \"cylinder\", \"torus\", \"surface\" or \"implicit\"; "
       "found the text \"teapot\". Shape of the obstacle: a plane with a half-space behind it; a sphere, cylinder or "
       "torus, touched from outside or from inside; a surface from a file; or a shape described by an expression."},
      // Keys of another shape cause no further messages.
      {0,
       "[obstacle.ring]\ntype = \"teapot\"\ncentre = [0, 0, 0]\nminor = 1.0\n[[contact]]\ngroup = "
       "\"low\"\nobstacle = \"ring\"",
       "13:8: \"type\" must be one of \"plane\", \"sphere\", \"cylinder\", \"torus\", \"surface\" or \"implicit\"; "
       "found the text \"teapot\". Shape of the obstacle: a plane with a half-space behind it; a sphere, cylinder or "
       "torus, touched from outside or from inside; a surface from a file; or a shape described by an expression."},
      {0, "[obstacle.ball]\ntype = \"sphere\"\npoint = [0, 0]\nradius = -1\nside = \"within\"",
       "12:1: [obstacle.ball] has no \"centre\": a vector of 2 or 3 numbers (unit: length). Centre of the sphere; in "
       "two "
       "dimensions of the circle.\n14:9: \"point\" is for the type \"plane\" only; the type is \"sphere\"\n15:10: "
       "\"radius\" must be a positive number (unit: length); found the integer -1\n16:8: \"side\" must be \"outside\" "
       "or "
       "\"inside\"; found the text \"within\""},
      {0, "[obstacle.floor]\ntype = \"plain\"\nnrmal = [0, 1]",
       "13:8: \"type\" must be one of \"plane\", \"sphere\", \"cylinder\", \"torus\", \"surface\" or \"implicit\"; "
       "found the text \"plain\"; did you mean \"plane\"?"},
      // A key that the type does not accept is not suggested.
      {0, "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\nradus = 1",
       "16:1: unknown key \"radus\" in [obstacle.floor]; \"radius\" is for the types \"sphere\" and \"cylinder\" only; "
       "the type is "
       "\"plane\""},
      {10, "step = 0.1\nbeat = 0.25",
       "11:1: unknown key \"beat\" in [time]; \"beta\" is for the scheme \"newmark\" only; the scheme is \"midpoint\""},
      {0, "[obstacle.floor]\ntype = \"plane\"\npiont = [0, 0]\nnormal = [0, 1]",
       "14:1: unknown key \"piont\" in [obstacle.floor]; did you mean \"point\"?"},
      {0, "[obstacle.floor]\ntype = 3",
       "13:8: \"type\" must be one of \"plane\", \"sphere\", \"cylinder\", \"torus\", \"surface\" or \"implicit\"; "
       "found the integer 3. Shape of the obstacle: a plane with a half-space behind it; a sphere, cylinder or torus, "
       "touched from outside or from inside; a surface from a file; or a shape described by an expression."},
      {0, "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 0]",
       "15:10: \"normal\" must not be zero: it points out of the obstacle"},
      {0, "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 0, 1]",
       "15:10: \"normal\" of [obstacle.floor] has 3 entries, but \"point\" of [obstacle.floor] at 14:9 has 2: all "
       "vectors must have as many entries as the mesh has dimensions"},
      {0, "[obstacle.floor]\npoint = [0]\nnormal = [0, 1, 2, 3]",
       "12:1: [obstacle.floor] has no \"type\": one of \"plane\", \"sphere\", \"cylinder\", \"torus\", \"surface\" or "
       "\"implicit\". Shape of the obstacle: a plane with a half-space behind it; a sphere, cylinder or torus, touched "
       "from outside or from inside; a surface from a file; or a shape described by an expression.\n13:9: \"point\" "
       "must be a vector of 2 or 3 numbers (unit: length); found a list of 1 value\n14:10: \"normal\" must be a vector "
       "of 2 or 3 numbers; found a list of 4 values"},
      {0, "[obstacle.floor]\ntype = \"plane\"\npoint = [0, \"a\"]\nnormal = [nan, 1]",
       "14:13: entry 2 of \"point\" must be a finite number; found the text \"a\"\n15:11: entry 1 of \"normal\" must "
       "be a finite number; found the number nan"},
      // loads
      {0, "[[support]]\ngroup = \"a\"\ncomponents = []",
       "14:14: \"components\" must be a list with one or more of \"x\", \"y\" and \"z\"; found an empty list"},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"x\", \"x\"]", "14:20: an entry of \"components\" repeats \"x\""},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"w\", 3]",
       "14:15: an entry of \"components\" must be \"x\", \"y\" or \"z\"; found the text \"w\"\n14:20: an entry of "
       "\"components\" must be \"x\", \"y\" or \"z\"; found the integer 3"},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = \"x\"",
       "14:14: \"components\" must be a list with one or more of \"x\", \"y\" and \"z\"; found the text \"x\""},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"x\"]\nvalue = \"2*x\"",
       "15:9: \"value\": the expression \"2*x\" depends on the position; only t can be used here"},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"x\"]\nvalue = [1.0]",
       "15:9: \"value\" must be a number or an expression in t (unit: length); found a list of 1 value"},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"x\"]\nvalue = \"sin(t\"",
       "15:9: \"value\": in the expression \"sin(t\": Missing parenthesis"},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"x\"]\nvalue = inf",
       "15:9: \"value\" must be a number or an expression in t (unit: length); found the number inf, which is not "
       "finite"},
      {0, "[[support]]\ngroup = \"a\"\ncomponents = [\"x\"]\nvalue = \"p*t\"\nparameters = { p = \"a\" }",
       "16:20: the parameter \"p\" must be a finite number; found the text \"a\""},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = [\"0\", \"q*t\"]\nparameters = { p = 1.0 }",
       "14:15: \"value\": in the expression \"q*t\": unknown name \"q\"; known names are \"x\", \"y\", "
       "\"z\", \"t\", \"pi\" and \"p\""},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = 3.0",
       "14:9: \"value\" must be a vector of 2 or 3 numbers or expressions in x, y, z and t (unit: stress); found the "
       "number 3.0"},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = [0, true]",
       "14:13: entry 2 of \"value\" must be a finite number or an expression; found the boolean true"},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = \"static\"",
       "14:9: \"value\" must be a vector of 2 or 3 numbers or expressions in x, y, z and t (unit: stress); found the "
       "text \"static\""},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = [\"0\", \"t\"]\nparameters = { t = 1.0 }",
       "15:16: \"t\" cannot be the name of a parameter: x, y, z, t and pi are reserved"},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = [\"0\", \"t\"]\nparameters = { a-b = 1.0 }",
       "15:16: \"a-b\" cannot be the name of a parameter: it must consist of letters, digits and _, and not begin with "
       "a digit"},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = [\"0\", \"t\"]\nparameters = 3",
       "15:14: \"parameters\" must be a table of numbers; found the integer 3"},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = [\"0\", \"\"]",
       "14:15: \"value\": in the expression \"\": Expression is empty."},
      {0, "[[traction]]\ngroup = \"a\"\nvalue = [\"0\", \"1/0\"]",
       "14:15: \"value\": the expression \"1/0\" has no finite value"},
      {0, "[load]\ngravity = 9.81",
       "13:11: \"gravity\" must be a vector of 2 or 3 numbers (unit: acceleration); found the number 9.81"},
      {0, "[load]\ngravity = [\"0\", -9.81]",
       "13:12: entry 1 of \"gravity\" must be a finite number; found the text \"0\""},
      {0, "[load]\ngravity = [0, -9.81]\nbody_force = [0, 0, \"x\"]",
       "14:14: \"body_force\" of [load] has 3 entries, but \"gravity\" of [load] at 13:11 has 2: all vectors must have "
       "as many entries as the mesh has dimensions"},
      {0, "[initial]\ndisplacement = \"statc\"",
       "13:16: \"displacement\" must be a vector of 2 or 3 numbers or expressions in x, y and z, or \"static\" (unit: "
       "length); found the text \"statc\"; did you mean \"static\"?"},
      {0, "[initial]\ndisplacement = [\"0\", \"t\"]",
       "13:22: \"displacement\": the expression \"t\" depends on the time t; only x, y and z can be used here"},
      {0, "[initial]\nvelocity = [\"t\", 0]",
       "13:13: \"velocity\": the expression \"t\" depends on the time t; only x, y and z can be used here"},
      {0, "[initial]\nvelocity = \"static\"",
       "13:12: \"velocity\" must be a vector of 2 or 3 numbers or expressions in x, y and z (unit: length/time); found "
       "the text \"static\""},
      // outputs
      {0, "[[probe]]\nname = \"a b\"\nat = [0, 0]", "13:8: the name \"a b\" can only contain letters, digits, _ and -"},
      {0, "[[probe]]\nname = \"time\"\nat = [0, 0]",
       "13:8: the name \"time\" is already that of a standard column of history.csv"},
      {0, "[[probe]]\nname = \"a\"\nat = [0, 0]\n[[probe]]\nname = \"a\"\nat = [0, 1]",
       "16:8: the name \"a\" is already in another [[probe]], at 13:8"},
      {0, "[[probe]]\nname = \"a\"\nat = 0.0",
       "14:6: \"at\" must be a vector of 2 or 3 numbers (unit: length); found the number 0.0"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"",
       "12:1: [[expect]] expects nothing: set \"value\" with \"relative\" or \"absolute\", or bounds (\"minimum\", "
       "\"maximum\")"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nvalue = 1.0",
       "14:9: \"value\" needs a tolerance: \"relative\", \"absolute\" or both"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nrelative = 1.0",
       "14:12: \"relative\" is a tolerance of \"value\", which is missing"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nvalue = 1.0\nabsolute = 0.1\nmaximum = 2.0",
       "14:9: [[expect]] has either \"value\" or bounds (\"minimum\", \"maximum\"), not both"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nmaximum = 2.0",
       "14:11: \"minimum\" is 3, above \"maximum\", which is 2"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nwhen = { \"time.shceme\" = \"midpoint\" }",
       "15:10: \"when\" names \"time.shceme\": unknown key \"shceme\" in [time]; did you mean \"scheme\"?"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nwhen = { \"time.scheme\" = \"midpont\" }",
       "15:26: \"time.scheme\" must be one of " + all_schemes() +
           "; "
           "found the text "
           "\"midpont\"; did you mean \"midpoint\"?"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nwhen = { \"contact.0.friction\" = 0 }",
       "15:10: \"when\" names \"contact.0.friction\": there is no entry 0 of [[contact]]: the case has none"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nwhen = { \"contact.friction\" = 0 }",
       "15:10: \"when\" names \"contact.friction\": [[contact]] is a list: specify the entry, counted from 0, as in "
       "contact.0.group"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nwhen = { \"mesh\" = \"a\" }",
       "15:10: \"when\" names \"mesh\": \"mesh\" is a section: specify one of its keys, as in mesh.file"},
      {0, "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nwhen = \"midpoint\"",
       "15:8: \"when\" must be a table of key paths and their values; found the text \"midpoint\""},
      {0,
       "[[expect]]\nquantity = \"history.time[-1]\"\nminimum = 3.0\nwhen = { mass.type = \"lumpd\", time.step = \"a\" "
       "}",
       "15:22: \"mass.type\" must be one of \"consistent\", \"lumped\", \"equivalent\", \"equivalent-nodewise\", "
       "\"equivalent-cellwise\", \"equivalent-compact\", "
       "\"equivalent-nearest\" or "
       "\"equivalent-lumped\"; "
       "found the text \"lumpd\"; did you mean \"lumped\"?\n15:43: \"time.step\" must be a positive number, or "
       "\"adaptive\" (unit: "
       "time); found the text \"a\""},
      {0, "[[expect]]\nquantity = \"history.time\"\nminimum = 3.0",
       "13:12: \"history.time\" is not a quantity: the row is missing: add [i], as in [-1] for the last row, or a "
       "time, as in (t=0.5); write " +
           quantities},
      {0, "[[expect]]\nquantity = \"history.time[1]\"\nover = \"history.time()\"\nminimum = 3.0",
       "14:8: \"history.time()\" is not a quantity: the parentheses must contain a time, as in (t=0.5); write " +
           quantities},
  };
  for (const MalformedCase& malformed : cases) expect_problems(malformed);
}

}  // namespace ricochet::case_test
