#pragma once

#include <memory>

#include "ricochet/distributed/communicator.hpp"
#include "ricochet/distributed/partition.hpp"
#include "ricochet/model/model.hpp"

/// @file The part of a case's model that one rank has.
namespace ricochet {

struct DivisionOptions {
  PartitionMethod method = PartitionMethod::graph;
  std::uint64_t seed = 0;  ///< for random partitions
};

/// Builds the model like build_model, with the same errors and remarks; each rank gets its part, with the numbering of
/// the whole where needed. Collective over all ranks. Cases that cannot be divided are refused with the reason, at the
/// location in the case.
[[nodiscard]] std::unique_ptr<Model> build_divided_model(const Case& input, const Communicator& ranks,
                                                         const DivisionOptions& options = {},
                                                         BuildTimes* times = nullptr);

}  // namespace ricochet
