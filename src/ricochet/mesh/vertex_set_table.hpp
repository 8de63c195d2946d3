#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Finding cells and facets by their vertices. Private to mesh/.
namespace ricochet {

/// An open-addressing hash table of cells of one shape, equal if they have the same vertices in any order.
class VertexSetTable {
 public:
  /// Makes room for `capacity` cells, which may be exceeded.
  explicit VertexSetTable(int vertex_count, std::size_t capacity = 0)
      : vertex_count_(std::size_t(vertex_count)), slots_(std::bit_ceil(2 * capacity + 2)) {
    keys_.reserve(capacity * vertex_count_);
  }

  /// Returns the number of the equal cell, or −1.
  [[nodiscard]] Index find(const Index* vertices) const {
    const Key key = sorted(vertices);
    return slots_[slot_of(key)].number;
  }
  /// Returns the number of the equal cell; if there is none, adds the cell with the next number, from 0 on, and returns
  /// −1.
  Index find_or_add(const Index* vertices) {
    if (2 * std::size_t(size_) + 2 > slots_.size()) grow();
    const Key key = sorted(vertices);
    Slot& slot = slots_[slot_of(key)];
    if (slot.number >= 0) return slot.number;
    slot = {hash(key), size_++};
    keys_.insert(keys_.end(), key.begin(), key.begin() + std::ptrdiff_t(vertex_count_));
    return -1;
  }

 private:
  using Key = std::array<Index, 8>;
  struct Slot {
    std::uint64_t hash = 0;
    Index number = -1;
  };

  void grow() {
    std::vector<Slot> before(2 * slots_.size());
    before.swap(slots_);
    for (const Slot& slot : before) {
      if (slot.number < 0) continue;
      std::size_t at = std::size_t(slot.hash) & (slots_.size() - 1);
      while (slots_[at].number >= 0) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = slot;
    }
  }

  Key sorted(const Index* vertices) const {
    Key key{};
    for (std::size_t i = 0; i < vertex_count_; ++i) {  // insertion sort: there are at most eight
      std::size_t slot = i;
      for (; slot > 0 && key[slot - 1] > vertices[i]; --slot) key[slot] = key[slot - 1];
      key[slot] = vertices[i];
    }
    return key;
  }

  std::uint64_t hash(const Key& key) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < vertex_count_; ++i) {
      value = (std::rotl(value, 23) ^ std::uint64_t(key[i])) * 0x9e3779b97f4a7c15u;
    }
    return value ^ (value >> 32);
  }

  std::size_t slot_of(const Key& key) const {
    const std::uint64_t key_hash = hash(key);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = std::size_t(key_hash) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot].number < 0) return slot;
      if (slots_[slot].hash != key_hash) continue;
      const Index* stored = keys_.data() + std::size_t(slots_[slot].number) * vertex_count_;
      if (std::equal(stored, stored + vertex_count_, key.begin())) return slot;
    }
  }

  std::size_t vertex_count_;
  std::vector<Slot> slots_;
  std::vector<Index> keys_;
  Index size_ = 0;
};

}  // namespace ricochet
