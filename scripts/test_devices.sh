#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the render tests on Intel's OpenCL runtime for CPUs (AMD's too), a second implementation with a compiler of its own.
# It comes from PyPI into build/devices and touches nothing else; scripts/test_devices.sh [BUILD FOLDER], default build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$(realpath "${1:-build/release}")
devices=$PWD/build/devices
intel='Intel(R) OpenCL'  # the platform's name: "Intel" alone is also in PoCL's name of an Intel CPU

mkdir -p "$devices/vendors"
if [ ! -e "$devices/venv/lib/libintelocl.so" ] || [ ! -e "$devices/venv/lib/libsvml.so" ]; then
  python3 -m venv "$devices/venv"
  # The second package is a dependency that the first one does not name.
  "$devices/venv/bin/pip" install --quiet --disable-pip-version-check intel-opencl-rt intel-cmplr-lib-rt
fi
"$devices/venv/bin/pip" list --disable-pip-version-check 2>/dev/null | grep -i '^intel' || true

# The wheel's own .icd file holds a placeholder for a path. PoCL stays in the list, for comparison.
echo "$devices/venv/lib/libintelocl.so" >"$devices/vendors/intel.icd"
cp /etc/OpenCL/vendors/pocl.icd "$devices/vendors/"
export OCL_ICD_VENDORS=$devices/vendors/  # ocl-icd wants the slash at the end
"$build/bin/sunstone" devices

# One picture on both, in a process as a user starts it.
scene=scenes/cornell/cornell.gltf
for device in "$intel" 'Portable Computing Language'; do
  "$build/bin/sunstone" render "$scene" --size 64x64 --spp 16 -q --device "$device" -o "$devices/cornell.film" --stats "$devices/cornell.json"
  hash=$(sed -n 's/.*"film_hash": "\([0-9a-f]*\)".*/\1/p' "$devices/cornell.json")
  echo "$hash  $device"
  if [ "${first:=$hash}" != "$hash" ] || [ -z "$hash" ]; then
    echo "test-devices: the two differ" >&2
    exit 1
  fi
done

# Test programs link Debian's TBB, which must not come into a process before Intel's newer one: its platform would vanish without a word.
export LD_PRELOAD=$devices/venv/lib/libtbb.so.12
SUNSTONE_TEST_DEVICE=$intel ctest --test-dir "$build" --no-tests=error --output-on-failure -j 2 -L '^(render|kernel)$'
