#include "ricochet/distributed/communicator.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <thread>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

constexpr int message_tag = 26;

}  // namespace

struct Communicator::Handle {
  MPI_Comm ranks = MPI_COMM_NULL;
  std::vector<MPI_Request> requests;  ///< work space
};

Communicator::Communicator(std::shared_ptr<Handle> handle) : handle_(std::move(handle)) {
  MPI_Comm_rank(handle_->ranks, &rank_);
  MPI_Comm_size(handle_->ranks, &size_);
}

Communicator Communicator::world() {
  auto handle = std::make_shared<Handle>();
  handle->ranks = MPI_COMM_WORLD;
  return Communicator(std::move(handle));
}

Processes::Processes(int& count, char**& arguments) {
  int provided = 0;
  MPI_Init_thread(&count, &arguments, MPI_THREAD_FUNNELED, &provided);
}

Processes::~Processes() {
  MPI_Finalize();
}

bool Processes::all_arrive(double seconds) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  int done = 0;
  do {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (done == 0 && std::chrono::steady_clock::now() < end);
  return done != 0;
}

void Processes::end_all(int status) {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::_Exit(status);
}

void Communicator::swap(std::vector<Message>& messages) const {
  std::vector<MPI_Request>& requests = handle_->requests;
  requests.resize(2 * messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    Message& message = messages[i];
    MPI_Irecv(message.in.data(), static_cast<int>(message.in.size()), MPI_DOUBLE, message.rank, message_tag,
              handle_->ranks, &requests[2 * i]);
    MPI_Isend(message.out.data(), static_cast<int>(message.out.size()), MPI_DOUBLE, message.rank, message_tag,
              handle_->ranks, &requests[2 * i + 1]);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void Communicator::send(int rank, std::span<const char> bytes) const {
  constexpr std::size_t largest = std::size_t{1} << 30;  // MPI counts up to 2³¹
  do {
    const std::span<const char> piece = bytes.first(std::min(bytes.size(), largest));
    bytes = bytes.subspan(piece.size());
    MPI_Send(piece.data(), static_cast<int>(piece.size()), MPI_CHAR, rank, message_tag, handle_->ranks);
  } while (!bytes.empty());
}

std::vector<char> Communicator::receive(int rank) const {
  std::vector<char> bytes;
  for (;;) {
    MPI_Status status;
    int length = 0;
    MPI_Probe(rank, message_tag, handle_->ranks, &status);
    MPI_Get_count(&status, MPI_CHAR, &length);
    const std::size_t before = bytes.size();
    bytes.resize(before + static_cast<std::size_t>(length));
    MPI_Recv(bytes.data() + before, length, MPI_CHAR, rank, message_tag, handle_->ranks, MPI_STATUS_IGNORE);
    if (length == 0) return bytes;
  }
}

template <class Number>
std::vector<std::vector<Number>> Communicator::exchange_any(const std::vector<std::vector<Number>>& to_each) const {
  const MPI_Datatype type = std::is_same_v<Number, double> ? MPI_DOUBLE : MPI_INT64_T;
  const auto ranks = static_cast<std::size_t>(size_);
  std::vector<int> counts_out(ranks), counts_in(ranks), begins_out(ranks), begins_in(ranks);
  std::vector<Number> out, in;
  for (std::size_t r = 0; r < ranks; ++r) {
    begins_out[r] = static_cast<int>(out.size());
    out.insert(out.end(), to_each[r].begin(), to_each[r].end());
    if (out.size() > std::numeric_limits<int>::max())
      throw Error(ErrorKind::invalid_input, "a rank has more to tell the others than MPI can count: take more ranks");
    counts_out[r] = static_cast<int>(to_each[r].size());
  }
  MPI_Alltoall(counts_out.data(), 1, MPI_INT, counts_in.data(), 1, MPI_INT, handle_->ranks);
  std::exclusive_scan(counts_in.begin(), counts_in.end(), begins_in.begin(), 0);
  in.resize(static_cast<std::size_t>(begins_in.back() + counts_in.back()));
  MPI_Alltoallv(out.data(), counts_out.data(), begins_out.data(), type, in.data(), counts_in.data(), begins_in.data(),
                type, handle_->ranks);
  std::vector<std::vector<Number>> result(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
    result[r].assign(in.begin() + begins_in[r], in.begin() + begins_in[r] + counts_in[r]);
  return result;
}

std::vector<std::vector<std::int64_t>> Communicator::exchange(
    const std::vector<std::vector<std::int64_t>>& to_each) const {
  return exchange_any(to_each);
}

std::vector<std::vector<double>> Communicator::exchange(const std::vector<std::vector<double>>& to_each) const {
  return exchange_any(to_each);
}

std::vector<double> Communicator::gather(std::span<const double> values) const {
  std::vector<double> result(values.size() * static_cast<std::size_t>(size_));
  const int count = static_cast<int>(values.size());
  MPI_Allgather(values.data(), count, MPI_DOUBLE, result.data(), count, MPI_DOUBLE, handle_->ranks);
  return result;
}

}  // namespace ricochet
