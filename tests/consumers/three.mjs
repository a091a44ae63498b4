// Loads KTX2 files with the KTX2Loader of three.js in headless Chromium, draws every texel into a float target and
// compares what is read back with the .npy of the same pack.
//     node three.mjs CHROMIUM DIR FILE.ktx2...
import { join } from 'node:path';
import { open } from './browser.mjs';
import { readNpy } from './npy.mjs';

const [chromium, folder, ...files] = process.argv.slice(2);

// The value of a half: what a float target shows of it.
function value(half) {
    const sign = half & 0x8000 ? -1 : 1, exponent = half >> 10 & 31, mantissa = half & 1023;
    return sign * (exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa * 2 ** -24);
}

function report(results) {
    for (const { file, error, type, width, height, depth, channels, pixels } of results) {
        if (error) {
            console.log(file, error);
            continue;
        }
        const { halves } = readNpy(join(folder, file.replace(/(\.zstd)?\.ktx2$/, '.npy')));
        let wrong = pixels.length / 4 * channels === halves.length ? 0 : Infinity;
        for (let i = 0; i < halves.length; i++)
            if (pixels[Math.floor(i / channels) * 4 + i % channels] !== value(halves[i])) wrong++;
        console.log(file, type, width, height, depth, channels, wrong === 0 ? 'same' : `${wrong} values differ`);
    }
    return 0;
}

open(chromium, `three.html?${files.join(',')}`, { folders: { pack: folder }, report });
