#!/usr/bin/env bash
# NDF plugins: the example of docs/, compiled outside the tree against the installed header, gives tables that
# agree with the same NDF from a file; what is no plugin of this version is refused in one line.
set -euo pipefail
: "${LACQUER:?program}" "${LACQUER_BUILD:?build folder}" "${LACQUER_SOURCE:?source folder}"
cmake=${CMAKE_COMMAND:-cmake}
cc=${CC:-cc}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$cmake" --install "$LACQUER_BUILD" --prefix "$work/prefix" >/dev/null
include=$(dirname "$(find prefix -name lacquer.h)")
cp "$LACQUER_SOURCE/docs/ndf_plugin.c" .
compile() { # SOURCE OUTPUT
    "$cc" -std=c11 -Wall -Wextra -Werror -O2 -shared -fPIC -I "$include" "$1" -o "$2" -lm
}
fail() {
    echo "FAIL: $*" >&2
    exit 1
}

# ---- the example
compile ndf_plugin.c sech.so
value() { # NDF AXES...
    "$LACQUER" eval "${@:2}" --ndf "$1" --format csv 2>/dev/null | awk -F, 'NR == 2 { print $(NF - 1) }'
}
near() { # A B TOLERANCE
    awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a - b <= t && b - a <= t) }' || fail "$1 is not $2 +- $3"
}
near "$(value plugin:sech.so fgd mu=0.3 alpha=0.4 n=0 kappa=1)" 1 1e-9
awk 'BEGIN {
    print "theta_deg,alpha=0.2,alpha=0.6"
    for (i = 0; i <= 255; i++) {
        angle = 89.9 * i / 255; theta = angle * 3.14159265358979 / 180
        printf "%.12g", angle
        for (a = 0.2; a < 0.7; a += 0.4) {
            t = sin(theta) / cos(theta) / a
            printf ",%.12g", (t < 700 ? 2 / (exp(t) + exp(-t)) : 0) / cos(theta) ^ 4
        }
        print ""
    }
}' >sech.csv
for alpha in 0.2 0.35 0.6; do # one shape: what lies between the columns is known too
    for table in "albedo mu=0.2" "fgd mu=0.6 n=0.2 kappa=3.9" "tir-pass mu=0.6 eta=0.8"; do
        # shellcheck disable=SC2086 # a table and its axes
        near "$(value plugin:sech.so $table alpha=$alpha)" "$(value file:sech.csv $table alpha=$alpha)" 1e-5
    done
done

# ---- a table of it, checked by walks; its fact opens the plugin again until that changes
"$LACQUER" precompute fgd --ndf plugin:sech.so --axis mu=0:1:6 --axis alpha=0.2,0.7 --axis n=0.2 \
    --axis kappa=3.9 -o sech.exr >/dev/null 2>note
grep -q 'hyperbolic secant slopes; D scaled by' note || fail "$(cat note)"
"$LACQUER" validate sech.exr --allow-plugin --against walk --points 12 --samples 10000 | grep -q '^passed' || fail "the walk"
sed 's/cosh(slope/cosh(1.1 * slope/' ndf_plugin.c >other.c
compile other.c sech.so
output=$("$LACQUER" validate sech.exr --ndf plugin:sech.so --points 4 2>&1) && fail "a changed plugin passed"
[[ $output == *'sech.so has changed'* ]] || fail "$output"

# ---- what is refused
refused() { # PATTERN PATH
    local output status=0
    output=$("$LACQUER" eval albedo mu=0.3 alpha=0.5 --ndf "plugin:$2" 2>&1) || status=$?
    [ "$status" -eq 1 ] || fail "$2: exit $status"
    [ "$(wc -l <<<"$output")" -eq 1 ] || fail "$2: more than one line: $output"
    [[ $output == *$1* ]] || fail "$2: '$output' does not say '$1'"
}
variant() { # NAME SED-SCRIPT
    sed "$2" ndf_plugin.c >"$1.c"
    compile "$1.c" "$1.so"
}
variant version 's/= LQ_NDF_PLUGIN_VERSION/= 2/'
variant size 's/= sizeof plugin/= 8/'
variant lacking 's/lacquer_ndf_plugin(void)/another_name(void)/'
variant nothing 's/return &plugin/(void)plugin; return 0/'
variant empty 's/= density,/= 0,/; s/static void density/void density/'
variant range 's/alpha_max = 1.0/alpha_max = 1.5/'
variant negative 's|/ (cos2\[i\] \* cos2\[i\])|* (cos2[i] - 0.5)|'
variant nan 's|1.0 . cosh(slope . alpha)|NAN * slope * alpha|; s|fall > 0.0|1|'
refused 'version 2; accepted: 1' version.so
refused 'has 8 bytes, not ' size.so
refused 'lacks the function lacquer_ndf_plugin' lacking.so
refused 'returns NULL' nothing.so
refused 'lacks the function density' empty.so
refused 'alpha from 0 to 1.5 is not a range' range.so
refused 'D is negative or not finite at alpha = 1' negative.so
refused 'D is negative or not finite at alpha = 1' nan.so
refused 'cannot read no.so' no.so
refused 'is not loaded' ndf_plugin.c
refused 'write plugin:PATH' ''
echo "plugins: example, table, walk and refusals"
