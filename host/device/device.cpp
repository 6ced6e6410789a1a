// SPDX-License-Identifier: Apache-2.0
#include "device/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "device/probe.h"
#include "device/state.h"

namespace sunstone {

std::string cl_error_name(int code) {
  static const std::map<int, const char *> names = {
      {-1, "CL_DEVICE_NOT_FOUND"}, {-2, "CL_DEVICE_NOT_AVAILABLE"}, {-3, "CL_COMPILER_NOT_AVAILABLE"}, {-4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
      {-5, "CL_OUT_OF_RESOURCES"}, {-6, "CL_OUT_OF_HOST_MEMORY"}, {-7, "CL_PROFILING_INFO_NOT_AVAILABLE"}, {-8, "CL_MEM_COPY_OVERLAP"},
      {-11, "CL_BUILD_PROGRAM_FAILURE"}, {-12, "CL_MAP_FAILURE"}, {-14, "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST"},
      {-15, "CL_COMPILE_PROGRAM_FAILURE"}, {-16, "CL_LINKER_NOT_AVAILABLE"}, {-17, "CL_LINK_PROGRAM_FAILURE"}, {-18, "CL_DEVICE_PARTITION_FAILED"},
      {-19, "CL_KERNEL_ARG_INFO_NOT_AVAILABLE"}, {-30, "CL_INVALID_VALUE"}, {-31, "CL_INVALID_DEVICE_TYPE"}, {-32, "CL_INVALID_PLATFORM"},
      {-33, "CL_INVALID_DEVICE"}, {-34, "CL_INVALID_CONTEXT"}, {-35, "CL_INVALID_QUEUE_PROPERTIES"}, {-36, "CL_INVALID_COMMAND_QUEUE"},
      {-38, "CL_INVALID_MEM_OBJECT"}, {-42, "CL_INVALID_BINARY"}, {-43, "CL_INVALID_BUILD_OPTIONS"}, {-44, "CL_INVALID_PROGRAM"},
      {-45, "CL_INVALID_PROGRAM_EXECUTABLE"}, {-46, "CL_INVALID_KERNEL_NAME"}, {-47, "CL_INVALID_KERNEL_DEFINITION"}, {-48, "CL_INVALID_KERNEL"},
      {-49, "CL_INVALID_ARG_INDEX"}, {-50, "CL_INVALID_ARG_VALUE"}, {-51, "CL_INVALID_ARG_SIZE"}, {-52, "CL_INVALID_KERNEL_ARGS"},
      {-54, "CL_INVALID_WORK_GROUP_SIZE"}, {-55, "CL_INVALID_WORK_ITEM_SIZE"}, {-57, "CL_INVALID_EVENT_WAIT_LIST"}, {-58, "CL_INVALID_EVENT"},
      {-59, "CL_INVALID_OPERATION"}, {-61, "CL_INVALID_BUFFER_SIZE"}, {-63, "CL_INVALID_GLOBAL_WORK_SIZE"}, {-1001, "CL_PLATFORM_NOT_FOUND_KHR"}};
  const auto found = names.find(code);
  return fmt::format("{} ({})", found == names.end() ? "an unknown OpenCL error" : found->second, code);
}

namespace {

// A string query that a driver may answer with a trailing zero, blanks, or an error.
template <class Query> std::string text_of(Query &&query) {
  try {
    std::string text = query();
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return text;
  } catch (const cl::Error &) {
    return "unknown";
  }
}

bool has_extension(const std::string &list, const std::string &name) { return (" " + list + " ").find(" " + name + " ") != std::string::npos; }

DeviceInfo describe(const cl::Platform &platform, const cl::Device &device) {
  DeviceInfo info;
  info.platform = text_of([&] { return platform.getInfo<CL_PLATFORM_NAME>(); });
  info.name = text_of([&] { return device.getInfo<CL_DEVICE_NAME>(); });
  info.vendor = text_of([&] { return device.getInfo<CL_DEVICE_VENDOR>(); });
  info.driver = text_of([&] { return device.getInfo<CL_DRIVER_VERSION>(); });
  info.version = text_of([&] { return device.getInfo<CL_DEVICE_VERSION>(); });
  info.c_version = text_of([&] { return device.getInfo<CL_DEVICE_OPENCL_C_VERSION>(); });
  const std::string extensions = text_of([&] { return device.getInfo<CL_DEVICE_EXTENSIONS>(); });
  const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
  info.cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
  info.gpu = (type & CL_DEVICE_TYPE_GPU) != 0 && !info.cpu;
  info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  info.memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.max_allocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  info.max_work_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  info.local_memory = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  info.native_float_width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
  info.unified_memory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() == CL_TRUE;
  info.atomics_64 = has_extension(extensions, "cl_khr_int64_base_atomics");
  info.correct_divide_sqrt = (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  if (!device.getInfo<CL_DEVICE_AVAILABLE>()) info.unusable = "the driver says it is not available";
  else if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) info.unusable = "it has no compiler";
  else if (!device.getInfo<CL_DEVICE_ENDIAN_LITTLE>()) info.unusable = "it is big-endian";
  else if (info.version.starts_with("OpenCL 1.0") || info.version.starts_with("OpenCL 1.1")) info.unusable = "it has no OpenCL 1.2";
  info.available = info.unusable.empty();
  return info;
}

struct Found {
  cl::Platform platform;
  cl::Device device;
};

// Every device in the loader's order; what a platform refuses to tell goes to `complain`.
template <class Complain> std::vector<Found> find_devices(Complain &&complain) {
  std::vector<Found> found;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error &e) {
    if (e.err() != -1001) complain("OpenCL", "clGetPlatformIDs gave " + cl_error_name(e.err()));
    return found;
  }
  for (const cl::Platform &platform : platforms) {
    try {
      std::vector<cl::Device> devices;
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
      for (const cl::Device &device : devices) found.push_back({platform, device});
    } catch (const cl::Error &e) {
      if (e.err() != CL_DEVICE_NOT_FOUND) complain(text_of([&] { return platform.getInfo<CL_PLATFORM_NAME>(); }), "its devices could not be listed: " + cl_error_name(e.err()));
    }
  }
  return found;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string listing(const std::vector<DeviceInfo> &devices) {
  std::string text;
  for (const DeviceInfo &device : devices) text += fmt::format("{}{} {}", text.empty() ? "" : "; ", device.index, device.name);
  return text;
}

}  // namespace

std::string DeviceInfo::description() const {
  return fmt::format("{}: {} ({} {}, {:.1f} GiB)", platform, name, compute_units, compute_units == 1 ? "unit" : "units", static_cast<double>(memory) / 1073741824.0);
}

std::vector<DeviceInfo> list_devices(Notices &notices) {
  static const bool probed = (leave_out_broken_drivers(notices), true);  // the loader reads its drivers once a process
  (void)probed;
  return list_devices_here(notices);
}

std::vector<DeviceInfo> list_devices_here(Notices &notices) {
  std::vector<DeviceInfo> devices;
  int index = 0;
  for (const Found &found : find_devices([&](const std::string &place, const std::string &text) { notices.warning(place, text); })) {
    try {
      devices.push_back(describe(found.platform, found.device));
      devices.back().index = index;
    } catch (const cl::Error &e) {
      notices.warning("device " + std::to_string(index), std::string("could not be described: ") + e.what() + " gave " + cl_error_name(e.err()));
    }
    index++;
  }
  return devices;
}

cl::Device device_at(int index) {
  const std::vector<Found> found = find_devices([](const std::string &, const std::string &) {});
  if (index < 0 || static_cast<std::size_t>(index) >= found.size()) throw Error("device " + std::to_string(index), "is gone");
  return found[static_cast<std::size_t>(index)].device;
}

DeviceInfo choose_device(const std::vector<DeviceInfo> &devices, const std::string &selector) {
  std::vector<DeviceInfo> usable;
  std::ranges::copy_if(devices, std::back_inserter(usable), [](const DeviceInfo &d) { return d.available; });
  if (usable.empty()) {
    std::string reasons;
    for (const DeviceInfo &d : devices) reasons += "; " + d.name + ": " + d.unusable;
    throw Error("", "no OpenCL device was found" + reasons,
                "for the CPU install pocl-opencl-icd; for a GPU its vendor's driver, or mesa-opencl-icd with RUSTICL_ENABLE set; `sunstone devices` lists what is seen");
  }
  // Units of the vectors that they work on: rusticl's CPU device counts more units than there are cores, each a quarter as wide.
  const auto most_units = [&](auto &&wanted) -> const DeviceInfo * {
    const DeviceInfo *best = nullptr;
    const auto width = [](const DeviceInfo &d) { return d.compute_units * d.native_float_width; };
    for (const DeviceInfo &d : usable)
      if (wanted(d) && (!best || width(d) > width(*best))) best = &d;
    return best;
  };
  const std::string want = lower(selector);
  const auto first_gpu = std::ranges::find_if(usable, &DeviceInfo::gpu);
  if (want.empty()) {
    if (first_gpu != usable.end()) return *first_gpu;
    // An interpreter such as Oclgrind says that it is everything: a plain CPU goes before it.
    if (const DeviceInfo *best = most_units([](const DeviceInfo &d) { return d.cpu && d.vendor != "University of Bristol"; })) return *best;
    return usable.front();
  }
  if (want == "gpu" && first_gpu != usable.end()) return *first_gpu;
  if (want == "cpu")
    if (const DeviceInfo *best = most_units([](const DeviceInfo &d) { return d.cpu; })) return *best;
  if (std::ranges::all_of(want, [](unsigned char c) { return std::isdigit(c); }) && want.size() < 6)
    for (const DeviceInfo &d : usable)
      if (d.index == std::stoi(want)) return d;
  for (const DeviceInfo &d : usable)
    if (lower(d.name).find(want) != std::string::npos || lower(d.platform).find(want) != std::string::npos) return d;
  throw UsageError("--device " + printable(selector), "no such device; there are: " + listing(usable));
}

Device::Device(const DeviceInfo &info, const DeviceOptions &options) : state_(std::make_shared<State>()) {
  state_->info = info;
  state_->options = options;
  guarded(info.name, [&] {
    state_->device = device_at(info.index);
    if (options.threads > 0 && options.threads < info.compute_units && info.cpu) {
      const cl_device_partition_property by_counts[] = {CL_DEVICE_PARTITION_BY_COUNTS, static_cast<cl_device_partition_property>(options.threads),
                                                        CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
      std::vector<cl::Device> parts;
      state_->device.createSubDevices(by_counts, &parts);
      state_->device = parts.at(0);
      state_->info.compute_units = options.threads;
    }
    state_->context = cl::Context(state_->device);
    state_->queue = cl::CommandQueue(state_->context, state_->device, options.profile ? CL_QUEUE_PROFILING_ENABLE : 0);
  });
}

const DeviceInfo &Device::info() const { return state_->info; }
const DeviceOptions &Device::options() const { return state_->options; }
std::size_t Device::allocated() const { return *state_->allocated; }

Device Device::beside() const {
  Device other;
  other.state_ = std::make_shared<State>();
  other.state_->info = state_->info;
  other.state_->options = state_->options;
  other.state_->device = state_->device;
  other.state_->context = state_->context;
  other.state_->allocated = state_->allocated;
  guarded(state_->info.name, [&] { other.state_->queue = cl::CommandQueue(state_->context, state_->device, state_->options.profile ? CL_QUEUE_PROFILING_ENABLE : 0); });
  return other;
}

void Device::flush() const {
  guarded(state_->info.name, [&] { return state_->queue.flush(); });
}
void Device::finish() const {
  guarded(state_->info.name, [&] { return state_->queue.finish(); });
}

void Device::State::sum_up() {
  guarded(info.name, [&] { return queue.finish(); });
  for (const Launch &launch : launches) {
    StageTime &time = times[launch.kernel];
    time.kernel = launch.kernel;
    time.launches++;
    time.items += launch.items;
    guarded("kernel " + launch.kernel, [&] {
      const cl_ulong start = launch.event.getProfilingInfo<CL_PROFILING_COMMAND_START>(), end = launch.event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
      if (end > start) time.seconds += static_cast<double>(end - start) * 1e-9;
    });
  }
  launches.clear();
}

std::vector<StageTime> Device::take_times() const {
  state_->sum_up();
  std::vector<StageTime> times;
  for (const auto &[name, time] : state_->times) times.push_back(time);
  state_->times.clear();
  return times;
}

}  // namespace sunstone
