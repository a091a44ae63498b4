// Decodes a pack of tests/consumers/scene.json in headless Chromium, in WebGPU and WebGL2, and compares with what the
// shipped C decoder printed (scene.c).
//     node scene.mjs CHROMIUM DIR POINTS.json
import { readFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { open, webgpu } from './browser.mjs';

const [chromium, folder, file] = process.argv.slice(2);
const points = JSON.parse(readFileSync(file));

// SwiftShader, Chromium's software GPU, filters half floats with full weights, as the C decoder does.
const TOLERANCE = 1e-5;
const MAGENTA = [1, 0, 1, 1];

// The largest difference, relative where values are larger than 1; NaN is infinitely far.
function apart(values, wanted) {
    return Math.max(...wanted.map((w, k) => {
        const off = Math.abs(values[k] - w) / Math.max(1, Math.abs(w));
        return off >= 0 ? off : Infinity;
    }));
}

function compare({ name, check, error, values }) {
    if (error) return { name, worst: Infinity, error };
    let worst = 0;
    points.forEach(({ subject, outside, values: wanted }, i) => {
        if (check && subject === 'tables') return;
        const got = values.slice(16 * i, 16 * i + 16);
        worst = Math.max(worst, check && outside ? apart(got, MAGENTA) : apart(got, wanted));
    });
    return { name, worst };
}

function report(results) {
    if (!results.some(r => r.values)) return results.some(r => r.error) ? (console.log(results), 1) : 77;
    let failed = 0;
    for (const result of results) {
        if (result.values === null) {
            console.log(result.name, 'is not there: not tested');
            continue;
        }
        const { name, worst, error } = compare(result);
        console.log(name, result.check ? 'LACQUER_CHECK' : 'decodes', `${points.length} points`, worst.toExponential(1), error ?? '');
        if (!(worst <= TOLERANCE)) failed = 1;
    }
    return failed;
}

open(chromium, 'scene.html', { folders: { pack: folder, points: dirname(file) }, flags: webgpu, report });
