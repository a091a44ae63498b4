#!/usr/bin/env bash
# A table of 268 million entries, 1.07 GB, is made within 400 MB of memory, and is what it says: its checksum is read
# again. (From n = 0 it misses its tolerance: docs/cluster.md.)
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?source folder}"
source "$LACQUER_SOURCE/tests/expect.sh"
own_folder
/usr/bin/time -f %M -o peak "$LACQUER" precompute fgd --axis mu=0:1:128 --axis alpha=0:1:128 --axis n=0.5:4:128 \
    --axis kappa=0:4:128 -o big.exr || fail "exit $?"
[ "$(stat -c %s big.exr)" -gt 1000000000 ] || fail "a file of $(stat -c %s big.exr) bytes"
[ "$(tail -1 peak)" -lt 400000 ] || fail "$(tail -1 peak) kB of memory"
echo "$(tail -1 peak) kB"
"$LACQUER" info big.exr >info || fail "$(cat info)"
grep -q 268435456 info || fail "$(cat info)"
[ "$failures" -eq 0 ]
