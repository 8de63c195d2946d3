#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "ricochet/base/text.hpp"
#include "ricochet/fem/cell_masses.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Bodies that move at the start: v(X) = velocity + spin × (X − c).
namespace ricochet {

namespace {

/// Returns "part "ball"", "group "left"" or "the mesh".
std::string text_of(const MotionSection& motion) {
  if (motion.part.empty() && motion.group.empty()) return "the mesh";
  return motion.part.empty() ? fmt::format("group \"{}\"", motion.group) : fmt::format("part \"{}\"", motion.part);
}

std::string key_of_cells(const MotionSection& motion) {
  return motion.group.empty() ? motion.section : motion.section + ".group";
}

std::vector<Index> cells_of(const Case& input, const MotionSection& motion, const Mesh& mesh) {
  for (const MeshPart& part : mesh.parts) {
    if (part.name == motion.part) return part.cells;
  }
  if (motion.group.empty()) {
    std::vector<Index> all(static_cast<std::size_t>(mesh.cell_count()));
    std::iota(all.begin(), all.end(), Index{0});
    return all;
  }
  return group_at(input, key_of_cells(motion), mesh, motion.group, mesh.dimension).members;
}

/// Refuses two motions of one node, at the second one.
[[noreturn]] void refuse_both(const Case& input, int a, int b, const std::string& shared) {
  const MotionSection& first = input.motions[std::size_t(std::min(a, b))];
  const MotionSection& second = input.motions[std::size_t(std::max(a, b))];
  refuse(input, key_of_cells(second),
         fmt::format("{} shares {} with {}, which has a motion at {}: use groups that have no node in common",
                     text_of(second), shared, text_of(first), input.where(key_of_cells(first)).text()));
}

/// Returns per node the index of its motion; −1 if none.
std::vector<int> motions_of_nodes(const Case& input, const Model& model, const std::vector<int>& of_cell) {
  std::vector<int> of_node(static_cast<std::size_t>(model.space.node_count()), -1);
  std::size_t number = 0;
  for (const CellBlock& block : model.space.cells) {
    for (Index cell = 0; cell < block.size(); ++cell, ++number) {
      if (of_cell[number] < 0) continue;
      for (int k = 0; k < block.nodes_per_cell; ++k) {
        int& motion = of_node[std::size_t(block.cell(cell)[k])];
        if (motion < 0) motion = of_cell[number];
        if (motion != of_cell[number]) refuse_both(input, motion, of_cell[number], "nodes");
      }
    }
  }
  return of_node;
}

/// Returns per cell the index of its motion; −1 if none.
std::vector<int> motions_of_cells(const Case& input, const Model& model) {
  std::vector<int> of_cell(static_cast<std::size_t>(model.mesh.cell_count()), -1);
  for (std::size_t i = 0; i < input.motions.size(); ++i) {
    for (const Index cell : cells_of(input, input.motions[i], model.mesh)) {
      int& motion = of_cell[std::size_t(cell)];
      if (motion >= 0) refuse_both(input, motion, int(i), "cells");
      motion = int(i);
    }
  }
  return of_cell;
}

/// Returns the centres of mass of the nodes with the masses ∫ρ φ_i over the cells of each motion. With them a spin has
/// no linear momentum, up to rounding, even where cells are curved and the displacement is of degree 1.
Points centres_of_mass(const Model& model, const std::vector<int>& of_cell, std::size_t motions) {
  const Points& nodes = model.space.nodes;
  Points moments = Points::Zero(nodes.rows(), Index(motions));
  std::vector<double> masses(motions, 0.0);
  // Moments are taken about a node of the motion's own cells, to lose no digits far from the origin.
  std::vector<Index> origins(motions, -1);
  std::size_t cell = 0;
  CellMasses(model.body).for_each([&](const std::vector<Index>& of_nodes, const Matrix& mass) {
    const int motion = of_cell[cell++];
    if (motion < 0) return;
    const auto m = std::size_t(motion);
    if (origins[m] < 0) origins[m] = of_nodes.front();
    const Vector shares = mass.rowwise().sum();
    for (std::size_t k = 0; k < of_nodes.size(); ++k)
      moments.col(motion) += shares[Index(k)] * (nodes.col(of_nodes[k]) - nodes.col(origins[m]));
    masses[m] += shares.sum();
  });
  for (std::size_t m = 0; m < motions; ++m) {
    const auto column = Index(m);
    moments.col(column) = moments.col(column) / masses[m] + nodes.col(origins[m]);
  }
  return moments;
}

/// Returns spin × arm; in two dimensions the spin is about the third axis.
Vector cross(const std::vector<double>& spin, const Vector& arm) {
  if (arm.size() == 2) return Eigen::Vector2d(-spin[0] * arm[1], spin[0] * arm[0]);
  return Eigen::Vector3d(spin[0], spin[1], spin[2]).cross(Eigen::Vector3d(arm));
}

}  // namespace

void check_motions(const Case& input, int dimension) {
  for (const MotionSection& motion : input.motions) {
    check_length(input, motion.section + ".velocity", motion.velocity.size(), dimension);
    check_length(input, motion.section + ".about", motion.about.size(), dimension);
    const std::size_t entries = motion.spin.size(), required = dimension == 2 ? 1 : 3;
    if (entries == 0 || entries == required) continue;
    refuse(input, motion.section + ".spin",
           dimension == 2
               ? fmt::format(
                     "\"spin\" has {}, but the mesh has dimension 2, where it must be one number: write spin = 3.0",
                     counted(entries, "entry", "entries"))
               : std::string("\"spin\" is a number, but the mesh has dimension 3, where it must be a vector: write "
                             "spin = [0.0, 0.0, 3.0]"));
  }
}

void add_motions(const Case& input, Model& model) {
  if (input.motions.empty()) return;
  const std::vector<int> of_cell = motions_of_cells(input, model);
  const std::vector<int> of_node = motions_of_nodes(input, model, of_cell);
  const Points centres = centres_of_mass(model, of_cell, input.motions.size());
  const int d = model.mesh.dimension;
  for (Index node = 0; node < model.space.node_count(); ++node) {
    const int number = of_node[std::size_t(node)];
    if (number < 0) continue;
    const MotionSection& motion = input.motions[std::size_t(number)];
    auto velocity = model.initial.velocity.segment(node * d, d);
    if (!motion.velocity.empty()) velocity += vector_of(motion.velocity);
    if (motion.spin.empty()) continue;
    const Vector centre = motion.about.empty() ? Vector(centres.col(number)) : vector_of(motion.about);
    velocity += cross(motion.spin, model.space.nodes.col(node) - centre);
  }
}

}  // namespace ricochet
