#include "ricochet/run/run_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/library_versions.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

bool decides_results(const std::string& key) {
  // The contents of files decide, not their names.
  static const std::set<std::string> others{"title", "mesh.file", "output.checkpoint_every",
                                            "output.checkpoint_seconds"};
  const bool is_file = (key.starts_with("part.") && key.ends_with(".file")) ||
                       (key.starts_with("obstacle.") && (key.ends_with(".file") || key.ends_with(".table")));
  // Results written before the end do not depend on it.
  return !is_file && !others.contains(key) && key != "time.end" && !key.starts_with("expect.") &&
         !key.starts_with("check.");
}

/// Returns the checksums of obstacles that are read from files, by name.
std::map<std::string, std::string> obstacle_checksums(const Case& input, const Model& model) {
  std::map<std::string, std::string> result;
  for (std::size_t i = 0; i < model.obstacles.size(); ++i) {
    const std::string sum = model.obstacles[i]->checksum();
    if (!sum.empty()) result[input.obstacles[i].name] = sum;
  }
  return result;
}

/// Returns the checksum of products with a fixed vector, which detects any difference in the rounding of the operators.
std::string operator_checksum(const SemidiscreteProblem& problem) {
  Vector values(problem.dof_count()), product;
  for (Index i = 0; i < values.size(); ++i) values[i] = 1.0 / double(i + 1);
  Checksum sum;
  const auto add = [&sum](const Vector& v) { sum.add(v.data(), std::size_t(v.size())); };
  problem.mass.multiply(values, product);
  add(product);
  const InternalForce& elastic = *problem.internal_force;
  if (elastic.is_linear()) {
    elastic.evaluate(values, product);
  } else {
    product = elastic.tangent() * values;  // this displacement may invert cells
  }
  add(product);
  add(problem.loads.constant());
  problem.contact.rows->normal_motion(values, product);
  add(product);
  return sum.text();
}

/// Checksum of a part of a mesh. Parts of a mesh of several files have their own, so that a message can name the one
/// that changed.
struct MeshChecksum {
  std::string of;    ///< "nodes"; in a mesh of several files "nodes of part "ball""
  std::string part;  ///< name of the part; empty for the whole mesh
  std::string sum;
};

std::vector<MeshChecksum> of_whole(const Mesh& mesh) {
  Checksum cells, facets, groups;
  for (const CellBlock& block : mesh.cells) cells.add(block.nodes.data(), block.nodes.size());
  for (const CellBlock& block : mesh.facets) facets.add(block.nodes.data(), block.nodes.size());
  for (const Group& group : mesh.groups) {
    groups.add(group.name.data(), group.name.size()).add(&group.dimension, 1);
    groups.add(group.members.data(), group.members.size());
  }
  const Checksum nodes = Checksum().add(mesh.nodes.data(), std::size_t(mesh.nodes.size()));
  return {{"boundary facets", "", facets.text()},
          {"cells", "", cells.text()},
          {"groups", "", groups.text()},
          {"nodes", "", nodes.text()}};
}

/// Checksums of one part, with its own numbering, so that changes in other parts leave them unchanged.
class PartChecksums {
 public:
  PartChecksums(const Mesh& mesh, const MeshPart& part) : mesh_(mesh), part_(part) {
    for (Index facet = 0; facet < mesh.facet_count(); ++facet) {
      const IndexInBlocks at = locate_in_blocks(mesh.facets, facet);
      if (part.has_node(mesh.facets[at.block].cell(at.local)[0])) facets_.push_back(facet);
    }
  }

  void append_to(std::vector<MeshChecksum>& sums) const {
    const auto add = [&](const char* what, const Checksum& sum) {
      sums.push_back({fmt::format("{} of part \"{}\"", what, part_.name), part_.name, sum.text()});
    };
    add("boundary facets", of_nodes(mesh_.facets, facets_));
    add("cells", of_nodes(mesh_.cells, part_.cells));
    add("groups", of_groups());
    add("nodes", Checksum().add(mesh_.nodes.data() + part_.first_node * mesh_.nodes.rows(),
                                std::size_t(part_.node_count * mesh_.nodes.rows())));
  }

