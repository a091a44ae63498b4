#!/usr/bin/env bash
# `lacquer bench stack` of the stacks that are built in: every row is there, whatever its seconds.
set -euo pipefail
: "${LACQUER:?path of the program}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$LACQUER" bench stack --samples 1000 --csv bench.csv >out
rows=$(tail -n +2 bench.csv | cut -d, -f1-5 | xargs)
expected=
for stack in frosted-metal varnished-base six-interfaces; do
    expected+="$stack,solver,0.0001,64,1 $stack,walk,1000,1,1 "
done
for stack in frosted-absorption frosted-base varnished-albedo; do
    expected+="$stack-rgb,solver,0.0001,64,3 $stack-rgb,solver,0.0001,64,1 $stack-rgb,walk,1000,1,3 "
done
[ "$rows " = "$expected" ] || {
    echo "rows: $rows" >&2
    exit 1
}
[ "$(grep -c 'times faster$' out)" -eq 6 ] && [ "$(grep -c 'times as long as one$' out)" -eq 3 ] || {
    cat out >&2
    exit 1
}
# the one channel is one of the three: it cannot be less exact than all of them
awk -F, '$2 == "solver" && $5 == 3 { e = $11 } $2 == "solver" && $5 == 1 && e { if ($11 > e) exit 1; e = 0 }' bench.csv
