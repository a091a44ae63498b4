// Draws docs/examples/spheres.mjs in headless Chromium and prints every pixel of a sphere: which, its three cosines, its
// colour. Tests give them to spheres.c.
//     node spheres.mjs CHROMIUM DIR
import { open } from './browser.mjs';

const [chromium, pack] = process.argv.slice(2);

function report({ error, colors, cosines }) {
    if (error) {
        console.error(error);
        return 1;
    }
    for (let i = 0; i < cosines.length; i += 4)
        if (cosines[i + 3] > 0)
            console.log(cosines[i + 3] - 1, ...cosines.slice(i, i + 3), ...colors.slice(i, i + 3));
    return 0;
}

open(chromium, 'spheres.html', { folders: { pack, examples: 'docs/examples' }, report });
