#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Mesa's rusticl on the CPU: no 64-bit atomics, another compiler. One film with PoCL's.
. "$(dirname "$0")/common.sh"
flags=("$root/scenes/first-picture/first-picture.glb" --size 16x16 --spp 1 --max-depth 3)
reference "${flags[@]}"
export RUSTICL_ENABLE=swrast
"$sunstone" devices --no-test 2>/dev/null | grep -q '^     rusticl,' || skip "rusticl is not installed (mesa-opencl-icd)"
# Its warnings of load_kernel_arg in control flow are about its own way to load arguments.
"$sunstone" render "${flags[@]}" -q --device rusticl --lanes 1 -o rusticl.film --stats rusticl.json 2>messages.txt || { cat messages.txt; fail "the render"; }
sort messages.txt | uniq -c | head -20
same_film rusticl rusticl.json
