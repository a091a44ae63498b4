// Opens a page in headless Chromium, serves it and what it asks for, and takes what it posts.
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { dirname, extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const types = { '.js': 'text/javascript', '.mjs': 'text/javascript', '.html': 'text/html', '.wasm': 'application/wasm' };

export const webgl = ['--headless', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
export const webgpu = ['--headless=new', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader',
    '--enable-features=Vulkan', '--use-vulkan=swiftshader', '--disable-vulkan-surface', '--enable-unsafe-swiftshader'];

// `folders`: what stands under a first part of an address, {pack: DIR}; all else is beside this file. `report` takes
// what the page posts and returns an exit code. Does not return.
export function open(chromium, page, { folders = {}, flags = webgl, report }) {
    const profile = mkdtempSync(join(tmpdir(), 'lacquer-chromium-'));
    let browser;

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
                finish(report(JSON.parse(body)));
            });
            return;
        }
        try {
            const first = path.split('/')[1];
            const bytes = readFileSync(first in folders ? join(folders[first], path.slice(first.length + 2)) : join(here, path));
            response.writeHead(200, { 'Content-Type': types[extname(path)] ?? 'application/octet-stream' });
            response.end(bytes);
        } catch {
            response.writeHead(404).end();
        }
    });

    server.listen(0, '127.0.0.1', () => {
        browser = spawn(chromium, [...flags, '--no-sandbox', '--disable-dev-shm-usage', '--no-first-run',
            '--disable-extensions', '--disable-background-networking', `--user-data-dir=${profile}`,
            '--remote-debugging-port=0', `http://127.0.0.1:${server.address().port}/${page}`],
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
}
