// SPDX-License-Identifier: Apache-2.0
// Names of layouts, for the binary too, which does not link Embree.
#include "base/error.h"
#include "flatten/flatten.h"

namespace sunstone {

const char *layout_name(Layout layout) { return layout == Layout::binary ? "binary" : layout == Layout::wide8 ? "wide8" : "wide16"; }

Layout layout_from_name(const std::string &name) {
  for (Layout layout : {Layout::binary, Layout::wide8, Layout::wide16})
    if (name == layout_name(layout)) return layout;
  throw UsageError{"--layout", "there is no layout " + printable(name), "binary, wide8 or wide16"};
}

}  // namespace sunstone
