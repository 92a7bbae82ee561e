#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Builds the core and same_bits.cpp in other ways, and compares what they print with what the program of the ordinary
# build prints.
#   same_bits.sh COMPILER PROGRAM SOURCE_DIR EIGEN_INCLUDE_DIR SOURCE...
set -eu
compiler=$1 program=$2 root=$3 eigen=$4
shift 4
if ! command -v "$compiler" >/dev/null; then
  echo "$compiler was not found: install it to compare its answers"
  exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '%s\n' "$@" > "$work/sources"
"$program" > "$work/expected"

# What the processor cannot run is left out, and said. The headers that take longest to read are read once.
run_with() {
  label="$compiler $*"
  folder=$work/$(echo "$*" | tr -d ' ')
  mkdir "$folder"
  printf '#include <%s>\n' box_query/intersection.h box_query/distance.h box_query/scene.h algorithm \
    boost/multiprecision/cpp_int.hpp random > "$folder/first.h"
  set -- "$compiler" -std=c++17 -ffp-contract=off -w -I"$root/include" -I"$root/src" -I"$root/test" -isystem "$eigen" "$@"
  "$@" -x c++-header "$folder/first.h" -o "$folder/first.h.gch"
  xargs -P "$(nproc)" -I SOURCE sh -c 'source=$1 object=$2/$(echo "$1" | tr "/ " __).o
    shift 2
    exec "$@" -c "$source" -o "$object"' sh SOURCE "$folder" "$@" -include "$folder/first.h" < "$work/sources"
  "$compiler" "$folder"/*.o -o "$folder/program" -ltbb -pthread
  if "$folder/program" > "$folder/answers" && cmp -s "$work/expected" "$folder/answers"; then
    echo "$label: the same"
  else
    echo "$label: DIFFERENT"
    diff "$work/expected" "$folder/answers" || true
    different=1
  fi
}

different=0
no_slp=
case $compiler in
  g++*) no_slp=-fno-tree-slp-vectorize ;;  # see bq_configure
esac
# The ordinary build is g++ -O3 without FMA. One without any optimisation is enough.
case $compiler in
  g++*) run_with -O0 ;;
  *) run_with -O3 ;;
esac
if ! grep -qw fma /proc/cpuinfo 2>/dev/null; then
  echo "no FMA on this machine: not compared"
fi
run_with -O3 -march=native $no_slp
exit $different
