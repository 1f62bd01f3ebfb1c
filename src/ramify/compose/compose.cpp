// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/compose.h"

namespace ramify {

std::vector<OptionField> describe(ComposeOptions& o) {
  return {choice("composite", o.composite, {"auto", "paste", "emit", "absorb"},
                 "How branches are laid on: pasted, as light, or as shade."),
          choice("background", o.background, {"auto", "keep", "vary", "new"},
                 "What they are laid on: the photo's own ground, a variation of it, or new ground of its kind."),
          flag("mirror", o.mirror, "The ground and the sources may be mirrored."),
          number("leave-out", o.leave_out, 0.0, 100.0, "discs", "Ban sources nearer than this to their own place in the photo (a test)."),
          flag("paper-spacing", o.paper_spacing, "Paper: source discs spaced by lambda = 0.75 only."),
          flag("paper-greedy", o.paper_greedy, "Paper: greedy choice with summed colour difference."),
          flag("paper-order", o.paper_order, "Paper: parents first, furcations laid over them."),
          flag("paper-rigid", o.paper_rigid, "Fragments are turned but not bent (the paper's figure 5a)."),
          flag("paper-warp", o.paper_warp, "Paper: bent by the squared Laplacian, centre line alone."),
          flag("paper-cut", o.paper_cut, "Paper: seams by colour difference alone."),
          flag("paper-blend", o.paper_blend, "Paper: one gradient-domain problem after the other."),
          flag("free-rims", o.free_rims, "With --paper-blend: the plain variant that drifts (figure 5b)."),
          flag("paper-exact", o.paper_exact, "Every stage as the paper has it.")};
}

}  // namespace ramify
