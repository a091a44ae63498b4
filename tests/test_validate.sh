#!/usr/bin/env bash
# `lacquer validate` and `lacquer bench`: a good table passes, a damaged one does not, mistakes are one line.
set -euo pipefail
: "${LACQUER:?path of the program}"
. "$(dirname "$0")/expect.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# ------------------------------------------------------------------------- tables that are in order
axes=(--axis mu=0:1:9 --axis alpha=0:1:6 --axis n=0.2:2:3 --axis kappa=1:4:3)
run 0 precompute fgd "${axes[@]}" -o fgd.exr
run 0 validate fgd.exr --against walk --points 40 --samples 20000 --seed 3
says 'seed 3, walks of 20000 samples'
says '^stored - walk +[0-9]'
says '^passed$'
[ ! -s err ] || fail "validate wrote to stderr: $(cat err)"

# the report does not depend on the threads
mv out first
run 0 validate fgd.exr --against walk --points 40 --samples 20000 --seed 3 --threads 1
cmp -s first out || fail "one thread changes the report"
run 0 validate fgd.exr --points 20
grep -q walk out && fail "walks without --against walk"

run 0 precompute fgd "${axes[@]}" --scattering single --masking separable -o single.exr
run 0 validate single.exr --against walk --points 20 --samples 20000
says 'single scattering, separable masking'
for kind in albedo albedo-average dfg; do
    run 0 precompute $kind --axis alpha=0:1:12 -o $kind.exr
    run 0 validate $kind.exr --against walk --points 24 --samples 20000 --format json
    says '"passed": true'
    says '"z_limit"'
done

# both sides of a dielectric, grazing and smooth ends included
rough=(--axis alpha=0,0.01,0.3,1 --axis eta=0.6,1,1.5)
looked_up=(--axis mu=0,0.1,0.5,1 "${rough[@]}")
absorbing=(--axis tau=0,0.5,1)
loose=(--tolerance 5e-4)
run 0 precompute fgd-dielectric "${looked_up[@]}" "${loose[@]}" -o fgd-dielectric.exr
run 0 precompute transmission "${looked_up[@]}" "${absorbing[@]}" "${loose[@]}" -o transmission.exr
run 0 precompute diffuse-transmission "${rough[@]}" "${absorbing[@]}" "${loose[@]}" -o diffuse-transmission.exr
run 0 precompute diffuse-reflection "${rough[@]}" "${absorbing[@]}" "${loose[@]}" -o diffuse-reflection.exr
run 0 precompute variance "${rough[@]}" "${loose[@]}" -o variance.exr
for kind in fgd-dielectric transmission diffuse-transmission diffuse-reflection variance; do
    run 0 validate $kind.exr --against walk --points 24 --samples 10000
    says '^exact - walk +[0-9]'
done
for kind in fgd-dielectric transmission; do
    run 0 precompute $kind --scattering single "${looked_up[@]}" -o once.exr
    run 0 validate once.exr --against walk --points 24 --samples 10000
done
run 0 precompute coated-lambertian --axis mu=0.1,1 --axis alpha=0,0.3 --axis eta=1,1.5 --axis tau=0,0.7 \
    --axis rho=0,1 -o coated.exr
run 0 validate coated.exr --against walk --points 12 --samples 2000

refused '--points has no effect for hard-cases' validate hard-cases --points 3
refused '--against has no effect for hard-cases' validate hard-cases --against walk

# a Mitsuba file in one command, each of its parts against the solver: the cosine-weighted means are a quadrature
# of the file's own, the kind diffuse-transmission another
run 0 precompute transmission --format mitsuba --axis mu=0:1:9:power4 --axis alpha=0:1:3:power4 \
    --axis eta=1:3:2:power4 -o ggx.dat
for layout in mitsuba mitsuba-inside; do
    run 0 validate ggx.dat --layout $layout --kind transmission
    says '^passed$'
done
run 0 validate ggx.dat --layout mitsuba-inside --kind diffuse-transmission --budget 1e-5
run 0 info ggx.dat --layout mitsuba --kind transmission --ndf beckmann
says 'ndf +beckmann'
refused 'tau = 1 alone' precompute transmission --format mitsuba --axis tau=0:1:3 -o no.dat
refused 'eta >= 1' precompute transmission --format mitsuba --axis eta=0.5:3:3:power4 -o no.dat
refused 'stores no fgd' precompute fgd --format mitsuba -o no.dat
[ ! -e no.dat ] || fail "a refused file was written"

# --------------------------------------------------------------------------------- tables that are not
# the linear interpolation of a coarse table is far above any budget
run 2 validate fgd.exr --points 20 --budget 1e-6
says 'FAILED: the error exceeds the budget'

# --------------------------------------------------------------------------------------- bad input
refused 'FILE is missing' validate
refused 'missing.exr' validate missing.exr
echo 'not an EXR' >foreign.exr
refused 'foreign.exr' validate foreign.exr
head -c 400 fgd.exr >short.exr
refused 'short.exr' validate short.exr
refused 'one FILE' validate fgd.exr single.exr
refused -- '--points.*0' validate fgd.exr --points 0
refused -- '--samples.*many' validate fgd.exr --against walk --samples many
refused -- '--samples needs --against walk' validate fgd.exr --samples 1000
refused 'exact.*walk' validate fgd.exr --against dice
refused -- '--budget.*-1' validate fgd.exr --budget -1
refused 'nonsense' validate fgd.exr --nonsense

