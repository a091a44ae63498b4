#!/usr/bin/env bash
# docs/examples/spheres.mjs, three materials of the shipped scene in three.js, in headless Chromium: every pixel against the
# shipped decode.h, and the energies of that against the exact stack, within the budget of the scene. Skipped without
# Chromium, node, or three (npm ci --prefix tests/consumers).
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
"$lacquer" pack recipes/scene.json -o "$scratch/p" --cache "$scratch/c" >/dev/null
${CC:-cc} -std=c99 -O2 -Wall -Wextra -Wconversion -Wshadow -Werror -I"$scratch/p" tests/consumers/spheres.c \
    -o "$scratch/spheres" -lm

# Each sphere: thousands of pixels, with a highlight brighter than the sky makes it, all within 1e-5 of the C decoder.
TMPDIR=$scratch node tests/consumers/spheres.mjs "$chromium" "$scratch/p" >"$scratch/pixels"
"$scratch/spheres" <"$scratch/pixels" | tee "$scratch/seen"
awk '{ if ($2 < 3000 || $3 < 0.5 || !($4 <= 1e-5)) bad = 1 } END { exit bad || NR != 3 }' "$scratch/seen" ||
    { echo "FAILED: pixels of three.js are not what decode.h shades" >&2; exit 1; }

# The looks of the page as stacks: the scene's own layers with one roughness and one albedo each.
python3 - "$scratch" <<'END'
import json, sys
spheres = {"gold": ("gold", 0.25, None), "wood": ("lacquered-wood", 0.1, [0.5, 0.28, 0.13]), "paint": ("car-paint", 0.3, None)}
materials = {m["name"]: m for m in json.load(open("recipes/scene.json"))["materials"]}
for sphere, (name, alpha, rho) in spheres.items():
    layers = materials[name]["layers"]
    for layer in layers:
        for what, value in (("alpha", alpha), ("rho", rho)):
            for part in layer.values():
                if isinstance(part, dict) and isinstance(part.get(what), dict):
                    part[what] = value
    json.dump({"name": sphere, "layers": layers}, open(f"{sys.argv[1]}/{sphere}.json", "w"))
END
cosines="1 0.7 0.4 0.2 0.1"
"$scratch/spheres" $cosines | sort >"$scratch/decoded"
for sphere in gold wood paint; do
    "$lacquer" stack "$scratch/$sphere.json" --mu "${cosines// /,}" --format csv |
        awk -F, -v name=$sphere 'NR > 1 { line[$1] = line[$1] " " $3 } END { for (mu in line) print name, mu line[mu] }'
done | sort >"$scratch/exact"
paste -d' ' "$scratch/decoded" "$scratch/exact" | awk '
    $1 != $6 || $2 != $7 { wrong = 1 }
    { for (k = 0; k < 3; k++) { d = $(3 + k) - $(8 + k); d = d < 0 ? -d : d; if (d > worst) worst = d } }
    END { printf "energies: %d within %.1e of the exact stack\n", 3 * NR, worst; exit wrong || NR != 15 || !(worst <= 1e-2) }' ||
    { echo "FAILED: the exact stack has other energies" >&2; exit 1; }
