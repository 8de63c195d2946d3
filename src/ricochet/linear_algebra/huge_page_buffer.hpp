#pragma once

#include <cstddef>
#include <memory>

/// @file Memory for arrays that are read from end to end in every time step.
namespace ricochet {

/// An array of doubles aligned to 64 bytes, on huge pages if the system has them (a factor of 200 MB has 50,000
/// ordinary pages, more than a processor holds address translations for). Not initialized. Throws std::bad_alloc.
class HugePageBuffer {
 public:
  HugePageBuffer() = default;
  explicit HugePageBuffer(std::size_t size);

  [[nodiscard]] double* data() { return values_.get(); }
  [[nodiscard]] const double* data() const { return values_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Release {
    void operator()(double* values) const;
  };
  std::unique_ptr<double[], Release> values_;
  std::size_t size_ = 0;
};

}  // namespace ricochet
