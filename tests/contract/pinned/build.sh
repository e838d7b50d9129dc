#!/bin/sh
# Builds the plugin that is pinned to ABI 1.0, with nothing of bodeflow but the header beside it: build.sh OUTPUT.so
set -eu
here=$(cd "$(dirname "$0")" && pwd)
exec "${CC:-cc}" -std=c11 -O2 -Wall -Wextra -Wno-missing-field-initializers -fPIC -shared -fvisibility=hidden -o "$1" "$here/pinned.c"
