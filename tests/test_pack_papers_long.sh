#!/usr/bin/env bash
# The recipes of the papers meet their budgets.
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
lacquer=${LACQUER:-$PWD/build/release/lacquer}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for recipe in layered-2018 coated-lambertian-2022; do
    "$lacquer" pack "recipes/$recipe.json" -o "$scratch/$recipe" --cache "$scratch/cache" || { echo "FAILED: $recipe" >&2; exit 1; }
done
