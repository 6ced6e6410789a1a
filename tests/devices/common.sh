# SPDX-License-Identifier: Apache-2.0
# What the scripts of this folder share; each is called with the program, the repository's root and an empty folder to work in.
set -euo pipefail
sunstone=$1
root=$2
work=$3
rm -rf "$work"
mkdir -p "$work/cache"
cd "$work"
export SUNSTONE_CACHE=$work/cache  # a verdict or a binary of an earlier run would leave the self-test or the compiler out

skip() {
  echo "SKIP: $*"
  exit 77
}
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# film_hash FILE.json: what --stats wrote.
film_hash() { sed -n 's/.*"film_hash": "\([0-9a-f]\{32\}\)".*/\1/p' "$1"; }

# same_film NAME FILE.json: the film has the bits of the reference's.
same_film() {
  local here wanted
  here=$(film_hash "$2")
  wanted=$(film_hash reference.json)
  echo "$wanted  PoCL"
  echo "$here  $1"
  [ -n "$wanted" ] && [ "$here" = "$wanted" ] || fail "$1 gives another film than PoCL"
}

# reference FLAGS...: the same picture on PoCL, with its own choice of lanes and layout.
reference() {
  "$sunstone" devices --no-test | grep -q 'Portable Computing Language' || skip "PoCL is not installed (pocl-opencl-icd)"
  "$sunstone" render "$@" -q --device 'Portable Computing Language' -o reference.film --stats reference.json
}
