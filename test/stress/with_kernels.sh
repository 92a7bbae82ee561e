#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Runs tests with the kernels of one instruction set, and compares the bits of their answers with those of the widest.
#   with_kernels.sh NAME SAME_BITS_PROGRAM TEST...
set -eu
name=$1 program=$2
shift 2
BOX_QUERY_KERNEL=$name
export BOX_QUERY_KERNEL
if [ "$("$program" --kernels)" != "$name" ]; then
  echo "this CPU has no $name"
  exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
BOX_QUERY_KERNEL= "$program" > "$work/expected"
"$program" > "$work/answers"
if ! diff "$work/expected" "$work/answers"; then
  echo "Other bits than with $(BOX_QUERY_KERNEL= "$program" --kernels)."
  exit 1
fi
for test in "$@"; do
  "$test" --gtest_brief=1
done
