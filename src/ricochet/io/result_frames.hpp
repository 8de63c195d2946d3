#pragma once

#include <string>
#include <vector>

/// @file Content of the files of fields in every format: frames, and the surfaces of the obstacles.
namespace ricochet {

struct ResultField {
  std::string name;
  bool on_nodes = true;  ///< otherwise on cells
  int components = 1;
};

/// Complete frames, also of a run in progress.
struct ResultFrames {
  std::vector<double> times;
  std::vector<ResultField> fields;  ///< of the first frame
};

/// Surfaces of all obstacles at one time: lines in the plane, quadrilaterals in space.
struct ObstacleFrame {
  double time = 0.0;
  int corners = 2;                ///< per cell
  std::vector<int> cells;         ///< cells × corners
  std::vector<double> positions;  ///< points × 3
  std::vector<int> obstacle;      ///< per cell, from 0
};

}  // namespace ricochet