 private:
  [[nodiscard]] Checksum of_nodes(const std::vector<CellBlock>& blocks, const std::vector<Index>& members) const {
    Checksum sum;
    std::vector<Index> nodes;
    for (const Index member : members) {
      const IndexInBlocks at = locate_in_blocks(blocks, member);
      const CellBlock& block = blocks[at.block];
      nodes.assign(block.cell(at.local), block.cell(at.local) + block.nodes_per_cell);
      for (Index& node : nodes) node -= part_.first_node;
      sum.add(nodes.data(), nodes.size());
    }
    return sum;
  }

  [[nodiscard]] Checksum of_groups() const {
    Checksum sum;
    for (const Group& group : mesh_.groups) {
      if (!group.name.starts_with(part_.group_name(""))) continue;
      const std::vector<Index>& all = group.dimension == mesh_.dimension ? part_.cells : facets_;
      std::vector<Index> members;
      for (const Index member : group.members) members.push_back(std::ranges::lower_bound(all, member) - all.begin());
      sum.add(group.name.data(), group.name.size()).add(&group.dimension, 1);
      sum.add(members.data(), members.size());
    }
    return sum;
  }

  const Mesh& mesh_;
  const MeshPart& part_;
  std::vector<Index> facets_;
};

/// Returns the checksums of nodes, cells, boundary facets and groups, and of the order of the parts.
std::vector<MeshChecksum> mesh_checksums(const Mesh& mesh) {
  if (mesh.parts.empty()) return of_whole(mesh);
  std::vector<MeshChecksum> sums;
  Checksum order;
  for (const MeshPart& part : mesh.parts) {
    PartChecksums(mesh, part).append_to(sums);
    order.add(part.name.data(), part.name.size() + 1);  // including the terminating zero
  }
  sums.push_back({"the order of the parts", "", order.text()});
  return sums;
}

}  // namespace

std::map<std::string, std::string> deciding_values(const Case& input) {
  std::map<std::string, std::string> result;
  for (const auto& [key, value] : input.values) {
    if (decides_results(key)) result[key] = value;
  }
  return result;
}

namespace {

using Texts = std::map<std::string, std::string>;

/// Saves a map as two entries, its keys and its values.
void save_map(const Texts& map, Snapshot& snapshot, const std::string& keys, const std::string& values) {
  Snapshot::Texts names, texts;
  for (const auto& [name, text] : map) {
    names.push_back(name);
    texts.push_back(text);
  }
  snapshot.save(keys, std::move(names));
  snapshot.save(values, std::move(texts));
}

Texts read_map(const Snapshot& snapshot, const std::string& keys, const std::string& values) {
  Texts result;
  const Snapshot::Texts& names = snapshot.texts(keys);
  const Snapshot::Texts& texts = snapshot.texts(values);
  for (std::size_t i = 0; i < std::min(names.size(), texts.size()); ++i) result[names[i]] = texts[i];
  return result;
}

}  // namespace

void save_identity(const Case& input, const Model& model, Snapshot& snapshot) {
  snapshot.save("identity.version", std::string(version));
  save_map(deciding_values(input), snapshot, "identity.case.keys", "identity.case.values");
  Snapshot::Texts parts, sums;  // in the order of the mesh
  for (const MeshChecksum& checksum : mesh_checksums(model.mesh)) {
    parts.push_back(checksum.of);
    sums.push_back(checksum.sum);
  }
  snapshot.save("identity.mesh.parts", std::move(parts));
  snapshot.save("identity.mesh.sums", std::move(sums));
  save_map(obstacle_checksums(input, model), snapshot, "identity.obstacles", "identity.obstacles.sums");
  snapshot.save("identity.libraries", library_versions());
  snapshot.save("identity.operators", operator_checksum(model.problem));
}

