#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "ricochet/model/model.hpp"

/// @file Parts of a model on their way from the process that has cut them to those that have them.
namespace ricochet {

/// The part of a model that one rank has, still without forces, and where its nodes are in the whole body.
struct ModelPart {
  std::unique_ptr<Model> model;
  std::vector<std::int64_t> node_number;
  std::int64_t all_nodes = 0;
  std::vector<const Obstacle*> obstacles;  ///< of the whole, in the order of the case
};

/// What the case does not tell of a part, which stays as it is, some bytes at a time.
void pack(const Case& input, ModelPart& part, const std::function<void(std::span<const char>)>& send);
/// With what the case tells: obstacles, materials and their laws, contact pairs.
[[nodiscard]] ModelPart unpack(const Case& input, std::vector<char> bytes);

}  // namespace ricochet
