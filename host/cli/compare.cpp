// SPDX-License-Identifier: Apache-2.0
// sunstone compare A B: how far two pictures are apart, and whether that is near enough.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/number.h"
#include "cli/commands.h"
#include "content/content.h"

namespace sunstone {

namespace {

struct Metric {
  const char *name;
  double (*value)(const Comparison &);
  bool more_is_nearer = false;
};

constexpr Metric metrics[] = {{"rmse", [](const Comparison &c) { return c.rmse; }},
                              {"relmse", [](const Comparison &c) { return c.relmse; }},
                              {"psnr", [](const Comparison &c) { return c.psnr; }, true},
                              {"flip", [](const Comparison &c) { return c.flip; }},
                              {"largest", [](const Comparison &c) { return c.largest; }},
                              {"bad", [](const Comparison &c) { return static_cast<double>(c.bad_pixels); }}};

struct Tolerance {
  const Metric *metric;
  double limit;
  bool holds(const Comparison &c) const { return metric->more_is_nearer ? metric->value(c) >= limit : metric->value(c) <= limit; }
};

Tolerance parse_tolerance(const std::string &text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto metric = std::find_if(std::begin(metrics), std::end(metrics), [&](const Metric &m) { return name == m.name; });
  std::string known;
  for (const Metric &m : metrics) known += (known.empty() ? "" : " ") + std::string(m.name);
  if (equals == std::string::npos || metric == std::end(metrics))
    throw UsageError("--tolerance " + printable(text), "is not METRIC=NUMBER", "the metrics are " + known);
  const std::optional<double> limit = read_number<double>(std::string_view(text).substr(equals + 1));
  if (!limit || std::isnan(*limit)) throw UsageError("--tolerance " + printable(text), "has no number behind the =");
  return {metric, *limit};
}

struct Options {
  std::string image, reference;
  std::vector<std::string> tolerances;
  bool json = false;
};

// JSON has no infinity: a PSNR of equal pictures is null.
nlohmann::json number(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); }

void print_json(const Options &options, const Image &image, const Comparison &c, const std::vector<std::string> &beyond) {
  nlohmann::ordered_json result;
  result["image"] = options.image;
  result["reference"] = options.reference;
  result["size"] = {image.width, image.height};
  for (const Metric &metric : metrics)
    if (std::string(metric.name) != "bad") result[metric.name] = number(metric.value(c));
  result["largest_at"] = {c.largest_x, c.largest_y};
  result["bad_pixels"] = c.bad_pixels;
  result["within_tolerance"] = beyond.empty();
  result["beyond"] = beyond;
  std::printf("%s\n", result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_text(const Comparison &c, const std::vector<std::string> &beyond) {
  std::printf("rmse     %.6g\nrelmse   %.6g\npsnr     %.4f dB\nflip     %.6f\nlargest  %.6g at %d,%d\n", c.rmse, c.relmse, c.psnr, c.flip, c.largest,
              c.largest_x, c.largest_y);
  if (c.bad_pixels) std::printf("bad      %zu pixels are not finite\n", c.bad_pixels);
  for (const std::string &text : beyond) std::printf("beyond tolerance: %s\n", text.c_str());
}

void compare(const Options &options, CommandContext &context) {
  std::vector<Tolerance> tolerances;
  for (const std::string &text : options.tolerances) tolerances.push_back(parse_tolerance(text));
  // Who sets a limit wants to hear of pixels that no limit can measure.
  const bool bad_is_given =
      std::any_of(tolerances.begin(), tolerances.end(), [](const Tolerance &t) { return std::string(t.metric->name) == "bad"; });
  if (!tolerances.empty() && !bad_is_given) tolerances.push_back(parse_tolerance("bad=0"));

  const Content &content = load_content();
  const Image image = content.read_picture(options.image), reference = content.read_picture(options.reference);
  const Comparison comparison = content.compare_images(image, reference);
  std::vector<std::string> beyond;
  for (const Tolerance &tolerance : tolerances) {
    if (tolerance.holds(comparison)) continue;
    char text[120];
    std::snprintf(text, sizeof text, "%s %.6g, limit %.6g", tolerance.metric->name, tolerance.metric->value(comparison), tolerance.limit);
    beyond.push_back(text);
  }
  if (options.json)
    print_json(options, image, comparison, beyond);
  else
    print_text(comparison, beyond);
  if (!beyond.empty()) context.exit_status = 1;
}

}  // namespace

void add_compare(CLI::App &app, CommandContext &context) {
  auto options = std::make_shared<Options>();
  CLI::App *command =
      app.add_subcommand("compare", "Measure how far a picture is from a reference: RMSE, relMSE, PSNR, FLIP, the largest difference");
  command->add_option("image", options->image, "The picture")->required()->type_name("PICTURE");
  command->add_option("reference", options->reference, "What it should be, of the same size")->required()->type_name("PICTURE");
  command
      ->add_option("--tolerance", options->tolerances,
                   "Exit with 1 where a metric is beyond X: rmse relmse flip largest bad at most, psnr at least. May be given again; pixels that are "
                   "not finite are beyond any")
      ->type_name("METRIC=X")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_flag("--json", options->json, "Print JSON");
  command->footer(
      "Pictures are .exr .hdr (linear), .png .jpg .bmp .tga .webp (decoded from sRGB) or .film. Everything is measured in linear light, on RGB.\n"
      "FLIP and PSNR take 1 as white: FLIP sees what a screen shows at exposure 0.\n\n"
      "Examples:\n"
      "  sunstone compare a.exr reference.exr\n"
      "  sunstone compare a.png b.png --tolerance flip=0.05 --tolerance psnr=35\n"
      "  sunstone compare a.film b.film --json");
  command->callback([options, &context] { compare(*options, context); });
}

}  // namespace sunstone
