#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A machine without OpenCL, with a platform that has no device, and with drivers that are broken beside one that works.
. "$(dirname "$0")/common.sh"
scene=$root/scenes/cornell/cornell.gltf

expect_none() {
  local status=0
  "$sunstone" render "$scene" -o none.png >none.txt 2>&1 || status=$?
  [ $status -eq 1 ] || fail "$1: exit status $status, not 1"
  grep -q '^sunstone: error: .*no OpenCL device' none.txt || fail "$1: $(cat none.txt)"
  grep -q 'pocl-opencl-icd' none.txt || fail "$1: the message names no package: $(cat none.txt)"
  [ ! -e none.png ] || fail "$1: a picture was written"
}

mkdir vendors
export OCL_ICD_VENDORS=$work/vendors/
expect_none "no platform"
if [ -e /etc/OpenCL/vendors/rusticl.icd ]; then
  cp /etc/OpenCL/vendors/rusticl.icd vendors/
  unset RUSTICL_ENABLE
  expect_none "a platform without a device"
  rm vendors/rusticl.icd
fi

[ -e /etc/OpenCL/vendors/pocl.icd ] || skip "PoCL is not installed (pocl-opencl-icd)"
echo "$work/there-is-no-such-driver.so" >vendors/a-missing.icd
echo libm.so.6 >vendors/b-no-driver.icd
cp /etc/OpenCL/vendors/pocl.icd vendors/z-pocl.icd
"$sunstone" devices --no-test >found.txt
grep -q 'Portable Computing Language' found.txt || fail "PoCL was not found beside broken drivers: $(cat found.txt)"
