#include "support/column.hpp"

#include <fmt/format.h>

#include "support/case_run.hpp"
#include "support/msh_text.hpp"

namespace ricochet::test_support {

std::string column_mesh(double width, int cells) {
  MshText mesh({"base", "top", "sides"});
  for (int j = 0; j <= cells; ++j) {
    mesh.add_node(0.0, static_cast<double>(j) / cells);
    mesh.add_node(width, static_cast<double>(j) / cells);
  }
  mesh.add_edge(1, 1, 2);
  mesh.add_edge(2, 2 * cells + 1, 2 * cells + 2);
  for (int j = 0; j < cells; ++j) {
    const int a = 2 * j + 1, b = a + 1, c = a + 2, d = a + 3;  // lower left, lower right, upper left, upper right
    if (j > 0) {
      mesh.add_edge(3, a, c);
      mesh.add_edge(3, b, d);
    }
    mesh.add_quadrilateral(a, b, d, c);
  }
  return write_temporary(fmt::format("column{}.msh", cells), mesh.text());
}

std::string column_case(const std::string& mesh, double pressure, const std::string& contact, int degree) {
  return fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\n[[material]]\ngroup = \"body\"\nlambda = 0.0\nmu = 1.0\ndensity = 1.0\n"
      "[[support]]\ngroup = \"sides\"\ncomponents = [\"y\"]\n"
      "[obstacle.base]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
      "[[contact]]\ngroup = \"base\"\nobstacle = \"base\"\n{}\n"
      "[[traction]]\ngroup = \"base\"\nvalue = [0.0, {:.17g}]\n",
      mesh, degree, contact, -pressure);
}

}  // namespace ricochet::test_support
