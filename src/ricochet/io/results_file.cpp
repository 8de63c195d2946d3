#include "ricochet/io/results_file.hpp"

#include <optional>

#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/file_lock.hpp"
#include "ricochet/io/frame_output.hpp"
#include "ricochet/io/results_format.hpp"

namespace ricochet {

namespace {

/// Who looks at the frames does that for a moment; who does not let go does not stop the run.
constexpr double longest_wait_of_the_writer = 2.0;

/// Nobody opens the files while they change.
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
                 const ResultsOptions& options, const Snapshot* snapshot, const std::string& name);

  std::vector<std::unique_ptr<FieldSource>> sources;
  std::vector<Field> fields;
  std::string lock_path;
  std::optional<FileLock> lock;
  std::unique_ptr<FrameOutput> output;
};

ResultsWriter::Implementation::Implementation(const std::string& directory, const Body& body,
                                              const SemidiscreteProblem& problem, const ResultsOptions& options,
                                              const Snapshot* snapshot, const std::string& name)
    : sources(make_field_sources({body, problem, wanted_fields(options.fields)})),
      lock_path(directory + "/" + lock_of_results(options.format)) {
  for (const auto& source : sources) {
    for (const Field& field : source->fields()) fields.push_back(field);
  }
  const FrameOutputContext context{directory, body, problem, fields, options.file, snapshot, name};
  const auto open = [&] {
    output = options.format == ResultsFormat::vtkhdf ? make_vtkhdf_output(context) : make_xdmf_output(context);
  };
  if (snapshot == nullptr) {
    open();
    return;
  }
  lock.emplace(lock_path);
  const LockedFrames locked(*lock);
  open();
}

ResultsWriter::ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                             const ResultsOptions& options)
    : implementation_(std::make_unique<Implementation>(directory, body, problem, options, nullptr, "")) {}

ResultsWriter::ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                             const ResultsOptions& options, const Snapshot& snapshot, const std::string& name)
    : implementation_(std::make_unique<Implementation>(directory, body, problem, options, &snapshot, name)) {}

ResultsWriter::~ResultsWriter() = default;

void ResultsWriter::write(const State& state) {
  Implementation& own = *implementation_;
  for (const auto& source : own.sources) source->evaluate(state);
  if (!own.lock) own.lock.emplace(own.lock_path);  // the file is there by now
  const LockedFrames locked(*own.lock);
  own.output->write(state);
}

long ResultsWriter::frames() const {
  return implementation_->output->frames();
}

void ResultsWriter::save(Snapshot& snapshot, const std::string& name) const {
  implementation_->output->save(snapshot, name);
}

void ResultsWriter::sync() const {
  for (const std::string& path : implementation_->output->paths()) sync_to_disk(path);
}

}  // namespace ricochet
