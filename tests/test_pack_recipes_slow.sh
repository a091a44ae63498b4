#!/usr/bin/env bash
# The shipped recipes: their budgets are met, `realtime` stays within 300 KB in one texture and its three mappings are exact where
# shaders read them, a second run takes everything from the cache.
. "$(dirname "$0")/scratch.sh"

# Kept for test_readme_slow.sh, which runs after this and packs one of them again.
cache=${LACQUER_BUILD:-$root/build/release}/test-cache/lacquer
rm -rf "$cache"
mkdir -p "$cache"
for recipe in dfg realtime; do # the others: test_pack_papers_long.sh
    "$lacquer" pack "$root/recipes/$recipe.json" -o "$recipe" --cache "$cache" >"$recipe.txt" || fail "$recipe"
done
stat -c '%n %y' "$cache"/* >before.txt
"$lacquer" pack "$root/recipes/realtime.json" -o again --cache "$cache" >again.txt
stat -c '%n %y' "$cache"/* | diff before.txt - || fail "the second run computed something"
diff -r realtime again && diff realtime.txt again.txt || fail "the second run"

"$lacquer" validate realtime --points 3000 >certificate.txt || fail "its certificate: $(cat certificate.txt)"
[ "$(grep -c '^passed$' certificate.txt)" = 12 ] || fail "twelve tables: $(cat certificate.txt)"

# No table misses a figure that the issue of budgets names, whatever the recipe says of itself.
bytes=$(awk '/^the atlas/ { print $3 }' realtime.txt)
[ "$bytes" -gt 100000 ] && [ "$bytes" -le 300000 ] || fail "realtime takes $bytes bytes"
awk 'NR > 1 && !/^the atlas/ { n++; if (!($4 > 0 && $4 <= 2e-3 && $5 > 0 && $5 <= 1e-2)) bad = bad " " $1 }
     END { if (n != 12 || bad) { print n " tables, missed:" bad; exit 1 } }' realtime.txt || fail "$(cat realtime.txt)"

# The shipped shaders on a software GPU; 77: there is none.
code=0
"${LACQUER_BUILD:-$root/build/release}/test_pack_gl_shipped" "$PWD/realtime" >gl.txt 2>&1 || code=$?
[ "$code" = 0 ] || [ "$code" = 77 ] || fail "$(cat gl.txt)"

# --------------------------------------------------- the mappings, through the shipped C
cat >use.c <<'END_OF_C'
#include <math.h>
#include <stdio.h>
#include "realtime/atlas.h"
#include "realtime/decode.h"
int main(void) {
    double worst = 0.0;
    for (int i = 0; i <= 1000; i++) { /* where both are stored: f from 0.001 to 1000 */
        const float alpha = 0.04f + 0.84f * (float)i / 1000.0f;
        const float back = lacquer_f_inverse(lacquer_atlas_texels, lacquer_f(lacquer_atlas_texels, alpha));
        worst = fmax(worst, fabs((double)back / (double)alpha - 1.0));
    }
    printf("%.3e %.5f %.5f\n", worst, (double)lacquer_f(lacquer_atlas_texels, 0.3f),
           (double)lacquer_sigma_g(lacquer_atlas_texels, 0.8f));
    return 0;
}
END_OF_C
"${CC:-cc}" -std=c17 -Wall -Wextra -Werror -I. use.c -o use -lm
read -r there_and_back f sigma <<<"$(./use)"
# f and sigma_g: the fitted forms of docs/fit.md with their coefficients for GGX, within 0.48 % and 0.86 % of the curves.
awk -v r="$there_and_back" -v f="$f" -v s="$sigma" 'function form(a, b, c, d, u, p) {
        return a * (exp(b * (u ^ d / (1 - u ^ d)) ^ c) - 1) ^ (p / (c * d)) }
    function off(x, y) { return x > y ? x / y - 1 : y / x - 1 }
    BEGIN { fe = form(1.11814, 5.54729, 0.955994, 4.38122, 1.286962 * 0.3 / (sqrt(0.3) + 0.286962), 2)
            se = form(1.10409, 6.36685, 0.952812, 2.10076, 0.427389 * 0.2 / (1 - 0.572611 * 0.2), 1)
            print r, f, fe, s, se
            exit !(r > 0 && r < 3e-3 && off(f, fe) < 7e-3 && off(s, se) < 1.1e-2) }' || fail "the mappings"

# --------------------------------------------------- a dielectric over a metal, from the shipped textures
cat >layered.c <<'END_OF_C'
#include <stdio.h>
#include <stdlib.h>
#include "realtime/atlas.h"
#include "realtime/decode.h"
int main(int count, char **mu) {
    const lacquer_vec3 tau = {1.0f, 1.0f, 1.0f}, n = {0.2f, 0.2f, 0.2f}, kappa = {3.9f, 3.9f, 3.9f};
    for (int i = 1; i < count; i++) {
        const lacquer_lobes l =
            lacquer_layered(lacquer_atlas_texels, strtof(mu[i], NULL), 0.2f, 1.5f, tau, 0.05f, n, kappa);
        printf("%s %.6f %.6f %.6f\n", mu[i], (double)l.top.x, (double)l.inner.x, (double)l.inner_alpha);
    }
    return 0;
}
END_OF_C
"${CC:-cc}" -std=c17 -Wall -Wextra -Werror -I. layered.c -o layered -lm
./layered 1 0.6 0.15 >shader.txt
"$lacquer" stack "$root/recipes/stacks/frosted-metal.json" --mu 1,0.6,0.15 --model b18-forward >model.txt
# The same model from exact tables: energies within what its tables may be off by, roughness within 1 %.
awk 'NR == FNR { if ($2 == 1) top[$1] = $3; if ($2 == 2) { inner[$1] = $3; alpha[$1] = $6 } next }
     function off(x, y) { return x > y ? x - y : y - x }
     { rows++; if (!(off($2, top[$1]) <= 2e-3 && off($3, inner[$1]) <= 1e-2 && off($4, alpha[$1]) <= 1e-2 * alpha[$1])) bad = bad " " $0 }
     END { if (rows != 3 || bad) { print rows " rows, apart:" bad; exit 1 } }' model.txt shader.txt || fail "$(cat model.txt shader.txt)"
