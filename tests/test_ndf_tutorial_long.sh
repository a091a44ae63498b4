#!/usr/bin/env bash
# Runs docs/tutorial-ndf.md as it is written, against an installed tree, and checks what the text says comes out.
set -euo pipefail
: "${LACQUER_BUILD:?build folder}" "${LACQUER_SOURCE:?source folder}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"${CMAKE_COMMAND:-cmake}" --install "$LACQUER_BUILD" --prefix "$work/prefix" >/dev/null
PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name lacquer.pc)")
export PKG_CONFIG_PATH PATH="$work/prefix/bin:$PATH" XDG_CACHE_HOME="$work/cache"
awk '/^```sh$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$LACQUER_SOURCE/docs/tutorial-ndf.md" >run.sh
[ "$(grep -c '^lacquer' run.sh)" -ge 8 ] || { echo "FAIL: the tutorial has lost its commands" >&2; exit 1; }
bash -euo pipefail run.sh >out 2>notes || {
    cat out notes
    echo "FAIL: exit $?" >&2
    exit 1
}

expect() { # PATTERN FILE
    grep -Eq "$1" "$2" || {
        cat "$2"
        echo "FAIL: no '$1' in $2" >&2
        exit 1
    }
}
expect '^(1|0\.99999[0-9]*|1\.0*) ± ' out
expect '^sech.so: hyperbolic' <(sed 's/^lacquer [a-z]*: //' notes)
expect 'D scaled by 0\.0868782 at alpha = 1' notes
expect 'ndf +plugin:sech\.so#[0-9a-f]{16}' out
[ "$(grep -c '^passed' out)" -eq 6 ] || { cat out; echo "FAIL: two walks and four certificates pass" >&2; exit 1; }
expect '^all textures +13120' out
grep -q '"ndf": "plugin:sech.so#' sech/manifest.json || { echo "FAIL: the manifest has another NDF" >&2; exit 1; }
sed 's/0.02:0.26:256/0.02:0.5:256/' sech.json >pole.json
lacquer pack pole.json --allow-plugin -o pole 2>message && { echo "FAIL: f beyond its pole" >&2; exit 1; }
expect 'pole of f, alpha = 0.2932 for plugin:sech.so' message
expect 'one roughness, alpha = 0\.[0-9]+ by its median slope' notes
# 0.889 of GGX, 0.950, 0.941 of Beckmann; file = plugin to six digits
grep -E '^[01]\.?[0-9]* ± ' out | awk '{ print $1 }' >values
awk '{ v[NR] = $1 } END {
    d = v[5] - v[6]
    exit !(NR == 7 && v[2] ~ /^0.888/ && v[3] ~ /^0.950/ && v[4] ~ /^0.941/ && d < 1e-6 && d > -1e-6)
}' values || { cat values; echo "FAIL: the order of the albedos, or file against plugin" >&2; exit 1; }
echo "tutorial: $(wc -l <run.sh) lines run"
