#!/usr/bin/env bash
# Runs every ```sh block of README.md that starts with `lacquer `, in order, in one empty folder.
set -euo pipefail
: "${LACQUER:?path of the program}"
readme=${LACQUER_SOURCE:-$(cd "$(dirname "$0")/.." && pwd)}/README.md

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir blocks bin
ln -s "$LACQUER" bin/lacquer
PATH=$work/bin:$PATH

awk '/^```sh$/ { inside = 1; n++; next }
     /^```$/   { inside = 0 }
     inside    { print > sprintf("blocks/%03d.sh", n) }' "$readme"

count=0
for block in blocks/*.sh; do
    head -n 1 "$block" | grep -q '^lacquer ' || continue
    count=$((count + 1))
    if ! bash -euo pipefail "$block"; then
        echo "this block of README.md failed:" >&2
        cat "$block" >&2
        exit 1
    fi
done
[ "$count" -gt 0 ] || {
    echo "README.md shows no lacquer command" >&2
    exit 1
}
