// SPDX-License-Identifier: Apache-2.0
// sunstone devices: what there is to render on.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/commands.h"
#include "device/device.h"
#include "device/selftest.h"
#include "pipeline/stages.h"

namespace sunstone {

namespace {

std::string reproducible(const DeviceInfo &info) {
  if (!info.available) return "unknown: " + info.unusable;
  try {
    const SelfTestResult result = cached_self_test(Device(info, {}));
    return result.reproducible ? "yes" : "no: " + result.differs + " differs";
  } catch (const Error &error) {
    return std::string("unknown: ") + error.what();
  }
}

void list(bool json, bool test, Notices &notices) {
  const std::vector<DeviceInfo> devices = list_devices(notices);
  if (devices.empty()) choose_device(devices, "");  // throws, and says what to install
  const int chosen = choose_device(devices, "").index;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const DeviceInfo &d : devices) {
    const std::string verdict = test ? reproducible(d) : "not tested";
    const char *type = d.gpu ? "GPU" : d.cpu ? "CPU" : "other";
    const Variant variant = device_variant(d);
    if (json) {
      all.push_back({{"index", d.index}, {"name", d.name}, {"platform", d.platform}, {"vendor", d.vendor}, {"driver", d.driver}, {"version", d.version}, {"c_version", d.c_version},
                     {"type", type}, {"compute_units", d.compute_units}, {"memory", d.memory}, {"max_allocation", d.max_allocation}, {"max_work_group", d.max_work_group},
                     {"local_memory", d.local_memory}, {"native_float_width", d.native_float_width}, {"int64_atomics", d.atomics_64},
                     {"correctly_rounded_divide_sqrt", d.correct_divide_sqrt}, {"usable", d.available}, {"reproducible", verdict}, {"default", d.index == chosen}});
      continue;
    }
    fmt::print("{}{} {}\n", d.index == chosen ? "*" : " ", d.index, d.name);
    fmt::print("     {}, {}, driver {}\n", d.platform, d.version, d.driver);
    fmt::print("     {}, {} units, {:.1f} GiB memory, {:.1f} GiB in one piece, work-groups to {}\n", type, d.compute_units, static_cast<double>(d.memory) / 1073741824.0,
               static_cast<double>(d.max_allocation) / 1073741824.0, d.max_work_group);
    fmt::print("     uses: {} atomics, lanes {}, layout {}{}\n", d.atomics_64 ? "64-bit (cl_khr_int64_base_atomics)" : "pairs of 32-bit", variant.lanes, layout_name(variant.layout),
               d.correct_divide_sqrt ? ", correctly rounded divide and sqrt" : "");
    fmt::print("     reproducible: {}\n", verdict);
  }
  if (json) fmt::print("{}\n", all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

void add_devices(CLI::App &app, CommandContext &context) {
  struct Options {
    bool json = false, no_test = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App *command = app.add_subcommand("devices", "List OpenCL devices, and whether each gives the same bits");
  command->add_flag("--json", options->json, "Print JSON");
  command->add_flag("--no-test", options->no_test, "Leave out the self-test");
  command->footer("The device that render takes by itself has a star.\n\nExamples:\n  sunstone devices\n  sunstone devices --json");
  command->callback([options, &context] { list(options->json, !options->no_test, context.notices); });
}

}  // namespace sunstone
