#!/usr/bin/env bash
# Packs with every built-in NDF, a sampled one and a measured one of a single roughness: made, decoded and certified with no
# other change; where an NDF has no f, one line says so.
. "$(dirname "$0")/scratch.sh"

# GGX and a column of its own, by their formula.
awk 'BEGIN {
    print "theta_deg,alpha=0,alpha=0.3,alpha=1"
    for (i = 0; i < 256; i++) {
        theta = 1.5707 * (i / 255) ^ 2
        printf "%.9g", theta * 180 / 3.14159265358979
        split("1e-3 0.3 1", alpha)
        for (c = 1; c <= 3; c++) {
            t = sin(theta) / cos(theta) / alpha[c]
            printf ",%.9g", 1 / (cos(theta)^4 * (1 + t * t)^2)
        }
        print ""
    }
}' | sed '1s/alpha=0,/alpha=0.001,/' >ggx.csv
cut -d, -f1,3 ggx.csv | sed '1s/alpha=0.3/D/' >measured.csv

pack() { # NDF ALPHA F
    cat >recipe.json <<END_OF_RECIPE
{"name": "small", "ndf": "$1", "formats": ["ktx2"], "points": 500, "budget": {"p99": 5e-3, "max": 3e-2}, "tables": [
  {"table": "albedo", "tolerance": 1e-4, "axes": {"mu": "0.02:1:32:sqrt"$2}},
  {"table": "fgd", "name": "silver", "tolerance": 1e-4, "axes": {"mu": "0.02:1:32:sqrt", "n": "0.2", "kappa": "3.9"$2}},
  {"table": "fgd-dielectric", "tolerance": 1e-3, "axes": {"mu": "0.02:1:24:sqrt", "eta": "1.2:2:8"$2},
   "pca": {"separate": "eta:4"}}$3]}
END_OF_RECIPE
    "$lacquer" pack recipe.json --ndf "$1" -o pack --cache cache >made.txt 2>message.txt
}
alphas=', "alpha": "0.05:1:24:sqrt"'
f=', {"mapping": "f", "axes": {"alpha": "0.02:0.45:128"}, "pca": {"value": "square"}}'
for ndf in beckmann gtr:gamma=1.5 student-t:gamma=3 file:ggx.csv; do
    f_here=$f tables=4
    [ "$ndf" != file:ggx.csv ] || f_here='' tables=3 # its roughness starts at 0.001
    pack "$ndf" "$alphas" "$f_here" || fail "$ndf: $(cat message.txt)"
    named=()
    [ "$ndf" != file:ggx.csv ] || named=(--ndf "$ndf") # a file is opened where it is named, the others have none
    "$lacquer" validate pack "${named[@]}" --points 1000 >certificate.txt || fail "$ndf: $(cat certificate.txt)"
    [ "$(grep -c "^passed$" certificate.txt)" = "$tables" ] || fail "$ndf: $(cat certificate.txt)"
    grep -q "fgd-dielectric, ${ndf%%#*}" certificate.txt || fail "$ndf is not what was certified"
done

# A material of one roughness has nothing along alpha.
pack file:measured.csv '' '' || fail "measured: $(cat message.txt)"
"$lacquer" validate pack --ndf file:measured.csv --points 1000 >certificate.txt || fail "measured: $(cat certificate.txt)"
pack file:measured.csv '' "$f" && fail "f of one roughness"
sed -i '/D scaled by/d' message.txt # what --ndf says of any file that it opens
[ "$(wc -l <message.txt)" = 1 ] && grep -q 'mapping is a limit at alpha = 0' message.txt || fail "$(cat message.txt)"
