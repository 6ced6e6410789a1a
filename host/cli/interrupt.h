// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM: the first asks to end early and keep what is there, the second ends at once with status 130.
#pragma once

namespace sunstone {

void catch_interrupts();
bool interrupted();

}  // namespace sunstone
