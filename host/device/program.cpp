// SPDX-License-Identifier: Apache-2.0
#include "device/program.h"

#include "base/cache.h"
#include "base/hash.h"
#include "device/source.h"
#include "device/state.h"

namespace sunstone {

namespace {

std::string build_options(const DeviceInfo &info, const Switches &switches) {
  std::string options = "-cl-std=CL1.2";
  // Asked for where the device says it can; devices that do not are held to the same bits by the self-test.
  if (info.correct_divide_sqrt) options += " -cl-fp32-correctly-rounded-divide-sqrt";
  options += " -DSUN_ATOMICS_64=" + std::to_string(info.atomics_64 ? 1 : 0);
  for (const auto &[name, value] : switches) options += " -D" + name + "=" + std::to_string(value);
  return options;
}

// PoCL keeps its own cache, and asking it for binaries makes it compile a second, generic version.
bool caches_by_itself(const DeviceInfo &info) { return info.platform.find("Portable Computing Language") != std::string::npos; }

std::string build_log(const cl::Program &program, const cl::Device &device) {
  try {
    std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    if (log.size() > 8000) log = log.substr(0, 8000) + "\n...";
    return log;
  } catch (const cl::Error &) {
    return "(no build log)";
  }
}

cl::Program build(const Device::State &device, const std::string &name, const std::string &source, const std::string &options) {
  cl::Program program = guarded(name, [&] { return cl::Program(device.context, source); });
  try {
    program.build(std::vector<cl::Device>{device.device}, options.c_str());
  } catch (const cl::Error &e) {
    throw Error(device.info.name + ": " + name, "does not compile: " + cl_error_name(e.err()) + "\n" + build_log(program, device.device));
  }
  return program;
}

// A cached binary that the driver accepts, or nothing.
std::optional<cl::Program> build_cached(const Device::State &device, std::span<const std::byte> binary, const std::string &options) {
  try {
    const auto *bytes = reinterpret_cast<const unsigned char *>(binary.data());
    cl::Program program(device.context, {device.device}, cl::Program::Binaries{std::vector<unsigned char>(bytes, bytes + binary.size())});
    program.build(std::vector<cl::Device>{device.device}, options.c_str());
    return program;
  } catch (const cl::Error &) {
    return std::nullopt;
  }
}

}  // namespace

Program::Program(const Device &device, const std::string &file, const Switches &switches)
    : Program(from_text(device, file, std::string(embedded_source(file)), switches)) {}

Program Program::from_text(const Device &device, const std::string &name, const std::string &text, const Switches &switches) {
  Program result;
  result.state_ = std::make_shared<State>(State{device, {}, name});
  const Device::State &owner = device.state();
  const std::string source = resolve_includes(text, name), options = build_options(owner.info, switches);
  if (caches_by_itself(owner.info)) {
    result.state_->program = build(owner, name, source, options);
    return result;
  }
  Hasher hasher;
  for (const std::string &part : {source, options, owner.info.platform, owner.info.name, owner.info.driver, owner.info.version}) hasher.add(part);
  const Hash key = hasher.digest();
  if (const auto binary = cache_read("program", key))
    if (auto program = build_cached(owner, *binary, options)) {
      result.state_->program = std::move(*program);
      return result;
    }
  result.state_->program = build(owner, name, source, options);
  try {
    const auto binaries = result.state_->program.getInfo<CL_PROGRAM_BINARIES>();
    if (!binaries.empty() && !binaries[0].empty()) cache_write("program", key, std::as_bytes(std::span(binaries[0])));
  } catch (const cl::Error &) {
    // A driver that gives no binaries compiles at every start.
  }
  return result;
}

}  // namespace sunstone
