#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every kernel under Oclgrind, which interprets it and watches each load and store: no report, and one film with PoCL's.
# The fourth argument is fill_by_write, built as a library.
. "$(dirname "$0")/common.sh"
fill=$4
command -v oclgrind >/dev/null || skip "oclgrind is not installed"

# Oclgrind 21.10 lacks two things that clang makes of our code: llvm.bitreverse when it optimises, and what marks an inlined struct result.
interpret() {  # name, render's flags
  local name=$1
  shift
  reference "$@"
  # shellcheck disable=SC2016
  oclgrind --build-options "-O0 -Dalways_inline=unused" --data-races --uninitialized --check-api --log "$work/$name.txt" \
    sh -c 'LD_PRELOAD=$0:$LD_PRELOAD exec "$@"' "$fill" \
    "$sunstone" render "$@" -q --device Oclgrind --lanes 1 --layout binary -o oclgrind.film --stats oclgrind.json || { cat "$name.txt"; fail "the render of $name"; }
  if [ -s "$name.txt" ]; then
    head -100 "$name.txt"
    fail "Oclgrind has something to report of $name"
  fi
  same_film "Oclgrind, $name" oclgrind.json
}

interpret path "$root/scenes/first-picture/first-picture.glb" --size 8x8 --spp 1 --max-depth 2 --aov all
interpret branching "$root/scenes/cornell/cornell.gltf" --size 8x8 --spp 1 --max-depth 2 --integrator hybrid --indirect-samples 2 --absorption 0.25
interpret bdpt "$root/scenes/first-picture/first-picture.glb" --integrator bdpt --size 8x8 --spp 1 --max-depth 2 --aov all
interpret shapes "$root/scenes/whitted/whitted.gltf" --size 8x8 --spp 1 --max-depth 2 --env 0.3,0.5,0.8
interpret whitted "$root/scenes/whitted/whitted.gltf" --size 8x8 --spp 1 --max-depth 3 --integrator whitted --env 0.3,0.5,0.8 --ambient 0.1,0.1,0.1
