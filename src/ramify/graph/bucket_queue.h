// SPDX-License-Identifier: GPL-3.0-or-later
// Monotone priority queues for label-setting searches. Both hand out batches: all that lies in the lowest range of keys,
// within which the order is of no consequence because every edge leads out of it. Private to the layer.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace ramify {

template <class Key>
struct QueueItem {
  Key key;
  std::uint32_t node;
};

// A ring of buckets 2^shift keys wide (Dial 1969; Dinitz 1978: a bucket no wider than the cheapest edge needs no order
// within). No pushed key may exceed the current one by more than `widest`.
class BucketQueue {
 public:
  using Key = std::uint32_t;
  using Item = QueueItem<Key>;
  BucketQueue(Key cheapest, Key widest)
      : shift_(std::bit_width(cheapest) - 1), mask_(std::bit_ceil((widest >> shift_) + 2u) - 1), ring_(mask_ + 1) {}
  // How many buckets a queue would need.
  static std::uint32_t size_for(Key cheapest, Key widest) { return (widest >> (std::bit_width(cheapest) - 1)) + 2u; }

  void push(Key key, std::uint32_t node) {
    ring_[(key >> shift_) & mask_].push_back({key, node});
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  // The items of the lowest bucket, which is emptied; valid until the next call.
  const std::vector<Item>& pop_batch() {
    batch_.clear();
    while (ring_[at_ & mask_].empty()) ++at_;
    batch_.swap(ring_[at_ & mask_]);
    count_ -= batch_.size();
    ++at_;
    return batch_;
  }
  // Every key below this one is final once the batch has been worked off.
  std::uint64_t horizon() const { return static_cast<std::uint64_t>(at_) << shift_; }
  template <class F>
  void for_each_node(F&& f) const {
    for (const auto& bucket : ring_) {
      for (const Item& item : bucket) f(item.node);
    }
  }

 private:
  int shift_;
  std::uint32_t mask_;
  std::uint32_t at_ = 0;
  std::size_t count_ = 0;
  std::vector<std::vector<Item>> ring_;
  std::vector<Item> batch_;
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
  void swap_batch(std::vector<Item>& other) {
    pop_batch();
    other.swap(batch_);
  }
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

// For keys (peak << 32 | sum) of searches that work off one peak after the other. What has the current peak lies in a ring
// of buckets by its sum, as in BucketQueue; what has a higher one waits, sorted by nothing but the peak, and is sorted by
// the sum when its peak's turn comes: such sums may lie anywhere. No sum pushed at the current peak may exceed the one
// worked off by more than `widest`.
class PairQueue {
 public:
  using Key = std::uint64_t;
  using Item = QueueItem<Key>;
  PairQueue(std::uint32_t cheapest, std::uint32_t widest)
      : shift_(std::bit_width(cheapest) - 1), mask_(std::max(64u, std::bit_ceil((widest >> shift_) + 2u)) - 1), ring_(mask_ + 1),
        used_((mask_ + 1) / 64, 0) {}

  void push(Key key, std::uint32_t node) {
    if (!open_ || key >> 32 != peak_) {
      waiting_.push(key, node);
      return;
    }
    const std::uint32_t slot = bucket_of(key) & mask_;
    ring_[slot].push_back({key, node});
    used_[slot / 64] |= 1ull << (slot % 64);
    ++count_;
  }
  bool empty() const { return count_ == 0 && next_ == sorted_.size() && waiting_.empty(); }
  const std::vector<Item>& pop_batch() {
    if (count_ == 0 && next_ == sorted_.size()) open_next_peak();
    const std::uint32_t in_ring = count_ ? first_used() : kNever, in_list = next_ < sorted_.size() ? bucket_of(sorted_[next_].key) : kNever;
    const std::uint32_t bucket = std::min(in_ring, in_list), slot = bucket & mask_;
    batch_.clear();
    if (in_ring == bucket) {
      batch_.swap(ring_[slot]);
      used_[slot / 64] &= ~(1ull << (slot % 64));
      count_ -= batch_.size();
    }
    for (; next_ < sorted_.size() && bucket_of(sorted_[next_].key) == bucket; ++next_) batch_.push_back(sorted_[next_]);
    at_ = bucket + 1;
    return batch_;
  }
  // What probably comes next, to be brought near.
  template <class F>
  [[gnu::always_inline]] inline void preview(const F& f) const {
    if (count_) {
      for (const Item& item : ring_[first_used() & mask_]) f(item.node);
    }
    for (std::size_t i = next_; i < std::min(next_ + kAhead, sorted_.size()); ++i) f(sorted_[i].node);
  }
  std::uint64_t horizon() const { return (static_cast<std::uint64_t>(peak_) << 32) + (static_cast<std::uint64_t>(at_) << shift_); }
  template <class F>
  void for_each_node(F&& f) const {
    waiting_.for_each_node(f);
    for (std::size_t i = next_; i < sorted_.size(); ++i) f(sorted_[i].node);
    for (const auto& bucket : ring_) {
      for (const Item& item : bucket) f(item.node);
    }
  }

 private:
  static constexpr std::size_t kAhead = 4;
  static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t bucket_of(Key key) const { return static_cast<std::uint32_t>(key) >> shift_; }
  void open_next_peak() {
    waiting_.swap_batch(sorted_);
    std::sort(sorted_.begin(), sorted_.end(), [](const Item& a, const Item& b) { return a.key < b.key; });
    next_ = 0;
    open_ = true;
    peak_ = static_cast<std::uint32_t>(sorted_.front().key >> 32);
    at_ = bucket_of(sorted_.front().key);
  }
  // The first bucket from at_ on that holds something.
  std::uint32_t first_used() const {
    const std::uint32_t start = at_ & mask_, words = (mask_ + 1) / 64;
    std::uint32_t word = start / 64;
    std::uint64_t bits = used_[word] & (~0ull << (start % 64));
    while (bits == 0) {
      word = (word + 1) % words;
      bits = used_[word];
    }
    return at_ + ((word * 64 + std::countr_zero(bits) - start) & mask_);
  }

  int shift_;
  std::uint32_t mask_;
  bool open_ = false;
  std::uint32_t peak_ = 0, at_ = 0;
  std::size_t count_ = 0, next_ = 0;              // items in the ring; the next one of sorted_
  std::vector<std::vector<Item>> ring_;
  std::vector<std::uint64_t> used_;               // one bit a bucket
  std::vector<Item> sorted_, batch_;
  RadixQueue<Key> waiting_{32};
};

}  // namespace ramify
