#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A driver that crashes while it is probed is left out and named; the one beside it works, and a healthy machine pays for no second look.
# The fifth argument is crashing_driver, built as a library.
. "$(dirname "$0")/common.sh"
[ -e /etc/OpenCL/vendors/pocl.icd ] || skip "PoCL is not installed (pocl-opencl-icd)"
mkdir vendors
echo "$5" >vendors/a-crash.icd
cp /etc/OpenCL/vendors/pocl.icd vendors/z-pocl.icd
export OCL_ICD_VENDORS=$work/vendors/
"$sunstone" devices --no-test >found.txt 2>notices.txt || fail "exit status $?: $(cat notices.txt)"
grep -q 'Portable Computing Language' found.txt || fail "PoCL was not found beside a driver that crashes: $(cat found.txt)"
grep -q '^sunstone: warning: .*a-crash.icd: .*crashes' notices.txt || fail "the driver is not named: $(cat notices.txt)"
rm vendors/z-pocl.icd
status=0
"$sunstone" devices --no-test >none.txt 2>&1 || status=$?
[ $status -eq 1 ] || fail "with that driver alone: exit status $status, not 1"
grep -q '^sunstone: error: .*no OpenCL device' none.txt || fail "with that driver alone: $(cat none.txt)"
rm vendors/a-crash.icd
cp /etc/OpenCL/vendors/pocl.icd vendors/
"$sunstone" devices --no-test >/dev/null 2>notices.txt
[ ! -s notices.txt ] || fail "a healthy driver got a notice: $(cat notices.txt)"
ls "$SUNSTONE_CACHE"/drivers-*.cache >/dev/null || fail "the verdict was not remembered"
