#include "ricochet/report/body_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace ricochet {

namespace {

/// Largest number of values, over all frames, that are held in memory.
constexpr double most_numbers = 2.5e8;

/// Fields on nodes of the contact boundary; they have no meaning elsewhere.
constexpr std::array contact_names{"contact_pressure", "friction_traction",        "gap",
                                   "contact_status",   "nominal_contact_pressure", "nominal_friction_traction"};

bool is_contact(const std::string& name) { return std::ranges::find(contact_names, name) != contact_names.end(); }

/// Excludes tensors, which a page does not show, and contact fields, which have a part of their own.
bool is_shown(const ResultField& field) {
  return field.name != "displacement" && field.components <= 3 && !is_contact(field.name);
}

/// Below the first number an inside is not recognizable; above the second a browser does not cut it at once.
constexpr Index least_tetrahedra = 1000, most_tetrahedra = 100'000;

/// Returns value i of a scalar field, or the length of vector i.
float magnitude(const std::vector<float>& values, int components, Index i) {
  if (components == 1) return values[std::size_t(i)];
  const float* v = values.data() + 3 * i;
  return std::hypot(v[0], v[1], v[2]);
}

}  // namespace

BodyFrames::Part::Part(std::vector<Index> its_nodes, const std::vector<int>& cells_of_pieces)
    : nodes(std::move(its_nodes)) {
  std::map<int, int> numbers_of_cells;
  for (const int cell : cells_of_pieces) {
    const auto [entry, is_new] = numbers_of_cells.try_emplace(cell, int(cells.size()));
    if (is_new) cells.push_back(cell);
    numbers.push_back(entry->second);
  }
}

BodyFrames::BodyFrames(const ResultsReader& results, Index most_triangles, std::size_t volume_bytes)
    : results_(results),
      dimension_(dimension(results.cells().front().shape)),
      surface_(make_surface(results.nodes(), results.cells(), most_triangles)),
      line_(make_contact_line(results.nodes(), results.contact_facets())),
      outside_(surface_.nodes, surface_.cells) {
  if (dimension_ == 3) make_inside(volume_bytes);
  choose();
  read_frames();
}

/// Estimates the size: a number takes somewhat more than a byte in the page, and five tetrahedra share a node.
void BodyFrames::make_inside(std::size_t bytes) {
  double on_nodes = 3.0, on_cells = 0.0;
  for (const ResultField& field : results_.fields()) {
    if (is_shown(field)) (field.on_nodes ? on_nodes : on_cells) += 1.0;
  }
  const double of_each = 4.0 + 1.25 * double(frame_count()) * (on_nodes / 5.0 + on_cells);
  const auto room = Index(double(bytes) / of_each);
  if (room < least_tetrahedra) return;
  volume_ = make_volume(results_.nodes(), results_.cells(), std::min(room, most_tetrahedra));
  inside_ = Part(volume_.nodes, volume_.cells);
}

void BodyFrames::choose() {
  for (const ResultField& field : results_.fields()) {
    if (is_contact(field.name) && !line_.nodes.empty())
      contact_.push_back({field.name, true, Index(line_.nodes.size()), {}});
    if (field.components > 3) left_out_.push_back(field.name);
  }
  double numbers = 0.0;
  for (const Values& values : contact_) numbers += double(values.columns);
  for (Part* part : {&outside_, &inside_}) {
    for (int k = 0; k < dimension_ && results_.find_field("displacement") != nullptr; ++k)
      part->deviations.push_back({"xyz"[k] + std::string(), true, Index(part->nodes.size()), {}});
    for (const ResultField& field : results_.fields()) {
      const std::size_t columns = field.on_nodes ? part->nodes.size() : part->cells.size();
      if (is_shown(field)) part->fields.push_back({field.name, field.on_nodes, Index(columns), {}});
    }
    for (const auto* list : {&part->deviations, &part->fields}) {
      for (const Values& values : *list) numbers += double(values.columns);
    }
  }
  const auto stride = std::max<Index>(Index(std::ceil(numbers * double(frame_count()) / most_numbers)), 1);
  for (Index frame = 0; frame < frame_count(); ++frame) {
    if (frame % stride == 0 || frame + 1 == frame_count()) frames_.push_back(int(frame));
  }
}

void BodyFrames::read_frames() {
  std::vector<float> values;
  if (outside_.deviations.empty()) mean_.assign(3 * frames_.size(), 0.0);
  for (const int frame : frames_) {
    for (const ResultField& field : results_.fields()) {
      if (field.components > 3 || (is_contact(field.name) && line_.nodes.empty())) continue;
      results_.read(frame, field, values);
      if (field.name == "displacement") {
        store_displacement(values);
      } else if (is_contact(field.name)) {
        store_contact(field, values);
      } else {
        store_field(field, values);
      }
    }
  }
}

