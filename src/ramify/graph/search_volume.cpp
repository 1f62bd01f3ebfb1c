// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/search_lattice.h"

namespace ramify {

template SearchEnd search_lattice<6>(const Lattice&, Plan&, SearchTask, const WeightRange&, const Monitor&);
template SearchEnd search_lattice<26>(const Lattice&, Plan&, SearchTask, const WeightRange&, const Monitor&);
template SearchEnd search_lattice_again<6>(const Lattice&, const Plan&, const WeightRange&, TwoNearest&, const Monitor&);
template SearchEnd search_lattice_again<26>(const Lattice&, const Plan&, const WeightRange&, TwoNearest&, const Monitor&);

}  // namespace ramify