void require_same_case(const Case& input, const std::string& version_before,
                       const std::map<std::string, std::string>& values_before, const std::string& before) {
  std::string differences;
  const std::map<std::string, std::string> now = deciding_values(input);
  std::set<std::string> keys;
  for (const auto& [key, value] : now) keys.insert(key);
  for (const auto& [key, value] : values_before) keys.insert(key);
  const auto text = [](const std::map<std::string, std::string>& values, const std::string& key) {
    const auto found = values.find(key);
    return found != values.end() ? found->second : "absent";
  };
  for (const std::string& key : keys) {
    const std::string was = text(values_before, key), is = text(now, key);
    if (decides_results(key) && was != is)
      differences += fmt::format("\n  {}: {} was {}, now it is {}", input.where(key).text(), key, was, is);
  }
  std::vector<std::string> reasons, advice;
  if (version_before != version) {
    reasons.push_back(fmt::format("it ran with Ricochet {}, this is {}", version_before, version));
    advice.emplace_back("Continue it with the version that began it");
  }
  if (!differences.empty()) {
    reasons.push_back("the case has changed since this run began:" + differences);
    advice.emplace_back(advice.empty() ? "Restore it (including --set)" : "restore the case (including --set)");
  }
  if (reasons.empty()) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{} cannot be resumed: {}\n{}, start anew in another directory (-o), or overwrite the run "
                          "(--force)",
                          before, fmt::join(reasons, "; "), fmt::join(advice, " and ")));
}

void require_same_case(const Case& input, const Snapshot& snapshot, const std::string& before) {
  require_same_case(input, snapshot.text("identity.version"),
                    read_map(snapshot, "identity.case.keys", "identity.case.values"), before);
}

std::string compare_model(const Case& input, const Model& model, const Snapshot& snapshot) {
  const Texts before = read_map(snapshot, "identity.mesh.parts", "identity.mesh.sums");
  std::string differences, file_key = input.parts.empty() ? "mesh.file" : "part";
  for (const MeshChecksum& checksum : mesh_checksums(model.mesh)) {
    const auto found = before.find(checksum.of);
    if (found != before.end() && found->second == checksum.sum) continue;
    if (differences.empty() && !checksum.part.empty()) file_key = "part." + checksum.part + ".file";
    differences += (differences.empty() ? "" : ", ") + checksum.of;
  }
  if (!differences.empty()) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: the run cannot be resumed: the mesh has changed since it began (differences in: {}); "
                            "restore the mesh, start anew in another directory (-o), or overwrite the run (--force)",
                            input.where(file_key).text(), differences));
  }
  const Texts obstacles = read_map(snapshot, "identity.obstacles", "identity.obstacles.sums");
  for (const auto& [name, sum] : obstacle_checksums(input, model)) {
    const auto found = obstacles.find(name);
    if (found != obstacles.end() && found->second == sum) continue;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: the run cannot be resumed: the file of obstacle \"{}\" has changed since it began; "
                            "restore it, start anew in another directory (-o), or overwrite the run (--force)",
                            input.where("obstacle." + name).text(), name));
  }
  const std::string libraries = library_versions();
  if (libraries != snapshot.text("identity.libraries")) {
    return fmt::format(
        "resumed with other libraries, another processor or another RICOCHET_INSTRUCTION_SET ({}; before: {}): results "
        "agree with those of an uninterrupted run only to rounding",
        libraries, snapshot.text("identity.libraries"));
  }
  if (operator_checksum(model.problem) != snapshot.text("identity.operators")) {
    return "resumed with matrices that differ from the earlier ones by rounding (another build of the program or its "
           "libraries): results agree with those of an uninterrupted run only to rounding";
  }
  return "";
}

}  // namespace ricochet