void BodyFrames::store_displacement(const std::vector<float>& field) {
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < field.size(); ++i) mean[i % 3] += double(field[i]);
  for (double& component : mean) component /= double(field.size() / 3);
  mean_.insert(mean_.end(), mean.begin(), mean.end());
  for (Part* part : {&outside_, &inside_}) {
    for (std::size_t k = 0; k < part->deviations.size(); ++k) {
      for (const Index node : part->nodes) {
        part->deviations[k].values.push_back(float(double(field[3 * std::size_t(node) + k]) - mean[k]));
      }
    }
  }
}

void BodyFrames::store_contact(const ResultField& field, const std::vector<float>& values) {
  Values& own = *std::ranges::find_if(contact_, [&](const Values& v) { return v.name == field.name; });
  for (const Index node : line_.nodes) own.values.push_back(magnitude(values, field.components, node));
}

void BodyFrames::store_field(const ResultField& field, const std::vector<float>& values) {
  for (Part* part : {&outside_, &inside_}) {
    Values& own = *std::ranges::find_if(part->fields, [&](const Values& v) { return v.name == field.name; });
    if (field.on_nodes) {
      for (const Index node : part->nodes) own.values.push_back(magnitude(values, field.components, node));
    } else {
      for (const int cell : part->cells) own.values.push_back(magnitude(values, field.components, cell));
    }
  }
}

std::vector<std::size_t> BodyFrames::selected_rows(std::size_t stride) const {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (i % stride == 0 || i + 1 == frames_.size()) rows.push_back(i);
  }
  return rows;
}

std::vector<int> BodyFrames::frames_of(const std::vector<std::size_t>& rows) const {
  std::vector<int> result;
  for (const std::size_t row : rows) result.push_back(frames_[row]);
  return result;
}

PackedArray BodyFrames::pack(const Values& values, const std::vector<std::size_t>& rows, int bits,
                             PackedArrays& arrays) {
  std::vector<float> chosen;
  chosen.reserve(rows.size() * std::size_t(values.columns));
  for (const std::size_t row : rows) {
    const auto begin = values.values.begin() + std::ptrdiff_t(row) * values.columns;
    chosen.insert(chosen.end(), begin, begin + values.columns);
  }
  const auto count = Index(rows.size());
  if (values.name == "contact_status") return arrays.add_small_numbers(chosen, count, values.columns);
  return arrays.add_levels(chosen, count, values.columns, bits);
}

void BodyFrames::pack_frames(const Quality& quality, const std::vector<std::size_t>& rows, PackedArrays& arrays,
                             BodyPart& part) const {
  part.frames = frames_of(rows);
  part.displacement_bits = quality.displacement_bits;
  part.field_bits = quality.field_bits;
  std::vector<double> means;
  for (const std::size_t row : rows)
    means.insert(means.end(), {mean_[3 * row], mean_[3 * row + 1], mean_[3 * row + 2]});
  part.mean = arrays.add_reals(means, Index(rows.size()), 3);
  for (const Values& values : outside_.deviations)
    part.deviations.push_back(pack(values, rows, quality.displacement_bits, arrays));
  for (const Values& values : outside_.fields)
    part.fields.push_back({values.name, values.on_nodes, pack(values, rows, quality.field_bits, arrays)});
}

std::optional<VolumePart> BodyFrames::pack_volume(const std::vector<std::size_t>& rows, std::size_t most_bytes,
                                                  PackedArrays& arrays) const {
  if (volume_.count() == 0) return std::nullopt;
  for (const auto& [displacement_bits, field_bits] : {std::pair(14, 12), std::pair(11, 8), std::pair(10, 6)}) {
    PackedArrays attempt = arrays;
    VolumePart part;
    part.is_thinned = volume_.is_thinned;
    part.nodes = Index(volume_.nodes.size());
    part.tetrahedra = volume_.count();
    part.positions = pack_positions(volume_.nodes, attempt);
    part.corners = attempt.add_indices(volume_.corners);
    part.cells = attempt.add_indices(inside_.numbers);
    part.faces =
        attempt.add_small_numbers(std::vector<float>(volume_.sides.begin(), volume_.sides.end()), 1, part.tetrahedra);
    for (const Values& values : inside_.deviations)
      part.deviations.push_back(pack(values, rows, displacement_bits, attempt));
    for (const Values& values : inside_.fields)
      part.fields.push_back({values.name, values.on_nodes, pack(values, rows, field_bits, attempt)});
    if (attempt.page_bytes() - arrays.page_bytes() > most_bytes) continue;
    arrays = std::move(attempt);
    return part;
  }
  return std::nullopt;
}

