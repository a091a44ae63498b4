// Loads KTX2 files with the KTX2Loader of three.js in headless Chromium, draws every texel into a float target and
// compares what is read back with the .npy of the same pack. Serves pages and files itself.
//     node three.mjs CHROMIUM DIR FILE.ktx2...
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { dirname, extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { readNpy } from './npy.mjs';

const [chromium, folder, ...files] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const profile = mkdtempSync(join(tmpdir(), 'lacquer-chromium-'));
const types = { '.js': 'text/javascript', '.mjs': 'text/javascript', '.html': 'text/html', '.wasm': 'application/wasm' };

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
}

// Chromium and its helpers are one process group; its profile goes once they are gone.
function finish(code) {
    browser.removeAllListeners('exit');
    server.close();
    const leave = () => {
        try {
            rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
        } finally {
            process.exit(code);
        }
    };
    if (browser.exitCode !== null || browser.signalCode !== null) return leave();
    browser.on('exit', leave);
    process.kill(-browser.pid, 'SIGKILL');
}

const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    if (request.method === 'POST') {
        let body = '';
        request.on('data', part => body += part);
        request.on('end', () => {
            response.end();
            report(JSON.parse(body));
            finish(0);
        });
        return;
    }
    try {
        const from = path.startsWith('/pack/') ? join(folder, path.slice(6)) : join(here, path);
        const bytes = readFileSync(from);
        response.writeHead(200, { 'Content-Type': types[extname(path)] ?? 'application/octet-stream' });
        response.end(bytes);
    } catch {
        response.writeHead(404).end();
    }
});

let browser;
server.listen(0, '127.0.0.1', () => {
    const page = `http://127.0.0.1:${server.address().port}/three.html?${files.join(',')}`;
    browser = spawn(chromium, ['--headless', '--no-sandbox', '--disable-dev-shm-usage', '--use-gl=angle',
        '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-first-run', '--disable-extensions',
        '--disable-background-networking', `--user-data-dir=${profile}`, '--remote-debugging-port=0', page],
        { stdio: ['ignore', 'ignore', 'pipe'], detached: true });
    let said = '';
    browser.stderr.on('data', part => said += part);
    browser.on('error', error => {
        console.error(`${chromium}: ${error.message}`);
        rmSync(profile, { recursive: true });
        process.exit(1);
    });
    browser.on('exit', code => {
        console.error(`${chromium} ended with ${code} before it had drawn:\n${said}`);
        finish(1);
    });
    setTimeout(() => {
        console.error(`no answer from ${chromium} in 100 s:\n${said}`);
        finish(1);
    }, 100000);
});
