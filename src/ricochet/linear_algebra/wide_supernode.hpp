#pragma once

#include "ricochet/linear_algebra/supernode_layout.hpp"

/// @file Triangular solves with one supernode on all threads.
///
/// The columns are processed in strips. One thread solves the triangle of a strip; the rows below are divided into
/// parts, of which a thread reads several concurrently, because one core then gets more memory bandwidth. Each part has
/// its own sum, and the sums are added in the order of the parts: bits do not depend on the number of threads.
namespace ricochet {

class WideSupernode {
 public:
  WideSupernode(Index columns, Index rows, const double* numbers) : layout_(columns, rows), numbers_(numbers) {}
  /// Returns whether a supernode is large enough to be shared by threads.
  [[nodiscard]] static bool is_wide(Index columns, Index rows);

  // See supernode_forward and supernode_backward (linear_algebra/supernodal_kernels.hpp).
  void forward(double* w) const;
  /// `sums` is work space of sums_size().
  void backward(double* w, double* sums) const;
  [[nodiscard]] static Index sums_size();

 private:
  /// The head, if it is the first strip, and blocks [begin, end).
  struct Strip {
    Index head = 0, begin = 0, end = 0;
  };
  [[nodiscard]] Index strips() const;
  [[nodiscard]] Strip strip(Index number) const;
  /// Parts of the panels below a strip.
  struct Parts {
    Index begin = 0, end = 0, count = 0;
    [[nodiscard]] Index at(Index part) const { return begin + (end - begin) * part / count; }
  };
  [[nodiscard]] Parts parts(const Strip& strip) const;
  void forward_rows(const Strip& strip, const Parts& parts, Index first, Index last, double* w) const;
  void backward_rows(const Strip& strip, const Parts& parts, Index first, Index last, const double* w,
                     double* sums) const;

  SupernodeLayout layout_;
  const double* numbers_;
};

}  // namespace ricochet