PackedArray BodyFrames::pack_positions(const std::vector<Index>& nodes, PackedArrays& arrays) const {
  std::vector<float> positions;
  for (Index k = 0; k < dimension_; ++k) {
    for (const Index node : nodes) positions.push_back(float(results_.nodes()(k, node)));
  }
  return arrays.add_levels(positions, dimension_, Index(nodes.size()), 16);
}

ContactPart BodyFrames::pack_contact(std::size_t most_bytes, PackedArrays& arrays) const {
  ContactPart part;
  part.line = line_;
  if (line_.nodes.empty()) return part;
  if (!line_.position.empty()) part.position = arrays.add_reals(line_.position, 1, Index(line_.position.size()));
  std::map<Index, int> numbers;
  for (std::size_t i = 0; i < surface_.nodes.size(); ++i) numbers.emplace(surface_.nodes[i], int(i));
  std::vector<int> nodes;
  for (const Index node : line_.nodes) nodes.push_back(numbers.contains(node) ? numbers.at(node) : -1);
  part.nodes = arrays.add_indices(nodes);
  constexpr std::array<std::pair<int, std::size_t>, 7> qualities{
      {{16, 1}, {12, 1}, {10, 1}, {10, 2}, {8, 4}, {8, 10}, {8, 30}}};
  for (const auto& [bits, stride] : qualities) {
    const std::vector<std::size_t> rows = selected_rows(stride);
    PackedArrays attempt = arrays;
    std::vector<ContactQuantity> quantities;
    for (const Values& values : contact_) quantities.push_back({values.name, pack(values, rows, bits, attempt)});
    if (attempt.page_bytes() - arrays.page_bytes() > most_bytes && stride < qualities.back().second) continue;
    arrays = std::move(attempt);
    part.frames = frames_of(rows);
    part.quantities = std::move(quantities);
    break;
  }
  return part;
}

BodyPart BodyFrames::pack_body(std::size_t most_bytes, PackedArrays& arrays) const {
  BodyPart part;
  part.left_out = left_out_;
  part.is_thinned = surface_.is_thinned;
  part.nodes = Index(surface_.nodes.size());
  part.triangles = surface_.count();
  const std::size_t before = arrays.page_bytes();
  part.positions = pack_positions(surface_.nodes, arrays);
  part.corners = arrays.add_indices(surface_.corners);
  part.triangle_cells = arrays.add_indices(outside_.numbers);
  part.edges =
      arrays.add_small_numbers(std::vector<float>(surface_.sides.begin(), surface_.sides.end()), 1, part.triangles);
  const std::size_t fixed = arrays.page_bytes() - before;
  // Two fifths are reserved for the inside of a solid.
  const std::size_t share = volume_.count() > 0 ? most_bytes / 5 * 3 : most_bytes;
  const std::size_t left = share > fixed ? share - fixed : 0;

  constexpr std::array<Quality, 13> qualities{{{16, 12, 1},
                                               {14, 10, 1},
                                               {12, 8, 1},
                                               {11, 7, 1},
                                               {11, 6, 1},
                                               {12, 8, 2},
                                               {11, 7, 2},
                                               {11, 7, 3},
                                               {10, 6, 5},
                                               {10, 6, 8},
                                               {10, 6, 15},
                                               {10, 6, 30},
                                               {10, 6, 100}}};
  for (const Quality& quality : qualities) {
    const std::vector<std::size_t> rows = selected_rows(quality.stride);
    const bool is_last = quality.stride == qualities.back().stride;
    // A few frames from the middle show approximately how much all will take.
    if (!is_last && rows.size() > 24) {
      PackedArrays sample;
      BodyPart ignored;
      const auto middle = rows.begin() + std::ptrdiff_t(rows.size() / 2);
      pack_frames(quality, {middle, middle + 6}, sample, ignored);
      if (sample.page_bytes() * rows.size() / 6 > left + left / 4) continue;
    }
    PackedArrays attempt = arrays;
    BodyPart result = part;
    pack_frames(quality, rows, attempt, result);
    if (attempt.page_bytes() - arrays.page_bytes() > left && !is_last) continue;
    arrays = std::move(attempt);
    result.is_coarse = quality.displacement_bits < qualities.front().displacement_bits;
    const std::size_t used = arrays.page_bytes() - before;
    result.volume = pack_volume(rows, most_bytes > used ? most_bytes - used : 0, arrays);
    return result;
  }
  return part;
}

}  // namespace ricochet
