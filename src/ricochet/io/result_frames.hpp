#pragma once

#include <string>
#include <vector>

/// @file What the files of fields hold, whatever their format: frames, and the surfaces of the obstacles.
namespace ricochet {

struct ResultField {
  std::string name;
  bool on_nodes = true;  ///< else on cells
  int components = 1;
};

/// The frames that are complete, also of a run that goes on.
struct ResultFrames {
  std::vector<double> times;
  std::vector<ResultField> fields;  ///< of the first frame
};

/// The surfaces of all obstacles at one time: lines in the plane, quadrilaterals in space.
struct ObstacleFrame {
  double time = 0.0;
  int corners = 2;                ///< of a cell
  std::vector<int> cells;         ///< cells × corners
  std::vector<double> positions;  ///< points × 3
  std::vector<int> obstacle;      ///< of each cell, from 0
};

}  // namespace ricochet
