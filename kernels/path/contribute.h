// SPDX-License-Identifier: Apache-2.0
// A contribution of one path to the layers of light: the half of the beauty that its sample belongs to, and its bounce.
#ifndef SUN_PATH_CONTRIBUTE_H
#define SUN_PATH_CONTRIBUTE_H
#include "path/film.h"
#include "path/path.h"
#include "shared/frame.h"

SUN_NAMESPACE_BEGIN

// `counts` has room for twice SUN_COUNT_WORDS: what a second layer of the same contribution clamps or drops is counted in the spare half.
SUN_FN FilmView open_film(const SUN_GLOBAL Frame *frame, FilmWords words, FilmCounts counts) {
  FilmView film;
  film.words = words;
  film.pixels = frame->tile_width * frame->tile_height;
  film.counts = counts;
  return film;
}

// By the pixel's place in the whole picture, so tiles and crops don't matter.
SUN_FN uint film_pixel_hash(const SUN_GLOBAL Frame *frame, uint pixel) {
  uint y = pixel / frame->tile_width;
  return hash3_1(frame->seed, pixel - y * frame->tile_width + frame->tile_x0, y + frame->tile_y0);
}

SUN_FN void film_contribute(const SUN_GLOBAL Frame *frame, const FilmView *film, uint pixel, uint sample, uint key, uint depth, float r, float g, float b) {
  uint hash = film_pixel_hash(frame, pixel);
  film_add(film, sample & 1 ? SUN_LAYER_ODD : SUN_LAYER_EVEN, pixel, hash, sample, key, r, g, b);
  if (frame->layer_bounce == SUN_NONE || depth >= frame->bounce_layers) return;
  FilmView spare = *film;
  spare.counts += SUN_COUNT_WORDS;
  film_add(&spare, frame->layer_bounce + depth, pixel, hash, sample, key, r, g, b);
}

// The same for the lanes in `on`.
SUN_FN void film_contribute_keyed(const SUN_GLOBAL Frame *frame, const FilmView *film, mask on, const Path *path, uint_n key, uint_n depth, vec3 rgb) {
  int ons[LANES];
  uint pixel[LANES], sample[LANES], keys[LANES], depths[LANES];
  float r[LANES], g[LANES], b[LANES];
  LANES_STORE(on, ons);
  LANES_STORE(path->pixel, pixel);
  LANES_STORE(path->sample, sample);
  LANES_STORE(key, keys);
  LANES_STORE(depth, depths);
  LANES_STORE(rgb.x, r);
  LANES_STORE(rgb.y, g);
  LANES_STORE(rgb.z, b);
  for (int lane = 0; lane < LANES; lane++)
    if (ons[lane]) film_contribute(frame, film, pixel[lane], sample[lane], keys[lane], depths[lane], r[lane], g[lane], b[lane]);
}

// Light that reached the path's last vertex along its ray.
SUN_FN void film_contribute_lanes(const SUN_GLOBAL Frame *frame, const FilmView *film, mask on, const Path *path, uint_n depth, vec3 rgb) {
  film_contribute_keyed(frame, film, on, path, SUN_FILM_KEY_EMISSION(path->vertex), depth, rgb);
}

SUN_NAMESPACE_END
#endif
