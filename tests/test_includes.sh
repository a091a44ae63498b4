#!/usr/bin/env bash
# Which room may include which. Fails on an include outside this table and on one that is not relative to
# the root.
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"

declare -A may=(
    [system]=""
    [microfacet]="system"
    [tables]="system microfacet"
    [picture]="system tables"
    [precompute]="system microfacet tables"
    [pca]="system tables"
    [fit]="system microfacet tables"
    [stack]="system microfacet tables precompute fit"
    [pack]="system microfacet tables picture precompute pca fit stack"
    [validate]="system microfacet tables picture precompute pca fit stack pack"
    [program]="system microfacet tables picture precompute pca fit stack pack validate"
)
failed=0

complain() { # FILE:LINE INCLUDE WHY
    echo "$1: #include \"$2\": $3" >&2
    failed=1
}

check() { # FILE LINE INCLUDED
    local file=$1 where=$1:$2 included=$3
    local room=${file%%/*} target=${3%%/*}
    case $included in
    ../* | */../* | ./*) complain "$where" "$included" "is not relative to the root" ;;
    esac
    [ -e "$included" ] || complain "$where" "$included" "no such file from the root"
    case " lacquer.h $room ${may[$room]} " in
    *" $target "*) ;;
    *) complain "$where" "$included" "$room/ may not include it" ;;
    esac
    case $file:$included in
    validate/walk*:precompute/*) complain "$where" "$included" "the random walk is independent of it" ;;
    esac
}

for room in "${!may[@]}"; do
    while IFS=: read -r file line text; do
        check "$file" "$line" "$(sed -E 's/^[^"]*"([^"]*)".*/\1/' <<<"$text")"
    done < <(find "$room" -name '*.[ch]' -o -name '*.cc' 2>/dev/null | sort |
        xargs -r grep -HnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' || true)
done

# What can fail only where someone looks stands in one place each: see system/json.h.
only() { # FILES PATTERN...: the pattern stands in no other file of the rooms
    local where
    where=$(grep -rnE --include='*.[ch]' "$2" "${!may[@]}" | grep -vE "^($1):" || true)
    [ -z "$where" ] || { echo "$where: only in $1" >&2 && failed=1; }
}
only 'system/json\.[ch]' '<jansson\.h>|\bjson_(dump|load|object_set|array_append|array_insert|object_update)[a-z_]*\('
only 'system/draft\.c' '\b(open_memstream|fmemopen)\('
# Numbers of the library have a point in every locale; the program never leaves the C locale.
unset "may[program]"
only 'system/number\.[ch]|fit/tool_fit\.c' '\b(strto(d|f|ld)|atof|[fsv]*scanf)\(|\bv?snprintf\(.*%[-+#0-9.*]*l?[efgEFG][^a-z]'
exit "$failed"
