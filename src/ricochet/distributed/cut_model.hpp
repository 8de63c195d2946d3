#pragma once

#include <memory>

#include "ricochet/distributed/communicator.hpp"
#include "ricochet/distributed/partition.hpp"
#include "ricochet/model/model.hpp"

/// @file The part of a case's model that one rank has.
namespace ricochet {

struct DivisionOptions {
  PartitionMethod method = PartitionMethod::graph;
  std::uint64_t seed = 0;  ///< of random ones
};

/// As build_model, with the same errors and remarks; each rank gets its part, with the numbers of the whole where
/// somebody asks for these. All ranks call it together. What cannot be divided is refused by name, at its place in the
/// case.
[[nodiscard]] std::unique_ptr<Model> build_divided_model(const Case& input, const Communicator& ranks,
                                                         const DivisionOptions& options = {},
                                                         BuildTimes* times = nullptr);

}  // namespace ricochet
