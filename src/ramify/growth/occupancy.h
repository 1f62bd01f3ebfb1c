// SPDX-License-Identifier: GPL-3.0-or-later
// The grown branches as capsules: exact tests that nothing crosses or touches, and the density D (paper 002, section 4.4;
// ALGORITHMS 4.5).
#pragma once

#include "ramify/geometry/capsule_index.h"
#include "ramify/growth/growing_branch.h"
#include "ramify/growth/ground.h"

namespace ramify {

struct Hit {
  bool blocked = false;     // the extension may not be used
  int capsule = kNone;      // what it met, where a join there would be possible
  int point = 0;            // the extension's point whose edge met it
};

// Room that branches leave each other, as the exemplar's do.
struct KeptRoom {
  double spread = 16.0;    // half of rho, px
  double clearance = 0.0;  // px between the rims of strangers
  double opening = 0.0;    // px more room per px of a branch's own arc, until the clearance is reached
};

class Occupancy {
 public:
  // step: h, px.
  Occupancy(const Ground& ground, double widest, const KeptRoom& room, double step);

  const CapsuleIndex& index() const { return index_; }

  void add_link(const Vec2& junction, const Vec2& start, int branch);  // from the parent's axis to its rim
  void add_edge(const GrowingBranch& branch, int number, int node);    // from node - 1 to node
  void remove_last() { index_.remove_last(); }

  // Whether `extension` of branch `number` crosses, touches or comes too near anything, itself included, or enters what
  // is blocked. joining: it may come near what it ends on.
  Hit meet(const std::vector<GrowingBranch>& branches, int number, const Extension& extension, bool joining = false) const;

  // Whether the link edge of a child would cross anything.
  bool link_blocked(const std::vector<GrowingBranch>& branches, int parent, int parent_node, const Vec2& start) const;

  // D = exp(-d^2 / rho^2) for the distance d to the nearest branch; the branch's own last stretch and its parent near
  // the furcation do not count. `node`: index the point would have in the branch.
  double density(const std::vector<GrowingBranch>& branches, int number, const Vec2& point, int node) const;

 private:
  enum class Verdict { Clear, Blocked, Meets };
  Verdict judge(const std::vector<GrowingBranch>& branches, int number, const Capsule& edge, const Capsule& other,
                double clearance) const;
  bool blocked_ground(const Capsule& edge) const;

  const Ground& ground_;
  KeptRoom room_;
  double step_;
  double widest_;
  CapsuleIndex index_;
};

}  // namespace ramify
