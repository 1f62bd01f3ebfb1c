// SPDX-License-Identifier: GPL-3.0-or-later
// The queue of searches that work off one peak after the other (keys: peak << 32 | sum). Private to the layer.
#pragma once

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "ramify/graph/bucket_queue.h"
#include "ramify/graph/labels.h"
#include "ramify/graph/node_lists.h"

namespace ramify {

// What has a higher peak than the current one waits in a list for its peak: nodes alone, for their labels say the rest.
// When its turn comes, nodes whose labels have a lower peak by now are dropped and the others handed out in no order.
// Hardly any of them lies next to another of its peak; what they offer at their own peak is worked off by its sum after
// them, and where that improves one of them it is handed out again. Labels of one peak are ordered by their sums alone,
// so what is offered too early is only ever too dear and is offered again: the forest is the same, and hardly anything
// is sorted. What is worked off by its sum lies in a ring of buckets as in BucketQueue; no sum pushed meanwhile may
// exceed the one worked off by more than `widest`. Edges may not have a higher peak than `widest` either, sources may.
template <class View>
class PeakQueue {
 public:
  using Key = std::uint64_t;
  using Item = QueueItem<Key>;
  PeakQueue(const View& view, const SumAndPeak* labels, std::uint32_t cheapest, std::uint32_t widest)
      : view_(view),
        labels_(labels),
        shift_(std::bit_width(cheapest) - 1),
        mask_(std::max(64u, std::bit_ceil((widest >> shift_) + 2u)) - 1),
        ring_(mask_ + 1),
        used_((mask_ + 1) / 64, 0),
        peak_shift_(std::max(0, static_cast<int>(std::bit_width(widest)) - kListBits)),
        waiting_(kLists) {}

  // `old` is the key of the label that the node had before.
  void push(Key key, std::uint32_t node, Key old = std::numeric_limits<Key>::max()) {
    const auto peak = static_cast<std::uint32_t>(key >> 32);
    if (peak != peak_) {
      if (peak != old >> 32) wait(peak, node);  // or it waits already
    } else if (!ordered_) {
      offered_.push_back({key, node});
    } else {
      const std::uint32_t slot = bucket_of(key) & mask_;
      ring_[slot].push_back({key, node});
      used_[slot / 64] |= 1ull << (slot % 64);
      ++count_;
    }
  }
  static std::uint32_t node_of(const Item& item) { return item.node; }
  // Whether the item was pushed for the label that the node has now.
  static bool is_current(const Item& item, Key key) { return item.key == key; }
  bool empty() const { return is_peak_done() && next_gathered_ == gathered_.size() && waiting_count_ == 0; }
  // May be empty when all that waited has lower peaks by now.
  const std::vector<Item>& pop_batch() {
    batch_.clear();
    if (is_peak_done()) open_next_peak();
    if (next_open_ < open_.size()) {
      for (const std::size_t end = std::min(open_.size(), next_open_ + kAhead); next_open_ < end; ++next_open_) {
        const std::uint32_t node = open_[next_open_];
        // What is too dear only because it came too early must not end the search.
        (labels_[node].sum > kTickCeiling ? offered_ : batch_).push_back({key_of(node), node});
      }
    } else if (!is_peak_done()) {
      if (!ordered_) order_offers();
      pop_lowest();
    }
    return batch_;
  }
  // What probably comes next, to be brought near.
  template <class F>
  [[gnu::always_inline]] inline void preview(const F& f) const {
    for (std::size_t i = next_open_; i < std::min(next_open_ + kAhead, open_.size()); ++i) f(open_[i]);
    if (!ordered_) return;
    if (count_) {
      for (const Item& item : ring_[first_used() & mask_]) f(item.node);
    }
    for (std::size_t i = next_offered_; i < std::min(next_offered_ + kFewAhead, offered_.size()); ++i)
      f(offered_[i].node);
  }
  std::uint64_t horizon() const {
    return (static_cast<std::uint64_t>(peak_) << 32) + (ordered_ ? static_cast<std::uint64_t>(at_) << shift_ : 0);
  }
  // All nodes that may not have their final label yet.
  template <class F>
  void for_each_node(F&& f) const {
    waiting_.for_each_node(f);
    for (const PeakItem& item : later_) f(item.node);
    for (std::size_t i = next_gathered_; i < gathered_.size(); ++i) f(gathered_[i].node);
    for (const std::uint32_t node : open_) f(node);
    for (const Item& item : offered_) f(item.node);
    for (const auto& bucket : ring_) {
      for (const Item& item : bucket) f(item.node);
    }
  }

 private:
  static constexpr int kListBits = 13;  // more lists than weights of 16 bits mostly have sums of two
  static constexpr std::size_t kLists = std::size_t{1} << kListBits;
  static constexpr std::size_t kAhead = 32, kFewAhead = 4;
  static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
  struct PeakItem {
    std::uint32_t peak, node;
    friend auto operator<=>(const PeakItem&, const PeakItem&) = default;
  };

