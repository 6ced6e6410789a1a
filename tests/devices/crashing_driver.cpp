// SPDX-License-Identifier: Apache-2.0
// An OpenCL driver that aborts as soon as the loader asks it anything.
#include <cstdlib>

extern "C" __attribute__((visibility("default"))) void *clGetExtensionFunctionAddress(const char *) { std::abort(); }
