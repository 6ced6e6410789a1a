// SPDX-License-Identifier: Apache-2.0
#include "cli/stats.h"

#include <nlohmann/json.hpp>

namespace sunstone {

std::string render_stats(const Session &session, const Film &film, const RenderTimes &times) {
  const RenderCounts &counts = session.renderer->counts();
  const double seconds = times.render > 0 ? times.render : 1e-9;
  nlohmann::ordered_json j;
  j["samples_per_pixel"] = film.sample_count();
  j["render_seconds"] = times.render;
  j["startup_seconds"] = times.startup;
  j["samples_per_s"] = static_cast<double>(counts.paths) / seconds;
  j["rays_per_s"] = {{"camera", static_cast<double>(counts.camera_rays) / seconds},
                     {"bounce", static_cast<double>(counts.bounce_rays) / seconds},
                     {"shadow", static_cast<double>(counts.shadow_rays) / seconds}};
  j["stages"] = nlohmann::ordered_json::array();
  for (const StageTime &time : session.device.take_times())
    j["stages"].push_back({{"stage", time.kernel}, {"launches", time.launches}, {"items", time.items}, {"seconds", time.seconds}});
  std::vector<std::uint64_t> live = rays_by_depth(counts);
  while (live.size() > 1 && live.back() == 0) live.pop_back();
  j["live_paths_by_bounce"] = live;
  j["ended"] = {{"light", counts.ended[SUN_ENDED_LIGHT]},
                {"depth", counts.ended[SUN_ENDED_DEPTH]},
                {"escaped", counts.ended[SUN_ENDED_ESCAPED]},
                {"absorbed", counts.ended[SUN_ENDED_ABSORBED]}};
  j["paths"] = counts.paths;
  j["import_seconds"] = session.loaded.import_seconds;
  j["build_seconds"] = session.loaded.build_seconds;
  j["compile_seconds"] = session.compile_seconds;
  j["upload_seconds"] = session.upload_seconds;
  j["memory"] = {{"scene_bytes", session.renderer->scene_bytes()},
                 {"pool_bytes", session.renderer->pool_bytes()},
                 {"light_map_bytes", session.renderer->light_map_bytes()},
                 {"film_bytes", session.renderer->film_bytes()},
                 {"device_bytes", session.device.allocated()}};
  j["clamped"] = film.clamped;
  j["nan"] = film.nan;
  j["scene_hash"] = film.scene_hash;
  j["film_hash"] = film_hash(film).hex();
  for (const FilmLayer &layer : film.layers) j["layer_hashes"][layer.name] = layer_hash(film, layer).hex();
  j["device"] = session.device.info().description();
  j["reproducible"] = times.reproducible;
  j["interrupted"] = film.interrupted;
  j["variant"] = {{"lanes", session.variant.lanes}, {"layout", layout_name(session.variant.layout)}, {"pool", session.renderer->pool_slots()}};
  return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace sunstone
