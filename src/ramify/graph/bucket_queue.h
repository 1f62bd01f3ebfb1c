// SPDX-License-Identifier: GPL-3.0-or-later
// Monotone priority queues for label-setting searches. Both hand out batches: all that lies in the lowest range of keys,
// within which the order is of no consequence because every edge leads out of it. What a batch holds for a label that was
// improved since is told by is_current. Private to the layer.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "ramify/graph/node_lists.h"

namespace ramify {

template <class Key>
struct QueueItem {
  Key key;
  std::uint32_t node;
};

// A ring of buckets 2^shift keys wide (Dial 1969; Dinitz 1978: a bucket no wider than the cheapest edge needs no order
// within). No pushed key may exceed the current one by more than `widest`. It keeps nodes alone, for their labels tell the
// bucket they belong to: a node that is in one twice is handed out twice.
class BucketQueue {
 public:
  using Key = std::uint32_t;
  BucketQueue(Key cheapest, Key widest)
      : shift_(std::bit_width(cheapest) - 1), mask_(std::bit_ceil((widest >> shift_) + 2u) - 1), ring_(mask_ + 1) {}
  // How many buckets a queue would need.
  static std::uint32_t size_for(Key cheapest, Key widest) { return (widest >> (std::bit_width(cheapest) - 1)) + 2u; }

  void push(Key key, std::uint32_t node) {
    ring_.push((key >> shift_) & mask_, node);
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  // The nodes of the lowest bucket, which is emptied; valid until the next call.
  const std::vector<std::uint32_t>& pop_batch() {
    batch_.clear();
    while (ring_.empty(at_ & mask_)) ++at_;
    ring_.move_to(at_ & mask_, batch_);
    count_ -= batch_.size();
    ++at_;
    return batch_;
  }
  static std::uint32_t node_of(std::uint32_t item) { return item; }
  // Whether the item, of the last batch, was pushed with a key like the one its node has now.
  bool is_current(std::uint32_t, Key key) const { return (key >> shift_) + 1 == at_; }
  // Every key below this one is final once the batch has been worked off.
  std::uint64_t horizon() const { return static_cast<std::uint64_t>(at_) << shift_; }
  template <class F>
  void for_each_node(F&& f) const {
    ring_.for_each_node(f);
  }

 private:
  int shift_;
  std::uint32_t mask_;
  std::uint32_t at_ = 0;
  std::size_t count_ = 0;
  NodeLists<15> ring_;
  std::vector<std::uint32_t> batch_;
};

// Buckets by the highest octal digit in which a key differs from the last one handed out, and that digit's value (Ahuja,
// Mehlhorn, Orlin and Tarjan 1990). Keys: unsigned, or the bits of doubles that are not negative. The lowest `shift` bits
// are not ordered: every edge must add at least 2^shift. No pushed key may be below the last batch's.
template <class KeyType>
class RadixQueue {
 public:
  using Key = KeyType;
  using Item = QueueItem<Key>;
  explicit RadixQueue(int shift) : shift_(shift) {}

  void push(Key key, std::uint32_t node) {
    put({key, node});
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  const std::vector<Item>& pop_batch() {
    if (buckets_[0].empty()) refill();
    batch_.clear();
    batch_.swap(buckets_[0]);
    count_ -= batch_.size();
    return batch_;
  }
  static std::uint32_t node_of(const Item& item) { return item.node; }
  static bool is_current(const Item& item, Key key) { return item.key == key; }
  std::uint64_t horizon() const { return (static_cast<std::uint64_t>(last_) + 1) << shift_; }
  template <class F>
  void for_each_node(F&& f) const {
    for (const auto& bucket : buckets_) {
      for (const Item& item : bucket) f(item.node);
    }
  }

 private:
  static constexpr int kDigits = (std::numeric_limits<Key>::digits + 2) / 3;

  void put(const Item& item) {
    const Key high = item.key >> shift_;
    if (high == last_) {
      buckets_[0].push_back(item);
      return;
    }
    const int digit = (std::bit_width(high ^ last_) - 1) / 3, value = static_cast<int>((high >> (3 * digit)) & 7);
    digits_ |= 1u << digit;
    values_[digit] |= static_cast<std::uint8_t>(1u << value);
    buckets_[static_cast<std::size_t>(1 + 8 * digit + value)].push_back(item);
  }
  void refill() {
    const int digit = std::countr_zero(digits_), value = std::countr_zero(values_[digit]);
    values_[digit] &= static_cast<std::uint8_t>(values_[digit] - 1);
    if (values_[digit] == 0) digits_ &= digits_ - 1;
    std::vector<Item>& from = buckets_[static_cast<std::size_t>(1 + 8 * digit + value)];
    last_ = std::numeric_limits<Key>::max();
    for (const Item& item : from) last_ = std::min<Key>(last_, item.key >> shift_);
    for (const Item& item : from) put(item);
    from.clear();
  }

  int shift_;
  Key last_ = 0;
  std::size_t count_ = 0;
  std::uint32_t digits_ = 0;                        // which digits have items,
  std::array<std::uint8_t, kDigits> values_{};      // and with which values
  std::array<std::vector<Item>, 1 + 8 * kDigits> buckets_;
  std::vector<Item> batch_;
};

}  // namespace ramify
