#include "ricochet/io/results_size.hpp"

#include "ricochet/io/mesh_datasets.hpp"

namespace ricochet {

ResultsSize results_size(const Body& body, const SemidiscreteProblem& problem, const ResultsOptions& options,
                         Index nodes, Index cells) {
  // Headers of a data set and of the group of a frame in HDF5's format of version 1.8.
  constexpr double header = 600.0, group = 1500.0;
  ResultsSize size{group, group};
  const double real = options.file.single ? sizeof(float) : sizeof(double);
  for (const auto& source : make_field_sources({body, problem, expand_field_names(options.fields)})) {
    for (const Field& field : source->fields()) {
      const auto rows = static_cast<double>(field.location == FieldLocation::nodes ? nodes : cells);
      size.frame += header + rows * field.components * (field.is_integer ? sizeof(int) : real);
    }
  }
  double own = 0.0;
  for (const FixedDataset& set : mesh_datasets(*body.space, problem.contact))
    own += sizeof(double) * static_cast<double>(set.reals.size() + set.integers.size());
  size.mesh += own * static_cast<double>(nodes) / static_cast<double>(body.space->node_count());
  return size;
}

}  // namespace ricochet
