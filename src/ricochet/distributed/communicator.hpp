#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file What ranks say to each other. All functions are called by all ranks, and wait for them.
namespace ricochet {

/// The processes of this program: they begin together and end together.
class Processes {
 public:
  Processes(int& count, char**& arguments);
  /// Waits for the others.
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  /// True where all have come here within so many seconds.
  [[nodiscard]] static bool all_arrive(double seconds);
  /// Ends all at once, with this exit status.
  [[noreturn]] static void end_all(int status);
};

/// To another rank, and from it: as many numbers as there is room for.
struct Message {
  int rank = 0;
  std::vector<double> out, in;
};

/// A group of ranks. A copy is the same group.
class Communicator {
 public:
  /// All ranks of the run. MPI must have begun.
  [[nodiscard]] static Communicator world();

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }

  /// What each rank has for each: `to_each` has one entry per rank, and so has the result, by whom it comes from.
  [[nodiscard]] std::vector<std::vector<std::int64_t>> exchange(
      const std::vector<std::vector<std::int64_t>>& to_each) const;
  [[nodiscard]] std::vector<std::vector<double>> exchange(const std::vector<std::vector<double>>& to_each) const;
  /// The same numbers of every rank, rank after rank.
  [[nodiscard]] std::vector<double> gather(std::span<const double> values) const;
  /// Bytes for another rank, in as many pieces as one likes, and an empty one at the end; all of them there. The two of
  /// them alone.
  void send(int rank, std::span<const char> bytes) const;
  [[nodiscard]] std::vector<char> receive(int rank) const;
  /// Sends and receives at once. Only the ranks that are named take part; each names the others.
  void swap(std::vector<Message>& messages) const;

 private:
  struct Handle;  ///< MPI's
  template <class Number>
  [[nodiscard]] std::vector<std::vector<Number>> exchange_any(const std::vector<std::vector<Number>>& to_each) const;
  explicit Communicator(std::shared_ptr<Handle> handle);

  std::shared_ptr<Handle> handle_;
  int rank_ = 0, size_ = 1;
};

}  // namespace ricochet
