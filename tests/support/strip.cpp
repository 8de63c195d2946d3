#include "support/strip.hpp"

#include <fmt/format.h>

#include "support/case_run.hpp"
#include "support/msh_text.hpp"

namespace ricochet::test_support {

std::string strip_mesh(double x0, double length, int cells, bool triangles) {
  const double h = length / cells;
  MshText mesh({"left", "right", "sides"});
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j < 2; ++j) mesh.add_node(x0 + length * i / cells, h * j);
  }
  mesh.add_edge(1, 1, 2);
  mesh.add_edge(2, 2 * cells + 1, 2 * cells + 2);
  for (int i = 0; i < cells; ++i) {
    const int a = 2 * i + 1, b = a + 1, c = a + 2, d = a + 3;  // lower left, upper left, lower right, upper right
    mesh.add_edge(3, a, c);
    mesh.add_edge(3, b, d);
    if (!triangles) {
      mesh.add_quadrilateral(a, c, d, b);
    } else if (i % 2 == 0) {
      mesh.add_triangle(a, c, d);
      mesh.add_triangle(a, d, b);
    } else {
      mesh.add_triangle(a, c, b);
      mesh.add_triangle(c, d, b);
    }
  }
  return write_temporary(fmt::format("strip{}{}.msh", cells, triangles ? "t" : "q"), mesh.text());
}

std::string strip_case(const std::string& mesh, double young, double density, int degree) {
  return fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\n[[material]]\ngroup = \"body\"\nyoung = {}\npoisson = 0.0\ndensity = {}\n"
      "[[support]]\ngroup = \"sides\"\ncomponents = [\"y\"]\nvalue = 0.0\n"
      "[obstacle.wall]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [1.0, 0.0]\n"
      "[[contact]]\ngroup = \"left\"\nobstacle = \"wall\"\n",
      mesh, degree, young, density);
}

}  // namespace ricochet::test_support
