// SPDX-License-Identifier: Apache-2.0
// sunstone merge: films that were rendered apart become one, as if it had been rendered at once.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "cli/commands.h"
#include "content/content.h"
#include "film/film_file.h"

namespace sunstone {

namespace {

struct Options {
  std::vector<std::string> films, outputs;
  ViewOptions view;
  bool transparent = false, json = false;
};

struct Part {
  std::string name;
  std::vector<SampleRange> samples;
};

// Which of the films added so far holds one of these samples, to name it: the sum no longer knows.
void check_overlap(const std::vector<Part> &parts, const Film &film) {
  for (const Part &part : parts) {
    std::vector<SampleRange> samples = part.samples;
    for (const SampleRange &range : film.samples) {
      try {
        insert_samples(samples, range);
      } catch (const Error &error) {
        throw Error(printable(film.name), error.reason + " in " + printable(part.name), "each sample may be added once");
      }
    }
  }
}

Film sum_of(const std::vector<std::string> &names) {
  Film sum;
  std::vector<Part> parts;
  for (const std::string &name : names) {
    Film film = read_film(name);
    // A film of another scene or setting is refused by add_film, for that reason, whichever samples it holds.
    if (!parts.empty() && film_difference(sum, film).empty()) check_overlap(parts, film);
    parts.push_back({film.name, film.samples});
    if (parts.size() == 1)
      sum = std::move(film);
    else
      add_film(sum, film);
  }
  return sum;
}

void merge(Options &options) {
  options.view.transparent_background = options.transparent;
  for (const std::string &name : options.outputs) {
    check_picture_name(name);
    check_writable(name);
  }
  const Film film = sum_of(options.films);
  for (const std::string &name : options.outputs) {
    if (name.ends_with(".film"))
      write_film(name, film);  // needs no library of pictures
    else
      load_content().write_picture(name, film, options.view);
  }
  if (options.json) {
    nlohmann::ordered_json result;
    result["films"] = options.films;
    result["samples"] = show_samples(film.samples);
    result["samples_per_pixel"] = film.sample_count();
    result["film_hash"] = film_hash(film).hex();
    result["files"] = options.outputs;
    std::printf("%s\n", result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    return;
  }
  std::printf("%zu film%s, samples %s (%llu per pixel), film hash %s\n", options.films.size(), options.films.size() == 1 ? "" : "s",
              show_samples(film.samples).c_str(), static_cast<unsigned long long>(film.sample_count()), film_hash(film).hex().c_str());
  for (const std::string &name : options.outputs) std::printf("%s\n", printable(name, 400).c_str());
}

}  // namespace

void add_merge(CLI::App &app, CommandContext &) {
  auto options = std::make_shared<Options>();
  CLI::App *command = app.add_subcommand("merge", "Add films of one scene that hold different samples, and write the picture");
  command->add_option("films", options->films, "The films, in any order")->required()->type_name("FILM");
  command->add_option("-o,--output", options->outputs, "Write this: .film, .exr, or a view. May be given again")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_view_options(*command, options->view);
  command->add_flag("--transparent", options->transparent, "PNG and TIFF with alpha, from films rendered with --background transparent");
  command->add_flag("--json", options->json, "Print JSON");
  command->footer(
      "Films of another scene, another setting or with samples in common are refused.\n\n"
      "Examples:\n"
      "  sunstone merge monday.film tuesday.film -o both.film\n"
      "  sunstone merge part-*.film -o picture.exr -o picture.png --tone filmic");
  command->callback([options] { merge(*options); });
}

}  // namespace sunstone
