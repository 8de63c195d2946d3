#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

/// @file Meshes written by hand, as .msh files (2.2, ASCII) of two-dimensional bodies.
namespace ricochet::test_support {

class MshText {
 public:
  /// `edge_groups` are the names of the groups of edges, numbered from 1; the cells are the last group, "body".
  explicit MshText(const std::vector<std::string>& edge_groups) : body_(int(edge_groups.size()) + 1) {
    head_ = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n", body_);
    for (int i = 1; i < body_; ++i) head_ += fmt::format("1 {} \"{}\"\n", i, edge_groups[std::size_t(i) - 1]);
    head_ += fmt::format("2 {} \"body\"\n$EndPhysicalNames\n", body_);
  }

  /// Nodes are numbered from 1 in the order in which they are added.
  void add_node(double x, double y) { nodes_ += fmt::format("{} {:.17g} {:.17g} 0\n", ++node_count_, x, y); }
  void add_edge(int group, int a, int b) { add(1, group, fmt::format("{} {}", a, b)); }
  void add_triangle(int a, int b, int c) { add(2, body_, fmt::format("{} {} {}", a, b, c)); }
  void add_quadrilateral(int a, int b, int c, int d) { add(3, body_, fmt::format("{} {} {} {}", a, b, c, d)); }

  [[nodiscard]] std::string text() const {
    return head_ + fmt::format("$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n", node_count_, nodes_,
                               element_count_, elements_);
  }

 private:
  void add(int type, int group, const std::string& nodes) {
    elements_ += fmt::format("{} {} 2 {} {} {}\n", ++element_count_, type, group, group, nodes);
  }

  int body_;
  int node_count_ = 0, element_count_ = 0;
  std::string head_, nodes_, elements_;
};

}  // namespace ricochet::test_support
