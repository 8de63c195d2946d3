#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Communication between ranks. All functions are collective unless stated otherwise.
namespace ricochet {

/// The processes of this program, which start together and end together.
class Processes {
 public:
  Processes(int& count, char**& arguments);
  /// Waits for the others.
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  /// Returns true if all processes arrive here within so many seconds.
  [[nodiscard]] static bool all_arrive(double seconds);
  /// Ends all processes at once, with this exit status.
  [[noreturn]] static void end_all(int status);
};

/// Numbers sent to another rank and received from it; the sizes of the vectors are the lengths of the messages.
struct Message {
  int rank = 0;
  std::vector<double> out, in;
};

/// A group of ranks. A copy denotes the same group.
class Communicator {
 public:
  /// Returns all ranks of the run. MPI must be initialized.
  [[nodiscard]] static Communicator world();

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }

  /// Exchanges data: `to_each` has one entry per receiving rank, the result one per sending rank.
  [[nodiscard]] std::vector<std::vector<std::int64_t>> exchange(
      const std::vector<std::vector<std::int64_t>>& to_each) const;
  [[nodiscard]] std::vector<std::vector<double>> exchange(const std::vector<std::vector<double>>& to_each) const;
  /// Returns the values of all ranks, which have equal lengths, in the order of the ranks.
  [[nodiscard]] std::vector<double> gather(std::span<const double> values) const;
  /// Sends bytes to another rank, in any number of pieces followed by an empty one; receive returns them all. Only
  /// these two ranks take part.
  void send(int rank, std::span<const char> bytes) const;
  [[nodiscard]] std::vector<char> receive(int rank) const;
  /// Sends and receives simultaneously. Only the ranks named in messages take part; each names the others.
  void swap(std::vector<Message>& messages) const;

 private:
  struct Handle;  ///< communicator of MPI
  template <class Number>
  [[nodiscard]] std::vector<std::vector<Number>> exchange_any(const std::vector<std::vector<Number>>& to_each) const;
  explicit Communicator(std::shared_ptr<Handle> handle);

  std::shared_ptr<Handle> handle_;
  int rank_ = 0, size_ = 1;
};

}  // namespace ricochet
