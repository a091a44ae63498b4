#!/usr/bin/env bash
# three.js loads the KTX2 files of a pack in headless Chromium and draws them: sizes, formats and every texel, against
# the .npy of the same pack. Skipped without Chromium, node, or three (npm ci --prefix tests/consumers).
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
lacquer=${LACQUER:-$PWD/build/release/lacquer}
chromium=$(command -v chromium || command -v chromium-browser || true)
if [ -z "$chromium" ] || ! command -v node >/dev/null || [ ! -d tests/consumers/node_modules/three ]; then
    echo "no chromium, no node, or no tests/consumers/node_modules/three"
    exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat >"$scratch/r.json" <<'END_OF_RECIPE'
{"name": "small", "formats": ["ktx2", "ktx2-zstd", "npy"], "points": 100, "tables": [
 {"table": "dfg", "axes": {"mu": "0:1:24:sqrt", "alpha": "0:1:16"}, "tolerance": 1e-4},
 {"table": "albedo-average", "axes": {"alpha": "0:1:13"}, "tolerance": 1e-3},
 {"table": "fgd", "axes": {"mu": "0:1:8", "alpha": "0:1:6", "n": "0.2:2:5", "kappa": "3.9"}, "tolerance": 1e-3}]}
END_OF_RECIPE
"$lacquer" pack "$scratch/r.json" -o "$scratch/p" --cache "$scratch/c" >/dev/null

load() { # FILE...
    TMPDIR=$scratch node tests/consumers/three.mjs "$chromium" "$scratch/p" "$@"
}
# A texel that differs is seen.
head -c -1 "$scratch/p/dfg.ktx2" >"$scratch/p/dfg.changed.ktx2"
printf '\x3f' >>"$scratch/p/dfg.changed.ktx2"
cp "$scratch/p/dfg.npy" "$scratch/p/dfg.changed.npy"

load dfg.ktx2 dfg.zstd.ktx2 albedo-average.ktx2 fgd.ktx2 fgd.zstd.ktx2 dfg.changed.ktx2 >"$scratch/seen.txt"
diff - "$scratch/seen.txt" <<'END_OF_LIST' || { echo "FAILED: three.js loads other texels" >&2; exit 1; }
dfg.ktx2 half 24 16 1 2 same
dfg.zstd.ktx2 half 24 16 1 2 same
albedo-average.ktx2 half 13 1 1 1 same
fgd.ktx2 half 8 6 5 1 same
fgd.zstd.ktx2 half 8 6 5 1 same
dfg.changed.ktx2 half 24 16 1 2 1 values differ
END_OF_LIST
