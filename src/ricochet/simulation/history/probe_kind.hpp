#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/simulation/history/sensor.hpp"

/// @file Kinds of [[probe]] of a case file. To add one: a file with its sensor and its registration, and one line in
/// probe_kind.cpp.
namespace ricochet {

/// Parts of the mesh that a probe watches. They are found in the whole body and cut for each rank.
struct ProbeTargets {
  std::vector<Probe> probes;      ///< single nodes, of points and segments
  std::vector<Vector> positions;  ///< per probe, d coordinates
  std::vector<Columns> columns;   ///< per probe, the columns of its sensor
  std::vector<Index> nodes;       ///< nodes that are watched together, of boundaries
  std::string summed_forces;      ///< the forces that its columns sum, in words; empty if none
};

/// A [[probe]] of a case, and the model that it belongs to.
struct ProbeContext {
  const std::string& name;
  const Parameters& values;  ///< of the keys of its kind
  const Body& body;
  const SemidiscreteProblem& problem;
  const BodiesOfMesh& bodies;
  const std::vector<ContactPair>& pairs;
  std::vector<std::size_t> entry_of_pair;  ///< the [[contact]] of each pair
  std::vector<bool> entry_is_tied;         ///< per [[contact]]
  /// Throws Error(invalid_input) with the location of a key.
  std::function<void(const std::string& key, const std::string& message)> refuse;
  /// Returns the group of cells or facets that a key names; refuses it if it does not exist or is empty.
  std::function<const Group&(const std::string& key, int dimension)> group;
  /// Returns the facets of a group of boundary facets, without those on an axis; refuses groups inside the body.
  std::function<std::vector<Index>(const std::string& key)> boundary;

  /// Returns the value of a key; zeros if it has none.
  [[nodiscard]] Vector vector(const std::string& key) const {
    if (!values.has(key)) return Vector::Zero(problem.dimension);
    const std::vector<double>& value = values.vector(key);
    return Eigen::Map<const Vector>(value.data(), Index(value.size()));
  }
};

using SensorList = std::vector<std::shared_ptr<Sensor>>;

struct ProbeKind {
  std::vector<RowQuantity> quantities;  ///< for documentation; empty if another kind has the same
  bool of_boundary = false;             ///< its groups are of facets only
  /// Finds its targets in the whole mesh, and reports them; null if there are none to find.
  std::function<void(const ProbeContext& setting, ProbeTargets& targets)> find;
  /// Makes its sensors; on several ranks, each passes its own targets. Throws as the functions of ProbeContext do.
  std::function<SensorList(const ProbeContext& setting, const ProbeTargets& targets)> make;
};

/// Keys of a probe may be groups.
template <>
inline constexpr bool reads_groups<ProbeKind> = true;

/// Registry of all kinds; `alternatives` of each has one entry, the keys that every probe of this kind has and no
/// other. A program may add its own.
[[nodiscard]] Registry<ProbeKind>& probe_registry();

/// Returns the kind whose keys a probe has; null if none.
[[nodiscard]] const Registration<ProbeKind>* find_probe_kind(const std::function<bool(const std::string&)>& has_key);

/// Names that probes must not have: those of columns, or parts of them before a dot.
[[nodiscard]] std::vector<std::string> reserved_probe_names();

/// Returns the tables of all columns, as docs/results.md contains them.
[[nodiscard]] std::string column_reference();

}  // namespace ricochet
