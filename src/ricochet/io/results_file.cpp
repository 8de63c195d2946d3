#include "ricochet/io/results_file.hpp"

#include <optional>

#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/file_lock.hpp"
#include "ricochet/io/frame_output.hpp"
#include "ricochet/io/gathered_fields.hpp"
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

struct ResultsWriter::Implementation {
  Implementation(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                 const ResultsOptions& options, const SnapshotVisitor* saved, const GlobalBody& global_body);
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
                                              const SnapshotVisitor* saved, const GlobalBody& global_body)
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
  if (saved != nullptr) (*saved)("frame_count", frame_count);
  gathered = std::make_unique<GatheredFields>(ranks, fields, global_body.node_rows, global_body.cell_rows,
                                              global_body.nodes, global_body.cells);
  ranks.run_collectively([&] {
    if (!ranks.is_first()) return;
    open({directory, *global_body.body, *global_body.problem, gathered->fields(), options.file, saved});
  });
}

void ResultsWriter::Implementation::open(const FrameOutputContext& context) {
  if (context.saved == nullptr) {
    output = format.write(context);
    return;
  }
  lock.emplace(lock_path);
  const LockedFrames locked(*lock);
  output = format.write(context);
}

ResultsWriter::ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                             const ResultsOptions& options, const GlobalBody& global_body)
    : implementation_(std::make_unique<Implementation>(directory, body, problem, options, nullptr, global_body)) {}

ResultsWriter::ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                             const ResultsOptions& options, const SnapshotVisitor& saved, const GlobalBody& global_body)
    : implementation_(std::make_unique<Implementation>(directory, body, problem, options, &saved, global_body)) {}

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

}  // namespace ricochet
