#include "support/strip.hpp"

#include <fmt/format.h>

#include "support/case_run.hpp"

namespace ricochet::test_support {

std::string strip_mesh(double x0, double length, int cells, bool triangles) {
  const double h = length / cells;
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"left\"\n1 2 \"right\"\n1 3 \"sides\"\n2 4 "
      "\"body\"\n$EndPhysicalNames\n";
  text += fmt::format("$Nodes\n{}\n", 2 * (cells + 1));
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j < 2; ++j)
      text += fmt::format("{} {:.17g} {:.17g} 0\n", 2 * i + j + 1, x0 + length * i / cells, h * j);
  }
  std::string elements;
  int number = 0;
  const auto add = [&](int type, int group, const std::string& nodes) {
    elements += fmt::format("{} {} 2 {} {} {}\n", ++number, type, group, group, nodes);
  };
  add(1, 1, "1 2");
  add(1, 2, fmt::format("{} {}", 2 * cells + 1, 2 * cells + 2));
  for (int i = 0; i < cells; ++i) {
    const int a = 2 * i + 1, b = a + 1, c = a + 2, d = a + 3;  // lower left, upper left, lower right, upper right
    add(1, 3, fmt::format("{} {}", a, c));
    add(1, 3, fmt::format("{} {}", b, d));
    if (triangles) {
      add(2, 4, i % 2 == 0 ? fmt::format("{} {} {}", a, c, d) : fmt::format("{} {} {}", a, c, b));
      add(2, 4, i % 2 == 0 ? fmt::format("{} {} {}", a, d, b) : fmt::format("{} {} {}", c, d, b));
    } else {
      add(3, 4, fmt::format("{} {} {} {}", a, c, d, b));
    }
  }
  text += fmt::format("$EndNodes\n$Elements\n{}\n{}$EndElements\n", number, elements);
  return write_temporary(fmt::format("strip{}{}.msh", cells, triangles ? "t" : "q"), text);
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