# -------------------------------------------------------------------- another table, and published ones
tir=(--axis mu=0:1:9 --axis alpha=0:1:9 --axis eta=0:1:9)
run 0 precompute tir-pass "${tir[@]}" -o tir.exr
run 0 validate tir.exr --against walk --points 24 --samples 20000
run 0 precompute tir-loss "${tir[@]}" -o loss.exr
run 0 validate loss.exr --against walk --points 24 --samples 20000
run 0 precompute tir-pass "${tir[@]}" --format belcour -o tir.bin
[ "$(stat -c %s tir.bin)" -eq $((12 + 24 + 4 * 729)) ] || fail "tir.bin has $(stat -c %s tir.bin) bytes"
run 0 info tir.bin --layout belcour --kind tir-pass
says 'usage +.*r21 \+= \(1 - TIR\) t21'

published=(--layout belcour --kind tir-pass)
run 0 validate tir.exr --against tir.bin "${published[@]}"
says 'rms +0.000e\+00'
says '^passed$'
run 0 validate tir.bin "${published[@]}"
says 'tir.bin - exact: tir-pass'
run 0 validate tir.exr --against tir.bin "${published[@]}" --points 50 --format json
says '"passed": true'
run 0 precompute tir-pass "${tir[@]}" --tolerance 1e-7 -o finer.exr
run 0 validate tir.exr --against finer.exr
says 'the two agree within their tolerances'
# other nodes: what FILE says it is, computed there
run 0 precompute tir-pass --axis mu=0:1:5 --axis alpha=0.1:0.9:5 --axis eta=1:4:7 -o other.exr
run 0 validate tir.exr --against other.exr
says 'the reference is computed at these nodes'

# the same bytes in the other order are another table
run 2 validate tir.bin --layout tm --kind tir-loss
says 'FAILED: neither the stated tolerances nor independent noise'
run 2 validate tir.exr --against finer.exr --budget 1e-12
run 0 precompute albedo --masking separable --axis mu=0:1:5 --axis alpha=0:1:5 --format tm -o gd.bin
run 0 validate gd.bin --layout tm --kind albedo
says 'separable masking'

refused 'needs --kind' validate tir.bin --layout belcour
refused 'needs --layout' validate tir.exr --against tir.bin --kind tir-pass
refused 'stores no tir-loss' validate tir.bin --layout belcour --kind tir-loss
refused "is 'tir-loss', not 'tir-pass'" validate tir.exr --against loss.exr
refused '--ndf has no effect without' validate tir.exr --ndf ggx
refused 'not a belcour table of fgd' info tir.bin --layout belcour --kind fgd
head -c 300 tir.bin >short.bin
refused 'do not make up its length' validate tir.exr --against short.bin "${published[@]}"
refused 'not a belcour table' validate tir.exr --against tir.exr "${published[@]}"
refused 'is not exact, walk or a file' validate tir.exr --against missing.bin "${published[@]}"
refused 'stores linear axes' precompute tir-pass --axis mu=0:1:9:sqrt --format belcour -o bad.bin
refused 'separable masking, not correlated' precompute albedo --format tm -o bad.bin
refused 'does not follow from the name' precompute tir-pass -o bad.bin
[ ! -e bad.bin ] || fail "a refused table left a file"

# ------------------------------------------------------------------------------------------- bench
run 0 bench albedo-average --points 4 --csv bench.csv --svg bench.svg --seed 5
says 'seed 5'
says '^rms error 1e-04: solver .* times faster$'
[ "$(head -n 1 bench.csv)" = \
    table,method,setting,entries,threads,wall_seconds,cpu_seconds_per_entry,rms_error,max_error ] ||
    fail "bench.csv: $(head -n 1 bench.csv)"
[ "$(grep -c ',walk,' bench.csv)" -eq 4 ] || fail "bench.csv has not 4 walks"
grep -q '</svg>' bench.svg || fail "bench.svg is not whole"
says_commit='lacquer [0-9.]+ \([0-9a-f]{7,}(-dirty)?\)|lacquer [0-9.]+,'
grep -qE "$says_commit" bench.svg || fail "bench.svg does not name version and commit"
run 0 bench albedo-average --report page --points 4 --samples 1000
grep -q '</html>' page/index.html || fail "the page is not whole"
grep -q '<img src="albedo-average.svg"' page/index.html || fail "the page shows no chart"
grep -qE '<td>walk</td><td>1e\+03</td><td>4</td>' page/index.html || fail "the page has no row of the walk"
[ "$(grep -c ',walk,' page/albedo-average.csv)" -eq 1 ] || fail "--samples 1000 is not one walk"
refused '--csv has no effect with --report' bench --report page --csv x.csv
refused 'cannot make the folder' bench --report nowhere/page
refused 'unknown table' bench nonsense
refused 'one TABLE' bench albedo fgd
refused 'nowhere' bench albedo --csv nowhere/bench.csv
refused -- '--scattering' bench albedo --scattering single

exit "$failures"
