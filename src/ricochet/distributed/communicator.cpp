#include "ricochet/distributed/communicator.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace ricochet {

namespace {

constexpr int message_tag = 26, exchange_tag = 27;           ///< and the next tag
constexpr std::size_t largest_piece = std::size_t{1} << 30;  ///< in bytes: MPI counts up to 2³¹
/// Number of exchanges of all groups: a rank may already be in the next exchange, but never in the one after it.
int exchange_count = 0;
/// Communicator for errors, apart from the run's own: other ranks may be in any barrier of the run.
MPI_Comm error_communicator = MPI_COMM_NULL;

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
  MPI_Comm_dup(MPI_COMM_WORLD, &error_communicator);
}

Processes::~Processes() { MPI_Finalize(); }

bool Processes::all_arrive(double seconds) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(error_communicator, &request);
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
    MPI_Irecv(message.in.data(), int(message.in.size()), MPI_DOUBLE, message.rank, message_tag, handle_->ranks,
              &requests[2 * i]);
    MPI_Isend(message.out.data(), int(message.out.size()), MPI_DOUBLE, message.rank, message_tag, handle_->ranks,
              &requests[2 * i + 1]);
  }
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void Communicator::send(int rank, std::span<const char> bytes) const {
  do {
    const std::span<const char> piece = bytes.first(std::min(bytes.size(), largest_piece));
    bytes = bytes.subspan(piece.size());
    MPI_Send(piece.data(), int(piece.size()), MPI_CHAR, rank, message_tag, handle_->ranks);
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
    bytes.resize(before + std::size_t(length));
    MPI_Recv(bytes.data() + before, length, MPI_CHAR, rank, message_tag, handle_->ranks, MPI_STATUS_IGNORE);
    if (length == 0) return bytes;
  }
}

/// Exchanges data without knowing the senders: ranks send messages only if they have data, and enter a barrier when
/// theirs have been received; its completion shows that no more messages arrive (NBX: Hoefler, Siebert, Lumsdaine
/// 2010). Addressing every rank would make the cost of each exchange proportional to the number of ranks.
template <class Number>
std::vector<std::vector<Number>> Communicator::exchange_any(const std::vector<std::vector<Number>>& to_each) const {
  const MPI_Datatype type = std::is_same_v<Number, double> ? MPI_DOUBLE : MPI_INT64_T;
  const int tag = exchange_tag + exchange_count++ % 2;
  std::vector<std::vector<Number>> result(static_cast<std::size_t>(size_));
  std::vector<MPI_Request> requests;
  for (int to = 0; to < size_; ++to) {
    const std::vector<Number>& numbers = to_each[std::size_t(to)];
    if (to == rank_) {
      result[std::size_t(to)] = numbers;
      continue;
    }
    for (std::size_t begin = 0; begin < numbers.size(); begin += largest_piece / sizeof(Number)) {
      const std::size_t count = std::min(numbers.size() - begin, largest_piece / sizeof(Number));
      MPI_Issend(numbers.data() + begin, int(count), type, to, tag, handle_->ranks,
                 &requests.emplace_back(MPI_REQUEST_NULL));
    }
  }
  MPI_Request all_received = MPI_REQUEST_NULL;
  for (int are_received = 0, is_end = 0; is_end == 0;) {
    MPI_Status status;
    int is_there = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, handle_->ranks, &is_there, &status);
    if (is_there != 0) {
      int count = 0;
      MPI_Get_count(&status, type, &count);
      std::vector<Number>& numbers = result[std::size_t(status.MPI_SOURCE)];
      const std::size_t before = numbers.size();
      numbers.resize(before + std::size_t(count));
      MPI_Recv(numbers.data() + before, count, type, status.MPI_SOURCE, tag, handle_->ranks, MPI_STATUS_IGNORE);
    } else if (are_received == 0) {
      MPI_Testall(int(requests.size()), requests.data(), &are_received, MPI_STATUSES_IGNORE);
      if (are_received != 0) MPI_Ibarrier(handle_->ranks, &all_received);
    } else {
      MPI_Test(&all_received, &is_end, MPI_STATUS_IGNORE);
    }
  }
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
  std::vector<double> result(values.size() * std::size_t(size_));
  const int count = int(values.size());
  MPI_Allgather(values.data(), count, MPI_DOUBLE, result.data(), count, MPI_DOUBLE, handle_->ranks);
  return result;
}

}  // namespace ricochet
