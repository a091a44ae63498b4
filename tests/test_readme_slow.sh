#!/usr/bin/env bash
# Runs every ```sh block of README.md and docs/stacks.md that starts with `lacquer `, in order, in a folder that has
# nothing but the recipes.
set -euo pipefail
: "${LACQUER:?path of the program}"
source=${LACQUER_SOURCE:-$(cd "$(dirname "$0")/.." && pwd)}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir blocks bin
ln -s "$LACQUER" bin/lacquer
ln -s "$source/recipes" recipes
PATH=$work/bin:$PATH
# Tables that test_pack_recipes_slow.sh made with this program, where it ran.
export XDG_CACHE_HOME=${LACQUER_BUILD:-$source/build/release}/test-cache

awk '/^```sh$/ { inside = 1; n++; next }
     /^```$/   { inside = 0 }
     inside    { print > sprintf("blocks/%03d.sh", n) }' "$source/README.md" "$source/docs/stacks.md"

count=0
for block in blocks/*.sh; do
    head -n 1 "$block" | grep -q '^lacquer ' || continue
    count=$((count + 1))
    if ! bash -euo pipefail "$block"; then
        echo "this block failed:" >&2
        cat "$block" >&2
        exit 1
    fi
done
[ "$count" -gt 0 ] || {
    echo "no lacquer command is shown" >&2
    exit 1
}
