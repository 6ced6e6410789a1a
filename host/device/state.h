// SPDX-License-Identifier: Apache-2.0
// What the classes of this folder hold; for this folder alone.
#pragma once
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.h"
#include "device/buffer.h"
#include "device/device.h"
#include "device/kernel.h"
#include "device/program.h"

namespace sunstone {

struct Device::State {
  DeviceInfo info;
  DeviceOptions options;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;
  std::shared_ptr<std::atomic<std::size_t>> allocated = std::make_shared<std::atomic<std::size_t>>(0);  // by all its queues
  struct Launch {
    std::string kernel;
    std::size_t items;
    cl::Event event;
  };
  std::vector<Launch> launches;  // not yet summed up
  std::map<std::string, StageTime> times;
  void sum_up();  // waits for the launches
};

struct Program::State {
  Device device;
  cl::Program program;
  std::string name;
};

struct RawBuffer::State {
  Device device;
  cl::Buffer buffer;
  std::size_t bytes = 0;
  std::string what;
  ~State();
};

struct Kernel::State {
  Device device;
  Program program;
  cl::Kernel kernel;
  std::string name;
  std::vector<RawBuffer> bound;  // keeps what the kernel reads alive
  std::size_t local = 0;
};

// "CL_OUT_OF_RESOURCES (-5)".
std::string cl_error_name(int code);

// Runs `work`; an OpenCL error becomes an Error that names `place`, the call and the code.
template <class Work> auto guarded(const std::string &place, Work &&work) {
  try {
    return work();
  } catch (const cl::BuildError &e) {
    throw Error(place, std::string(e.what()) + " gave " + cl_error_name(e.err()));
  } catch (const cl::Error &e) {
    throw Error(place, std::string(e.what()) + " gave " + cl_error_name(e.err()));
  }
}

// list_devices without trying the drivers in a child first.
std::vector<DeviceInfo> list_devices_here(Notices &notices);

// The cl::Device of list_devices' index.
cl::Device device_at(int index);

}  // namespace sunstone
