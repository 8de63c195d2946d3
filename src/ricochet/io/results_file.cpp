#include "ricochet/io/results_file.hpp"

#include <optional>

#include "ricochet/base/ranks.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/file_lock.hpp"
#include "ricochet/io/frame_output.hpp"
#include "ricochet/io/mesh_datasets.hpp"
#include "ricochet/io/results_format.hpp"

namespace ricochet {

namespace {

/// Readers usually hold the lock for a moment; one that does not release it does not stop the run.
constexpr double longest_wait_of_the_writer = 2.0;

/// Excludes readers while the files change.
class LockedFrames {
 public:
  explicit LockedFrames(FileLock& lock) : lock_(lock) {
    lock_.acquire(FileLock::Kind::exclusive, longest_wait_of_the_writer);
  }
  ~LockedFrames() { lock_.release(); }
  LockedFrames(const LockedFrames&) = delete;
  LockedFrames& operator=(const LockedFrames&) = delete;

 private:
  FileLock& lock_;
};

}  // namespace

/// Fields of a body that is divided among ranks, assembled on the first rank.
class GatheredFields {
 public:
  /// `own`: fields of this rank; at a shared node the values of its owner count. `node_rows`, `cell_rows`: rows of this
  /// rank in the whole.
  GatheredFields(const Ranks& ranks, std::vector<Field> own, const std::vector<Index>& node_rows,
                 const std::vector<Index>& cell_rows, Index nodes, Index cells);

  /// Fields of the whole body on the first rank; empty elsewhere.
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }
  /// Gathers the current values. All ranks call it together.
  void gather();

 private:
  struct Rows {
    std::vector<Index> own;               ///< that this rank contributes
    std::vector<std::vector<Index>> all;  ///< on the first rank: target rows of each rank
  };
  [[nodiscard]] Rows rows_of(const std::vector<Index>& own, const std::vector<Index>& global_rows) const;
  [[nodiscard]] const Rows& rows_of(const Field& field) const {
    return field.location == FieldLocation::nodes ? nodes_ : cells_;
  }

  const Ranks& ranks_;
  std::vector<Field> own_, fields_;
  Rows nodes_, cells_;
  std::vector<std::vector<double>> reals_;
  std::vector<std::vector<int>> integers_;
};

GatheredFields::GatheredFields(const Ranks& ranks, std::vector<Field> own, const std::vector<Index>& node_rows,
                               const std::vector<Index>& cell_rows, Index nodes, Index cells)
    : ranks_(ranks), own_(std::move(own)) {
  std::vector<Index> owned, every;
  for (Index node = 0; node < Index(node_rows.size()); ++node) {
    if (ranks.is_owned(node)) owned.push_back(node);
  }
  for (Index cell = 0; cell < Index(cell_rows.size()); ++cell) every.push_back(cell);
  nodes_ = rows_of(owned, node_rows);
  cells_ = rows_of(every, cell_rows);
  reals_.resize(own_.size());
  integers_.resize(own_.size());
  for (std::size_t i = 0; ranks.is_first() && i < own_.size(); ++i) {
    Field field = own_[i];
    field.rows = field.location == FieldLocation::nodes ? nodes : cells;
    const auto count = std::size_t(field.rows * field.components);
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
  for (const Index row : own) messages.front().push_back(global_rows[std::size_t(row)]);
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
        message.push_back(field.is_integer ? double(static_cast<const int*>(field.values)[k])
                                           : static_cast<const double*>(field.values)[k]);
    }
    const Ranks::ForEach<double> received = ranks_.exchange(std::move(messages));
    if (!ranks_.is_first()) continue;
    for (std::size_t rank = 0; rank < received.size(); ++rank) {
      const double* from = received[rank].data();
      for (const Index row : rows.all[rank]) {
        for (Index k = row * n; k < (row + 1) * n; ++k, ++from) {
          if (field.is_integer) {
            integers_[i][std::size_t(k)] = int(*from);
          } else {
            reals_[i][std::size_t(k)] = *from;
          }
        }
      }
    }
  }
}

struct ResultsWriter::Implementation {
  Implementation(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                 const ResultsOptions& options, const std::optional<SnapshotVisitor>& saved,
                 const GlobalBody& global_body);
  void open(const FrameOutputContext& context);

