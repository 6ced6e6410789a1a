// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "flatten/layouts.h"

namespace sunstone {

// Takes subtrees out of the tree and puts each back where the surface area of all nodes falls most [Bittner13, Meister18]: a tree by binned SAH, made
// from the top down, loses a tenth or so of its cost. Leaves stay as they are. `passes` over the nodes of largest area.
void optimize_by_reinsertion(BinaryTree &tree, int passes);

}  // namespace sunstone
