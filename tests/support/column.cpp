#include "support/column.hpp"

#include <fmt/format.h>

#include "support/case_run.hpp"

namespace ricochet::test_support {

std::string column_mesh(double width, int cells) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"base\"\n1 2 \"top\"\n1 3 \"sides\"\n2 4 "
      "\"body\"\n$EndPhysicalNames\n";
  text += fmt::format("$Nodes\n{}\n", 2 * (cells + 1));
  for (int j = 0; j <= cells; ++j) {
    text += fmt::format("{} 0 {:.17g} 0\n", 2 * j + 1, static_cast<double>(j) / cells);
    text += fmt::format("{} {:.17g} {:.17g} 0\n", 2 * j + 2, width, static_cast<double>(j) / cells);
  }
  std::string elements;
  int number = 0;
  const auto add = [&](int type, int group, const std::string& nodes) {
    elements += fmt::format("{} {} 2 {} {} {}\n", ++number, type, group, group, nodes);
  };
  add(1, 1, "1 2");
  add(1, 2, fmt::format("{} {}", 2 * cells + 1, 2 * cells + 2));
  for (int j = 0; j < cells; ++j) {
    const int a = 2 * j + 1, b = a + 1, c = a + 2, d = a + 3;  // lower left, lower right, upper left, upper right
    if (j > 0) {
      add(1, 3, fmt::format("{} {}", a, c));
      add(1, 3, fmt::format("{} {}", b, d));
    }
    add(3, 4, fmt::format("{} {} {} {}", a, b, d, c));
  }
  text += fmt::format("$EndNodes\n$Elements\n{}\n{}$EndElements\n", number, elements);
  return write_temporary(fmt::format("column{}.msh", cells), text);
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