  const Ranks& ranks;
  std::vector<std::unique_ptr<FieldSource>> sources;
  std::unique_ptr<GatheredFields> gathered;  ///< on several ranks
  long frame_count = 0;
  std::vector<Field> fields;
  ResultsFormat format;
  std::string lock_path;
  std::optional<FileLock> lock;
  std::unique_ptr<FrameOutput> output;
};

ResultsWriter::Implementation::Implementation(const std::string& directory, const Body& body,
                                              const SemidiscreteProblem& problem, const ResultsOptions& options,
                                              const std::optional<SnapshotVisitor>& saved,
                                              const GlobalBody& global_body)
    : ranks(*problem.ranks),
      sources(make_field_sources({body, problem, expand_field_names(options.fields)})),
      format(results_format_registry().find(options.format).type),
      lock_path(directory + "/" + format.lock) {
  for (const auto& source : sources) {
    for (const Field& field : source->fields()) fields.push_back(field);
  }
  if (!ranks.are_several()) {
    open({directory, body, problem, fields, options.file, saved});
    return;
  }
  if (saved) (*saved)("frame_count", frame_count);
  gathered = std::make_unique<GatheredFields>(ranks, fields, global_body.node_rows, global_body.cell_rows,
                                              global_body.nodes, global_body.cells);
  ranks.run_collectively([&] {
    if (!ranks.is_first()) return;
    open({directory, *global_body.body, *global_body.problem, gathered->fields(), options.file, saved});
  });
}

void ResultsWriter::Implementation::open(const FrameOutputContext& context) {
  std::optional<LockedFrames> locked;
  if (context.saved) locked.emplace(lock.emplace(lock_path));
  output = format.write(context);
}

ResultsWriter::ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                             const ResultsOptions& options, const std::optional<SnapshotVisitor>& saved,
                             const GlobalBody& global_body)
    : implementation_(std::make_unique<Implementation>(directory, body, problem, options, saved, global_body)) {}

ResultsWriter::~ResultsWriter() = default;

void ResultsWriter::write(const State& state) {
  Implementation& own = *implementation_;
  for (const auto& source : own.sources) source->evaluate(state);
  if (own.gathered) own.gathered->gather();
  ++own.frame_count;
  own.ranks.run_collectively([&] {
    if (!own.output) return;
    if (!own.lock) own.lock.emplace(own.lock_path);  // the file exists by now
    const LockedFrames locked(*own.lock);
    own.output->write(state);
  });
}

long ResultsWriter::frames() const {
  return implementation_->output ? implementation_->output->frames() : implementation_->frame_count;
}

void ResultsWriter::save(const SnapshotVisitor& visit) {
  if (implementation_->gathered) visit("frame_count", implementation_->frame_count);
  if (implementation_->output) implementation_->output->save(visit);
}

void ResultsWriter::require_unchanged() const {
  if (implementation_->output) implementation_->output->require_unchanged();
}

void ResultsWriter::sync() const {
  if (!implementation_->output) return;
  for (const std::string& path : implementation_->output->paths()) sync_to_disk(path);
}

ResultsSize results_size(const Body& body, const SemidiscreteProblem& problem, const ResultsOptions& options,
                         Index nodes, Index cells) {
  // Headers of a data set and of the group of a frame in HDF5's format of version 1.8.
  constexpr double header = 600.0, group = 1500.0;
  ResultsSize size{group, group};
  const double real = options.file.single ? sizeof(float) : sizeof(double);
  for (const auto& source : make_field_sources({body, problem, expand_field_names(options.fields)})) {
    for (const Field& field : source->fields()) {
      const auto rows = double(field.location == FieldLocation::nodes ? nodes : cells);
      size.frame += header + rows * field.components * (field.is_integer ? sizeof(int) : real);
    }
  }
  double own = 0.0;
  for (const FixedDataset& set : mesh_datasets(*body.space, problem.contact))
    own += sizeof(double) * double(set.reals.size() + set.integers.size());
  size.mesh += own * double(nodes) / double(body.space->node_count());
  return size;
}

}  // namespace ricochet
