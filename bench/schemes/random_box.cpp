#include <fmt/format.h>

#include <utility>
#include <vector>

#include "random_case.hpp"

std::string box_mesh(Random& random, int d, bool simplices, const std::array<int, 3>& counts,
                     const std::array<double, 3>& lengths) {
  const int nx = counts[0] + 1, ny = counts[1] + 1, nz = d == 3 ? counts[2] + 1 : 1;
  const auto number = [&](int i, int j, int k) { return 1 + i + nx * (j + ny * k); };
  std::string nodes, cells;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const auto place = [&](int at, int count, double length) {
          const bool inside = at > 0 && at < count;
          return length * (at + (inside ? random.between(-0.15, 0.15) : 0.0)) / count;
        };
        nodes += fmt::format("{} {:.17g} {:.17g} {:.17g}\n", number(i, j, k), place(i, counts[0], lengths[0]),
                             place(j, counts[1], lengths[1]), d == 3 ? place(k, counts[2], lengths[2]) : 0.0);
      }
    }
  }
  int count = 0;
  const auto add = [&](int type, int group, const std::vector<int>& of) {
    cells += fmt::format("{} {} 2 {} {}", ++count, type, group, group);
    for (const int node : of) cells += fmt::format(" {}", node);
    cells += "\n";
  };
  const auto facet = [&](int group, const std::vector<int>& of) {
    if (d == 2) return add(1, group, of);
    if (!simplices) return add(3, group, of);
    add(2, group, {of[0], of[1], of[2]});
    add(2, group, {of[0], of[2], of[3]});
  };
  if (d == 2) {
    for (int i = 0; i < counts[0]; ++i) {
      facet(2, {number(i, 0, 0), number(i + 1, 0, 0)});
      facet(3, {number(i, counts[1], 0), number(i + 1, counts[1], 0)});
    }
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        const int a = number(i, j, 0), b = number(i + 1, j, 0), c = number(i + 1, j + 1, 0), e = number(i, j + 1, 0);
        if (simplices) {
          add(2, 1, {a, b, c});
          add(2, 1, {a, c, e});
        } else {
          add(3, 1, {a, b, c, e});
        }
      }
    }
  } else {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        for (const int k : {0, counts[2]})
          facet(k == 0 ? 2 : 3, {number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k)});
      }
    }
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) {
          const std::array<int, 8> v{
              number(i, j, k),     number(i + 1, j, k),     number(i + 1, j + 1, k),     number(i, j + 1, k),
              number(i, j, k + 1), number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1), number(i, j + 1, k + 1)};
          if (!simplices) {
            add(5, 1, {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]});
            continue;
          }
          // Six tetrahedra around the diagonal 0–6; the facets of all cubes are divided alike.
          for (const auto& [p, q] : {std::pair{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}) {
            add(4, 1, {v[0], v[std::size_t(p)], v[std::size_t(q)], v[6]});
          }
        }
      }
    }
  }
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n{} 1 \"body\"\n{} 2 \"bottom\"\n{} 3 "
      "\"top\"\n$EndPhysicalNames\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
      d, d - 1, d - 1, nx * ny * nz, nodes, count, cells);
}
