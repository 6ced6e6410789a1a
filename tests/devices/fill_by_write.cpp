// SPDX-License-Identifier: Apache-2.0
// clEnqueueFillBuffer by way of clEnqueueWriteBuffer, to be preloaded: Oclgrind 21.10 fills a buffer and still holds it for uninitialized.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <cstring>
#include <vector>

extern "C" cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void *pattern, size_t pattern_size, size_t offset, size_t size,
                                      cl_uint wait_count, const cl_event *wait_list, cl_event *event) {
  if (pattern_size == 0 || size % pattern_size != 0) return CL_INVALID_VALUE;
  std::vector<unsigned char> bytes(size);
  for (size_t at = 0; at < size; at += pattern_size) std::memcpy(bytes.data() + at, pattern, pattern_size);
  return clEnqueueWriteBuffer(queue, buffer, CL_TRUE, offset, size, bytes.data(), wait_count, wait_list, event);
}