  std::uint32_t bucket_of(Key key) const { return static_cast<std::uint32_t>(key) >> shift_; }
  std::size_t list_of(std::uint32_t peak) const { return std::min<std::size_t>(peak >> peak_shift_, kLists - 1); }
  Key key_of(std::uint32_t node) const {
    return (static_cast<Key>(labels_[node].peak) << 32) + labels_[node].sum + view_.lead(node);
  }
  bool is_peak_done() const { return next_open_ == open_.size() && next_offered_ == offered_.size() && count_ == 0; }

  void wait(std::uint32_t peak, std::uint32_t node) {
    ++waiting_count_;
    const std::size_t list = list_of(peak);
    if (list != at_list_) {
      waiting_.push(list, node);
      return;
    }
    later_.push_back({peak, node});
    std::push_heap(later_.begin(), later_.end(), std::greater<>());
  }
  void open_next_peak() {
    open_.clear();
    offered_.clear();
    next_open_ = next_offered_ = 0;
    ordered_ = false;
    while (open_.empty()) {
      if (next_gathered_ == gathered_.size() && later_.empty()) {
        if (waiting_count_ == 0) return;
        gather_next_list();
        continue;
      }
      peak_ = kNever;
      if (next_gathered_ < gathered_.size()) peak_ = gathered_[next_gathered_].peak;
      if (!later_.empty()) peak_ = std::min(peak_, later_.front().peak);
      for (; next_gathered_ < gathered_.size() && gathered_[next_gathered_].peak == peak_; ++next_gathered_) {
        open(gathered_[next_gathered_].node);
      }
      while (!later_.empty() && later_.front().peak == peak_) {
        open(later_.front().node);
        std::pop_heap(later_.begin(), later_.end(), std::greater<>());
        later_.pop_back();
        --waiting_count_;
      }
    }
  }
  void open(std::uint32_t node) {
    if (labels_[node].peak == peak_) open_.push_back(node);
  }
  // The nodes of the next list that are not settled, by their peaks.
  void gather_next_list() {
    do ++at_list_;
    while (waiting_.empty(at_list_));
    nodes_.clear();
    waiting_.move_to(at_list_, nodes_);
    waiting_count_ -= nodes_.size();
    gathered_.clear();
    next_gathered_ = 0;
    bool mixed = false;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      __builtin_prefetch(labels_ + nodes_[std::min(i + kAhead, nodes_.size() - 1)]);
      const std::uint32_t peak = labels_[nodes_[i]].peak;
      if (list_of(peak) != at_list_) continue;
      gathered_.push_back({peak, nodes_[i]});
      mixed = mixed || peak != gathered_.front().peak;
    }
    if (!mixed) return;
    std::sort(gathered_.begin(), gathered_.end());
    gathered_.erase(std::unique(gathered_.begin(), gathered_.end()), gathered_.end());
  }
  void order_offers() {
    ordered_ = true;
    std::sort(offered_.begin(), offered_.end(), [](const Item& a, const Item& b) { return a.key < b.key; });
    at_ = bucket_of(offered_.front().key);
  }
  // The lowest bucket of what is worked off by its sum.
  void pop_lowest() {
    const std::uint32_t in_ring = count_ ? first_used() : kNever;
    const std::uint32_t in_list = next_offered_ < offered_.size() ? bucket_of(offered_[next_offered_].key) : kNever;
    const std::uint32_t bucket = std::min(in_ring, in_list), slot = bucket & mask_;
    if (in_ring == bucket) {
      batch_.swap(ring_[slot]);
      used_[slot / 64] &= ~(1ull << (slot % 64));
      count_ -= batch_.size();
    }
    for (; next_offered_ < offered_.size() && bucket_of(offered_[next_offered_].key) == bucket; ++next_offered_) {
      batch_.push_back(offered_[next_offered_]);
    }
    at_ = bucket + 1;
  }
  // The first bucket of the ring from at_ on that holds something.
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

  const View& view_;
  const SumAndPeak* labels_;
  // Of the current peak: nodes handed out in no order; then what those offered, and the ring, by the sum.
  std::uint32_t peak_ = kNever;
  std::vector<std::uint32_t> open_;
  std::vector<Item> offered_;
  std::size_t next_open_ = 0, next_offered_ = 0;
  bool ordered_ = false;
  int shift_;
  std::uint32_t mask_, at_ = 0;
  std::size_t count_ = 0;  // items in the ring
  std::vector<std::vector<Item>> ring_;
  std::vector<std::uint64_t> used_;  // one bit a bucket
  // Of higher peaks: those of the current list, sorted, and what came to it since, a heap; then the other lists.
  std::vector<PeakItem> gathered_, later_;
  std::size_t next_gathered_ = 0, at_list_ = std::numeric_limits<std::size_t>::max();
  int peak_shift_;
  NodeLists<63> waiting_;
  std::size_t waiting_count_ = 0;  // in the lists and in later_
  std::vector<std::uint32_t> nodes_;
  std::vector<Item> batch_;
};

}  // namespace ramify
