#!/usr/bin/env bash
# The page of a scene's pack in headless Chromium: no errors, every material drawn, sliders and albedo change the picture,
# and pack and exact stack differ by no more than the budget wherever the sliders are. Skipped without Chromium.
. "$(dirname "$0")/scratch.sh"
recipes=$root/recipes
chromium=$(command -v chromium || command -v chromium-browser || true)
[ -n "$chromium" ] || { echo "no chromium"; exit 77; }

"$lacquer" pack "$recipes/scene.json" -o pack >/dev/null
[ "$(stat -c %s pack/index.html)" -le 2000000 ] || fail "a page of $(stat -c %s pack/index.html) bytes"
! grep -qE '(src|href)="?(https?:)?//' pack/index.html || fail "the page loads something from elsewhere"

# What is asked of the page, after its own script.
cat >ask.html <<'END'
<script>
const said = [], view = document.getElementById('view');
view.width = 384;
view.height = 128;
for (const m of JSON.parse(document.getElementById('data').textContent).materials) {
    stage.choose(m.name);
    let most = 0, before = '', pictures = new Set();
    for (const share of [0, 0.11, 0.73]) {
        for (const r of m.ranges) stage.state.knobs.set(`${m.name} ${r.name}`, r.min + (r.max - r.min) * share);
        stage.state.rho = [share, 1 - share, 0.5];
        for (const furnace of [false, true]) {
            stage.state.furnace = furnace;
            stage.draw();
            most = Math.max(most, stage.difference());
        }
        stage.state.furnace = false;
        stage.draw();
        pictures.add(document.getElementById('view').toDataURL());
    }
    said.push(`${m.name} ${most.toFixed(4)} ${pictures.size}`);
}
document.getElementById('main').textContent = 'SA' + 'ID|' + said.join('|') + '|ERRORS ' + window.errors + '|';
</script>
END
sed 's|<head>|<head><script>window.errors = 0; window.onerror = () => { window.errors++; }; console.error = () => { window.errors++; };</script>|
     s|<h1>|<div id="main"></div><h1>|' pack/index.html >asked.html
cat ask.html >>asked.html
look() { # FILE
    timeout 300 "$chromium" --headless=new --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
        --user-data-dir="$scratch/profile" --virtual-time-budget=20000 --dump-dom "file://$scratch/$1" 2>/dev/null |
        grep -o 'SAID|[^<]*' | tr '|' '\n'
}
look asked.html >said.txt || fail "the page says nothing"
grep -q '^ERRORS 0$' said.txt || fail "errors in the page: $(cat said.txt)"
[ "$(grep -cE '^[a-z-]+ 0\.[0-9]+ ' said.txt)" = 10 ] || fail "not ten materials: $(cat said.txt)"
# The budget of an energy is 1e-2; three lobes and the reference's own texels may add up to a little more.
awk 'NF == 3 && ($2 > 0.012 || $3 < 2) {print; bad = 1} END {exit bad}' said.txt >bad.txt || fail "too far from the exact stack, or always the same: $(cat bad.txt)"
cat said.txt

# The test can fail: a pack's texel changed in the page is seen.
python3 - <<'END'
import re
text = open('asked.html').read()
at = re.search(r'"atlas":\{"width":\d+,"height":\d+,"texels":"', text).end()
# Every float of a stretch of the first rows becomes 0.
text = text[:at + 1600] + 'A' * 16000 + text[at + 17600:]
open('changed.html', 'w').write(text)
END
look changed.html >changed.txt || fail "the changed page says nothing"
awk 'NF == 3 && $2 > 0.09 {seen = 1} END {exit !seen}' changed.txt || fail "a changed texture goes unseen: $(cat changed.txt)"
