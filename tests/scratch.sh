# What tests of packs share: the program, a folder of the test's own to work in, and failing at the first complaint. A test
# sources it as: . "$(dirname "$0")/scratch.sh"
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
root=$PWD
lacquer=${LACQUER:-$root/build/release/lacquer}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
export XDG_CACHE_HOME=$scratch/xdg

fail() {
    echo "FAILED: $*" >&2
    exit 1
}
