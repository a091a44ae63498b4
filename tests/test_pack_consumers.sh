#!/usr/bin/env bash
# Other people's readers take the files of a pack: npm's ktx-parse. Skipped without node or its package
# (npm ci --prefix tests/consumers).
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
lacquer=${LACQUER:-$PWD/build/release/lacquer}
if ! command -v node >/dev/null || [ ! -d tests/consumers/node_modules/ktx-parse ]; then
    echo "no node, or no tests/consumers/node_modules/ktx-parse"
    exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat >"$scratch/r.json" <<'END'
{"name": "small", "formats": ["ktx2", "ktx2-zstd", "npy"], "points": 100, "tables": [
 {"table": "dfg", "axes": {"mu": "0:1:24:sqrt", "alpha": "0:1:16"}, "tolerance": 1e-4},
 {"table": "fgd", "axes": {"mu": "0:1:8", "alpha": "0:1:6", "n": "0.2:2:5", "kappa": "3.9"}, "tolerance": 1e-3}]}
END
"$lacquer" pack "$scratch/r.json" -o "$scratch/p" --cache "$scratch/c" >/dev/null

# The first and the last half of the .npy, which knows nothing of KTX2.
ends() { od -An -v -tu2 -w2 -j128 "$1" | sed -n '1p;$p' | tr -d ' ' | tr '\n' ' ' | sed 's/ $//'; }
expect() { # FILE LINE
    got=$(node tests/consumers/ktx.mjs "$scratch/p/$1")
    [ "$got" = "$2" ] || { echo "FAILED: $1: '$got', expected '$2'" >&2; exit 1; }
}
expect dfg.ktx2 "83 24 16 0 0 0 1536 rd 2 $(ends "$scratch/p/dfg.npy")"
expect dfg.zstd.ktx2 "83 24 16 0 0 2 1536 rd 2 compressed"
expect fgd.ktx2 "76 8 6 5 0 0 480 rdi 1 $(ends "$scratch/p/fgd.npy")"
