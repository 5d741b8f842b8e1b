#pragma once
// From user ids to indices: an open-addressing hash table with linear probing, filled once.
#include <cstdint>
#include <vector>

namespace fabrica {

class IdTable {
 public:
  // room for n ids; forgets what was there
  void reset(std::size_t n) {
    std::size_t capacity = 16;
    while (capacity < 2 * n + 2) capacity *= 2;
    mask_ = capacity - 1;
    key_.assign(capacity, 0);
    value_.assign(capacity, -1);
    count_ = 0;
  }
  // Stores id -> index; returns the index already stored, or -1 if the id is new.
  int insert(std::int64_t id, int index) {
    if (2 * (count_ + 1) > key_.size()) grow();
    std::size_t i = slot(id);
    if (value_[i] >= 0) return value_[i];
    key_[i] = id, value_[i] = index, ++count_;
    return -1;
  }
  // index of the id, or -1
  int find(std::int64_t id) const { return key_.empty() ? -1 : value_[slot(id)]; }
  std::size_t size() const { return count_; }

 private:
  std::size_t slot(std::int64_t id) const {
    std::size_t i = (std::uint64_t(id) * 0x9E3779B97F4A7C15ull >> 20) & mask_;
    while (value_[i] >= 0 && key_[i] != id) i = (i + 1) & mask_;
    return i;
  }
  void grow() {
    const auto keys = std::move(key_);
    const auto values = std::move(value_);
    reset(keys.size() + 16);
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (values[i] >= 0) insert(keys[i], values[i]);
  }

  std::vector<std::int64_t> key_;
  std::vector<int> value_;
  std::size_t mask_ = 0, count_ = 0;
};

}  // namespace fabrica
