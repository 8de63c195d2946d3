#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "ricochet/model/model.hpp"

/// @file Serialization of parts of a model that the first rank sends to the others.
namespace ricochet {

/// The part of a model that one rank has, before forces are assembled, and the numbers of its nodes in the whole body.
struct ModelPart {
  std::unique_ptr<Model> model;
  std::vector<std::int64_t> node_number;
  std::int64_t all_nodes = 0;
  std::vector<const Obstacle*> obstacles;  ///< of the whole, in the order of the case
};

/// Packs the data of a part that do not follow from the case, some bytes at a time. The part is unchanged.
void pack(const Case& input, ModelPart& part, const std::function<void(std::span<const char>)>& send);
/// Unpacks a part, and adds the data that follow from the case: obstacles, materials and their laws, contact pairs.
[[nodiscard]] ModelPart unpack(const Case& input, std::vector<char> bytes);

}  // namespace ricochet
