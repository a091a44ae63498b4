#!/usr/bin/env bash
# Reading a file runs and opens nothing it names: a recorded NDF plugin or sample file is refused by name unless the
# user names it, by every verb that reads tables, factors, packs, recipes or descriptions.
set -euo pipefail
: "${LACQUER:?program}" "${LACQUER_SOURCE:?source folder}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME=$work/cache PLANTED=$work/planted

fail() {
    echo "FAIL: $*" >&2
    exit 1
}

# A plugin whose constructor leaves a file.
{
    cat "$LACQUER_SOURCE/docs/ndf_plugin.c"
    echo '#include <stdio.h>'
    echo '#include <stdlib.h>'
    echo '__attribute__((constructor)) static void plant(void) { FILE *f = fopen(getenv("PLANTED"), "w"); if (f) fclose(f); }'
} >evil.c
"${CC:-cc}" -std=c11 -O2 -shared -fPIC -I "$LACQUER_SOURCE" evil.c -o evil.so -lm
awk 'BEGIN {
    print "theta_deg,alpha=0.3,alpha=0.6"
    for (i = 0; i < 90; i++) { t = sin(i / 57.29578) / cos(i / 57.29578)
        print i "," exp(-t * t / 0.09) / cos(i / 57.29578) ^ 4 "," exp(-t * t / 0.36) / cos(i / 57.29578) ^ 4 }
}' >samples.csv

recipe() { # NDF
    cat <<END
{"name": "small", "ndf": "$1", "formats": ["npy"], "points": 100,
 "tables": [{"table": "albedo", "axes": {"mu": "0.02:1:8"$alpha}, "tolerance": 1e-3}]}
END
}
make() { # NDF NAME: a table, factors, a pack, a recipe and a description that record it
    "$LACQUER" precompute albedo --ndf "$1" --tolerance 1e-3 --axis mu=0.02:1:8 "${axis[@]}" -o "$2.exr" >/dev/null 2>&1
    "$LACQUER" pca "$2.exr" --nodes-only --separate mu:1 -o "$2-factors.exr" >/dev/null 2>&1
    recipe "$1" >"$2.json"
    "$LACQUER" pack "$2.json" --ndf "$1" -o "$2-pack" >/dev/null 2>&1
    cp "$2.exr" "in-$2.exr"
}
refused() { # COMMAND...: exit 1, one line that names the NDF, nothing run
    local code=0
    rm -f "$PLANTED"
    timeout 20 "$LACQUER" "$@" >out.txt 2>message.txt || code=$?
    [ ! -e "$PLANTED" ] || fail "the plugin ran: $*"
    [ "$code" = 1 ] || fail "exit $code: $*: $(cat message.txt)"
    [ "$(wc -l <message.txt)" = 1 ] && grep -q "recorded NDF '$ndf" message.txt || fail "$*: $(cat message.txt)"
}

axis=(--axis alpha=0.3,0.6) alpha=', "alpha": "0.3:0.6:4"'
for ndf in plugin:evil.so file:samples.csv; do
    make $ndf kept
    refused validate kept.exr --points 4
    refused validate kept.exr --against walk --points 4
    refused validate kept.exr --diagnose
    refused validate kept.exr --certificate --points 100
    refused validate kept.exr --against in-kept.exr
    refused validate kept-factors.exr --points 100
    refused validate kept-factors.exr --table kept.exr
    refused validate kept-pack --points 100
    mkdir -p folder
    cp kept.exr folder/
    refused validate folder --points 100
    refused pca kept.exr --separate mu:1 -o x.exr
    refused pack kept.json -o x
    for verb in "pack kept.json" "pca kept.exr --separate mu:1"; do # what opens nothing is no trust
        code=0
        # shellcheck disable=SC2086 # a verb and its words
        "$LACQUER" $verb --ndf ggx -o x >out.txt 2>message.txt || code=$?
        [ "$code" = 1 ] && [ "$(wc -l <message.txt)" = 1 ] && grep -q -- '--ndf has no effect with ggx' message.txt ||
            fail "$verb --ndf ggx: exit $code, $(cat message.txt)"
    done
    for verb in info "eval albedo mu=0.5 alpha=0.4 --from"; do # these open no NDF
        rm -f "$PLANTED"
        # shellcheck disable=SC2086 # a verb and its words
        "$LACQUER" $verb kept.exr >/dev/null 2>&1 || true
        [ ! -e "$PLANTED" ] || fail "$verb ran the plugin"
    done
    "$LACQUER" validate kept.exr --ndf $ndf --points 4 >/dev/null 2>&1 || fail "named, but refused"
    cp evil.so samples.csv folder/ # moved: the hash is the same
    hash=$("$LACQUER" info kept.exr | sed -n 's/.*ndf .*#//p')
    "$LACQUER" validate kept.exr --ndf "${ndf%%:*}:folder/${ndf#*:}#$hash" --points 4 >/dev/null 2>&1 || fail "moved"
done
ndf=plugin:evil.so
make $ndf kept

# What was hashed is what is loaded, not what stands at the path a moment later: a library whose constructor says where
# it was loaded from.
{
    echo '#define _GNU_SOURCE'
    echo '#include <dlfcn.h>'
    cat "$LACQUER_SOURCE/docs/ndf_plugin.c"
    echo '#include <stdio.h>'
    echo '__attribute__((constructor)) static void say(void) {'
    echo 'Dl_info here; if (dladdr((void *)say, &here)) fprintf(stderr, "%s\n", here.dli_fname); }'
} >where.c
"${CC:-cc}" -std=c11 -O2 -shared -fPIC -I "$LACQUER_SOURCE" where.c -o where.so -lm
"$LACQUER" eval albedo mu=0.5 alpha=0.4 --ndf plugin:where.so >out.txt 2>message.txt || fail "$(cat message.txt)"
grep -q '^/proc/self/fd/' message.txt || fail "the library at the path is loaded: $(cat message.txt)"
"$LACQUER" validate kept.exr --allow-plugin --points 4 >/dev/null 2>&1 || fail "allowed, but refused"
[ -e "$PLANTED" ] || fail "the plugin of this test plants nothing"

# Descriptions of foreign files record one too.
for ndf in plugin:evil.so file:samples.csv file:/etc/shadow file:/dev/zero; do
    echo "{\"table\": \"albedo\", \"ndf\": \"$ndf\", \"axes\": [{\"axis\": \"mu\", \"min\": 0.1, \"max\": 1, \"size\": 2}]}" >d.json
    printf '0.1, 0.2\n' >values.h
    rm -f "$PLANTED"
    code=0
    timeout 20 "$LACQUER" validate values.h --axes d.json >out.txt 2>message.txt || code=$?
    [ "$code" = 1 ] && [ ! -e "$PLANTED" ] || fail "$ndf described: exit $code, $(cat message.txt)"
    recipe $ndf >r.json
    refused pack r.json -o x
done

# What the user names is a regular file, or is refused at once.
mkfifo pipe
truncate -s 1T huge
for file in /dev/zero pipe huge .; do
    code=0
    timeout 20 "$LACQUER" eval albedo mu=0.5 alpha=0.5 --ndf "file:$file" >/dev/null 2>message.txt || code=$?
    [ "$code" = 1 ] && [ "$(wc -l <message.txt)" = 1 ] || fail "file:$file: exit $code, $(cat message.txt)"
done
echo "nothing recorded is opened"
