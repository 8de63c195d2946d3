#include "ricochet/contact/contact_cut.hpp"

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/selection.hpp"
#include "ricochet/contact/contact_members.hpp"

namespace ricochet {

namespace {

/// Visits the members of a boundary and restricts each to a part.
class ContactCutter {
 public:
  ContactCutter(const ContactCut& part, Index dimension) : part_(part), d_(dimension), nodes_(std::size_t(part.nodes)) {
    for (const Index point : part.points) {
      for (Index k = 0; k < d_ - 1; ++k) tangents_.push_back(point * (d_ - 1) + k);
    }
    for (std::size_t node = 0; node < part.node_number.size(); ++node) {
      if (const Index own = part.node_number[node]; own >= 0) nodes_[std::size_t(own)] = Index(node);
    }
  }

  template <class... Members>
  void operator()(ContactAxes axes, Members&... members) {
    (cut(axes, members), ...);
  }

 private:
  /// Items of the part, by their numbers in the whole.
  [[nodiscard]] const std::vector<Index>& items(ContactAxis axis) const {
    return axis == ContactAxis::point     ? part_.points
           : axis == ContactAxis::tangent ? tangents_
           : axis == ContactAxis::entry   ? part_.entries
                                          : nodes_;
  }
  /// Number of an item of the whole in the part, or −1.
  [[nodiscard]] Index number(ContactAxis axis, Index item) const {
    const auto at = std::size_t(item);
    if (axis == ContactAxis::node) return part_.node_number[at];
    if (axis == ContactAxis::facet) return part_.facet_number.empty() ? -1 : part_.facet_number[at];
    if (axis != ContactAxis::dof) return index_in(items(axis), item);
    const Index node = number(ContactAxis::node, item / d_);
    return node < 0 ? -1 : node * d_ + item % d_;
  }

  template <class Value>
  void cut(ContactAxes axes, Value& values) {
    if constexpr (requires { values.size(); }) {
      if (axes.along != ContactAxis::none && values.size() > 0) values = chosen(values, items(axes.along));
    }
  }
  void cut(ContactAxes axes, Points& columns) { columns = chosen_columns(columns, items(axes.along)); }
  void cut(ContactAxes axes, std::vector<Index>& numbers) {
    if (axes.along != ContactAxis::none) numbers = chosen(numbers, items(axes.along));
    if (axes.of == ContactAxis::none) return;
    // A contact point may be on another rank, and no other item (ContactBoundary::own_point).
    const Index absent = axes.of == ContactAxis::point ? -2 : -1;
    for (Index& each : numbers) {
      if (each < 0) continue;
      const Index own = number(axes.of, each);
      each = own >= 0 ? own : absent;
    }
    if (axes.along != ContactAxis::none) return;
    std::erase(numbers, absent);
    std::ranges::sort(numbers);
  }
  /// Columns without a number in the part are omitted.
  void cut(ContactAxes axes, SparseRowMatrix& matrix) {
    if (axes.along == ContactAxis::none) return;
    const std::vector<Index>& rows = items(axes.along);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (SparseRowMatrix::InnerIterator entry(matrix, rows[i]); entry; ++entry) {
        const Index column = number(axes.of, entry.col());
        if (column >= 0) entries.emplace_back(int(i), int(column), entry.value());
      }
    }
    const Index columns = axes.of == ContactAxis::dof ? part_.nodes * d_ : Index(items(axes.of).size());
    matrix = SparseRowMatrix(Index(rows.size()), columns);
    matrix.setFromTriplets(entries.begin(), entries.end());
  }
  void cut(ContactAxes axes, std::shared_ptr<const SparseRowMatrix>& matrix) {
    if (matrix == nullptr) return;
    SparseRowMatrix own = *matrix;
    cut(axes, own);
    matrix = std::make_shared<const SparseRowMatrix>(std::move(own));
  }
  void cut(ContactAxes, std::shared_ptr<const ContactRows>& rows) {
    ContactRows own = *rows;
    persist(*this, own);
    rows = std::make_shared<const ContactRows>(std::move(own));
  }
  void cut(ContactAxes, std::vector<CurvedContactData::Point>& points) {
    for (CurvedContactData::Point& point : points) point.number = number(ContactAxis::point, point.number);
    std::erase_if(points, [](const CurvedContactData::Point& point) { return point.number < 0; });
  }
  void cut(ContactAxes, std::vector<CurvedContactData::Node>& nodes) {
    for (CurvedContactData::Node& node : nodes) {
      node.entry = number(ContactAxis::entry, node.entry);
      node.node = number(ContactAxis::node, node.node);
    }
    std::erase_if(nodes, [](const CurvedContactData::Node& node) { return node.entry < 0; });
  }

  const ContactCut& part_;
  Index d_;
  std::vector<Index> tangents_, nodes_;
};

}  // namespace

ContactBoundary cut_contact(const ContactBoundary& whole, const ContactCut& part) {
  if (whole.net.size() > 0 && whole.net.minCoeff() == 0.0)
    throw Error(ErrorKind::invalid_input, "contact between bodies cannot be divided");
  ContactCutter cutter(part, whole.dimension);
  ContactBoundary own = whole;
  own.surface = nullptr;
  own.has_friction_elsewhere = whole.has_friction();
  persist(cutter, own);
  if (!whole.follows_motion()) return own;
  const CurvedContactData* const curved = whole.geometry->curved();
  const auto is_free_body = [](const Obstacle* obstacle) { return obstacle->free_motion() != nullptr; };
  if (curved == nullptr || std::ranges::any_of(curved->obstacles, is_free_body))
    throw Error(ErrorKind::invalid_input, "contact whose directions rotate with bodies cannot be divided");
  CurvedContactData data = *curved;
  persist(cutter, data);
  own.geometry = make_curved_contact(std::move(data));
  return own;
}

}  // namespace ricochet
