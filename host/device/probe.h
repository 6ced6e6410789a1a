// SPDX-License-Identifier: Apache-2.0
// Drivers that crash while they are asked for their devices are everyday, and the loader loads all of them at once: so they are tried in a child first.
#pragma once
#include "base/notice.h"

namespace sunstone {

// Before the first OpenCL call of the process: where a child that lists all devices does not live to its end, each driver is tried alone, and those that
// crash or hang are left out (by pointing OCL_ICD_VENDORS at copies of the others' .icd files), with a warning that names them. What was tried is
// remembered by the drivers' files, so a start with the drivers of last time costs nothing.
void leave_out_broken_drivers(Notices &notices);

}  // namespace sunstone
