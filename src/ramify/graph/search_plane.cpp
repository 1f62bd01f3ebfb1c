// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/search_lattice.h"

namespace ramify {

template SearchEnd search_lattice<4>(const Lattice&, Plan&, SearchTask, const WeightRange&, const Monitor&);
template SearchEnd search_lattice<8>(const Lattice&, Plan&, SearchTask, const WeightRange&, const Monitor&);
template SearchEnd search_lattice_again<4>(const Lattice&, const Plan&, const WeightRange&, TwoNearest&, const Monitor&);
template SearchEnd search_lattice_again<8>(const Lattice&, const Plan&, const WeightRange&, TwoNearest&, const Monitor&);

}  // namespace ramify
