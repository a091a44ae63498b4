#!/usr/bin/env bash
# A scene pack in a browser: decode.wgsl in a compute shader of WebGPU and decode.glsl in WebGL2, in headless Chromium,
# against the shipped decode.h at 400 points of every material. Skipped without Chromium, node, or both of them.
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
lacquer=${LACQUER:-$PWD/build/release/lacquer}
chromium=$(command -v chromium || command -v chromium-browser || true)
if [ -z "$chromium" ] || ! command -v node >/dev/null; then
    echo "no chromium, or no node"
    exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/points"
"$lacquer" pack tests/consumers/scene.json -o "$scratch/p" --cache "$scratch/c" >/dev/null
${CC:-cc} -std=c99 -O2 -ffp-contract=off -Wall -Wextra -Wconversion -Wshadow -Werror -I"$scratch/p" \
    tests/consumers/scene.c -o "$scratch/scene" -lm
"$scratch/scene" >"$scratch/points/points.json"

decode() { # FOLDER
    TMPDIR=$scratch node tests/consumers/scene.mjs "$chromium" "$1" "$scratch/points/points.json"
}
decode "$scratch/p"

# A fiftieth of a texel beside its centre is seen, in either language.
for file in decode.wgsl decode.glsl; do
    rm -rf "$scratch/off"
    cp -r "$scratch/p" "$scratch/off"
    sed -i 's/ + 0\.5) / + 0.52) /' "$scratch/off/$file"
    if decode "$scratch/off" >"$scratch/seen"; then
        echo "FAILED: $file off by a fiftieth of a texel passed: $(cat "$scratch/seen")" >&2
        exit 1
    fi
done
