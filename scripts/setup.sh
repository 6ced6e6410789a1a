#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what sunstone is built from with Debian's packages (Debian 12); does nothing where all of it is there.
#   scripts/setup.sh [build]   compiler, libraries, GoogleTest, and PoCL, the OpenCL device of a machine without a GPU
#   scripts/setup.sh test      these, and what `make test` runs on: clang's OpenCL front end and more OpenCL implementations
#   scripts/setup.sh devices   these, and what `make test-devices` fetches Intel's runtime with
set -euo pipefail

mode=${1:-build}
packages=(
  g++ make cmake ninja-build ccache
  ocl-icd-opencl-dev opencl-clhpp-headers opencl-headers pocl-opencl-icd   # the loader, CL/opencl.hpp, a device
  libopenimageio-dev                                                       # pictures
  libtinyobjloader-dev nlohmann-json3-dev                                  # scenes
  libembree-dev libtbb-dev                                                 # trees
  libglm-dev libfmt-dev libcli11-dev libxxhash-dev libgtest-dev)
case $mode in
  build) ;;
  test | devices) packages+=(clang oclgrind mesa-opencl-icd clinfo python3) ;;
  *)
    echo "usage: $0 [build|test|devices]" >&2
    exit 2
    ;;
esac
if [ "$mode" = devices ]; then packages+=(python3-venv); fi

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  cat >&2 <<'TEXT'
setup: this system has no apt-get, so nothing is installed. From your distribution install:
  a C++20 compiler (GCC 12 or Clang 15 on), CMake 3.25, Ninja
  an OpenCL ICD loader with headers and CL/opencl.hpp, and a device: PoCL, or your GPU's driver
  OpenImageIO 2.4, Embree 3.13 (not 4), oneTBB, tinyobjloader 2, nlohmann-json 3.11, GLM, fmt, CLI11 2, xxHash
  for tests: GoogleTest; where they can be had: Python 3, clang, Oclgrind, Mesa's rusticl
CMake names whatever it does not find. If all is there, go on with: cmake --preset release
TEXT
  # Whoever has installed them may go on; CMake checks each library.
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  if [ "$status" != installed ]; then missing+=("$package"); fi
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "setup: all ${#packages[@]} packages for '$mode' are there"
  exit 0
fi

root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: to be installed by root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  root=(sudo)
fi
echo "setup: installing ${missing[*]}"
install=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}")
# The lists that are there often do; where they are absent or old, fetch them once.
if ! "${install[@]}" >/dev/null 2>&1; then
  "${root[@]}" apt-get update -qq
  "${install[@]}"
fi
echo "setup: done"
