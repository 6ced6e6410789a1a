#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What `make test` runs, once the packages are there: the readers of files under sanitizers, then the whole suite. Fails if either does.
set -uo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

# Folders of tests whose code reads files that others made. No OpenCL driver is loaded there.
readers=(tests/host/film tests/host/image tests/host/import)

cmake --preset release && cmake --build --preset release || exit 1
cmake --preset asan && cmake --build --preset asan --target "${readers[@]/%//all}" || exit 1

failed=()
for folder in "${readers[@]}"; do
  echo "== under the address and undefined-behaviour sanitizers: $folder"
  ctest --test-dir "build/asan/$folder" --no-tests=error --output-on-failure -j "$jobs" || failed+=("$folder")
done

echo "== all tests"
ctest --preset release -j "$jobs" | tee build/release/ctest.txt
status=${PIPESTATUS[0]}

# Scenes outside the repository and OpenCL implementations that this machine lacks leave cases out: say how many, then how it ended.
skipped=$(grep -acE '^\[  SKIPPED \] .* ms\)$' build/release/Testing/Temporary/LastTest.log)
echo
echo "left out: $skipped cases within tests$([ "$skipped" -eq 0 ] || echo '; their reasons: grep -aB3 SKIPPED build/release/Testing/Temporary/LastTest.log')"
if [ ${#failed[@]} -gt 0 ]; then
  echo "FAILED under the sanitizers: ${failed[*]}"
  status=1
fi
grep -a 'tests passed' build/release/ctest.txt
exit "$status"
