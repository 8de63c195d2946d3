#pragma once

#include <string>
#include <vector>

/// @file Reads results.xdmf and obstacles.xdmf back: what is in each frame, and the surfaces of the obstacles. Only the
/// documents that XdmfFile writes are understood.
namespace ricochet {

struct XdmfField {
  std::string name;
  bool on_nodes = true;  ///< else on cells
  int components = 1;
};

/// The frames that are complete, also of a run that goes on.
struct XdmfFrames {
  std::vector<double> times;
  std::vector<XdmfField> fields;  ///< of the first frame
};

/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] XdmfFrames read_xdmf_frames(const std::string& path);

/// The surfaces of all obstacles at one time: lines in the plane, quadrilaterals in space.
struct ObstacleFrame {
  double time = 0.0;
  int corners = 2;                ///< of a cell
  std::vector<int> cells;         ///< cells × corners
  std::vector<double> positions;  ///< points × 3
  std::vector<int> obstacle;      ///< of each cell, from 0
};

/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] std::vector<ObstacleFrame> read_obstacle_frames(const std::string& path);

}  // namespace ricochet
