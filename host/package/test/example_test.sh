#!/bin/sh
# example_test.sh SOURCES BUILD CMAKE: installs the library of a build into a clean folder, builds the
# example from that alone, and compares its output. Then configures the library by itself.
set -eu
sources=$1 build=$2 cmake=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$cmake" --install "$build" --component library --prefix "$folder/installed" >"$folder/log"
(cd "$folder/installed" && find . -type f | sort) >"$folder/files"
cat "$folder/files"
[ "$(wc -l <"$folder/files")" -le 8 ]
cp -r "$sources/host/package/example" "$folder/example"
"$cmake" -S "$folder/example" -B "$folder/build" -DCMAKE_PREFIX_PATH="$folder/installed" >>"$folder/log"
"$cmake" --build "$folder/build" >>"$folder/log"
"$folder/build/example" >"$folder/said"
cat "$folder/said"
printf 'triangle 0 at t 2\nnothing\n' | cmp - "$folder/said"
"$cmake" -S "$sources" -B "$folder/alone" -DRAYGATE_LIBRARY=ON >>"$folder/log"
"$cmake" --build "$folder/alone" --target help | grep -qw raygate
echo passed
