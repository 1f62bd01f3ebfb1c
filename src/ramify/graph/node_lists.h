// SPDX-License-Identifier: GPL-3.0-or-later
// Where queues keep nodes that wait. Private to the layer.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace ramify {

// Many lists of nodes in chunks of kRoom from one pool, so that no list keeps room it does not use.
template <std::uint32_t kRoom>
class NodeLists {
 public:
  explicit NodeLists(std::size_t count) : lists_(count) {}

  void push(std::size_t list, std::uint32_t node) {
    List& to = lists_[list];
    if (to.used == kRoom) to = {fresh_chunk(to.head), 0};
    chunk(to.head).nodes[to.used++] = node;
  }
  bool empty(std::size_t list) const { return lists_[list].head == kNoChunk; }
  // Appends the nodes of a list, which is emptied.
  void move_to(std::size_t list, std::vector<std::uint32_t>& out) {
    List& from = lists_[list];
    for (std::uint32_t used = from.used; from.head != kNoChunk; used = kRoom) {
      Chunk& c = chunk(from.head);
      out.insert(out.end(), c.nodes.begin(), c.nodes.begin() + used);
      const std::uint32_t next = c.next;
      c.next = free_;
      free_ = from.head;
      from.head = next;
    }
    from.used = kRoom;
  }
  template <class F>
  void for_each_node(F&& f) const {
    for (const List& list : lists_) {
      std::uint32_t used = list.used;
      for (std::uint32_t at = list.head; at != kNoChunk; at = chunk(at).next, used = kRoom) {
        for (std::uint32_t i = 0; i < used; ++i) f(chunk(at).nodes[i]);
      }
    }
  }

 private:
  static constexpr std::uint32_t kNoChunk = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kBlock = (1u << 16) / (kRoom + 1);  // chunks
  struct Chunk {
    std::uint32_t next;
    std::array<std::uint32_t, kRoom> nodes;
  };
  struct List {
    std::uint32_t head = kNoChunk, used = kRoom;
  };

  Chunk& chunk(std::uint32_t index) { return blocks_[index / kBlock][index % kBlock]; }
  const Chunk& chunk(std::uint32_t index) const { return blocks_[index / kBlock][index % kBlock]; }
  std::uint32_t fresh_chunk(std::uint32_t next) {
    std::uint32_t index = free_;
    if (index == kNoChunk) {
      index = made_++;
      if (index % kBlock == 0) blocks_.push_back(std::make_unique_for_overwrite<Chunk[]>(kBlock));
    } else {
      free_ = chunk(index).next;
    }
    chunk(index).next = next;
    return index;
  }

  std::vector<List> lists_;
  std::vector<std::unique_ptr<Chunk[]>> blocks_;
  std::uint32_t made_ = 0, free_ = kNoChunk;
};

}  // namespace ramify
