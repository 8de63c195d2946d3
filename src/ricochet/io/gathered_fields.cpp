#include "ricochet/io/gathered_fields.hpp"

namespace ricochet {

GatheredFields::GatheredFields(const Ranks& ranks, std::vector<Field> own, const std::vector<Index>& node_rows,
                               const std::vector<Index>& cell_rows, Index nodes, Index cells)
    : ranks_(ranks), own_(std::move(own)) {
  std::vector<Index> owned, every;
  for (Index node = 0; node < static_cast<Index>(node_rows.size()); ++node) {
    if (ranks.is_owned(node)) owned.push_back(node);
  }
  for (Index cell = 0; cell < static_cast<Index>(cell_rows.size()); ++cell) every.push_back(cell);
  nodes_ = rows_of(owned, node_rows);
  cells_ = rows_of(every, cell_rows);
  reals_.resize(own_.size());
  integers_.resize(own_.size());
  for (std::size_t i = 0; ranks.is_first() && i < own_.size(); ++i) {
    Field field = own_[i];
    field.rows = field.location == FieldLocation::nodes ? nodes : cells;
    const auto count = static_cast<std::size_t>(field.rows * field.components);
    if (field.is_integer) {
      integers_[i].assign(count, 0);
      field.values = integers_[i].data();
    } else {
      reals_[i].assign(count, 0.0);
      field.values = reals_[i].data();
    }
    fields_.push_back(std::move(field));
  }
}

GatheredFields::Rows GatheredFields::rows_of(const std::vector<Index>& own,
                                             const std::vector<Index>& global_rows) const {
  Rows rows{own, {}};
  Ranks::ForEach<std::int64_t> messages(static_cast<std::size_t>(ranks_.size()));
  for (const Index row : own) messages.front().push_back(global_rows[static_cast<std::size_t>(row)]);
  for (std::vector<std::int64_t>& from : ranks_.exchange(std::move(messages)))
    rows.all.emplace_back(from.begin(), from.end());
  return rows;
}

void GatheredFields::gather() {
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const Field& field = own_[i];
    const Rows& rows = rows_of(field);
    const Index n = field.components;
    Ranks::ForEach<double> messages(static_cast<std::size_t>(ranks_.size()));
    std::vector<double>& message = messages.front();
    for (const Index row : rows.own) {
      for (Index k = row * n; k < (row + 1) * n; ++k)
        message.push_back(field.is_integer ? static_cast<double>(static_cast<const int*>(field.values)[k])
                                           : static_cast<const double*>(field.values)[k]);
    }
    const Ranks::ForEach<double> received = ranks_.exchange(std::move(messages));
    if (!ranks_.is_first()) continue;
    for (std::size_t rank = 0; rank < received.size(); ++rank) {
      const double* from = received[rank].data();
      for (const Index row : rows.all[rank]) {
        for (Index k = row * n; k < (row + 1) * n; ++k, ++from) {
          if (field.is_integer) {
            integers_[i][static_cast<std::size_t>(k)] = static_cast<int>(*from);
          } else {
            reals_[i][static_cast<std::size_t>(k)] = *from;
          }
        }
      }
    }
  }
}

}  // namespace ricochet
