// The stage of a pack's page: a material as the pack's own source and texture shade it, beside the same from a finer
// float texture of the exact stack, and their difference times ten. pack/page.c says what is in the page.
'use strict';
(() => {
const data = JSON.parse(document.getElementById('data').textContent);
const text = id => document.getElementById(id).textContent;
const canvas = document.getElementById('view'), note = document.getElementById('stage-note');
const gl = canvas.getContext('webgl2', { preserveDrawingBuffer: true, antialias: false });
const fail = why => { note.textContent = why; note.hidden = false; };
if (!gl) return fail('This browser has no WebGL2, which the spheres are drawn with. The table below needs none.');

// ------------------------------------------------------------------------------- textures

function floats(base64) {
    const packed = atob(base64), bytes = new Uint8Array(packed.length);
    for (let i = 0; i < packed.length; i++) bytes[i] = packed.charCodeAt(i);
    const view = new DataView(bytes.buffer), values = new Float32Array(bytes.length / 4);
    for (let i = 0; i < values.length; i++) values[i] = view.getFloat32(4 * i, true);
    return values;
}

function upload(unit, { width, height, texels }, format) {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, format, width, height, 0, gl.RGBA, gl.FLOAT, floats(texels));
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
}
// Without linear filtering of floats the reference is rounded to halves, too: the difference is then that of texel counts.
const full = gl.getExtension('OES_texture_float_linear');
upload(0, data.atlas, gl.RGBA16F);
upload(1, data.reference, full ? gl.RGBA32F : gl.RGBA16F);

// ------------------------------------------------------------------------------- shading

// The reference has the same functions under other names, and its own texture.
const reference = text('reference').replace(/\blacquer_/g, 'exact_').replace(/LACQUER_DECODE/g, 'EXACT_DECODE')
    .replace(/struct LacquerLobes\s*\{[^}]*\};/, '');

const sphere = `
uniform sampler2D atlas, exact;
uniform vec4 knob; uniform vec3 rho, towards; uniform float furnace, panels;
in vec2 at; out vec4 colour;
const vec3 up = vec3(0.0, 1.0, 0.0);
// A room of sky, floor and one soft window, the softer the rougher the lobe that looks at it.
vec3 room(vec3 d, float alpha) {
    if (furnace > 0.5) return vec3(1.0);
    float blur = 0.02 + alpha, sky = smoothstep(-blur, blur, d.y);
    float window = exp((dot(d, towards) - 1.0) / (0.02 + alpha * alpha)) * (0.02 + 0.35 * alpha) / (0.02 + alpha * alpha);
    return mix(vec3(0.10, 0.085, 0.075), mix(vec3(0.62, 0.66, 0.72), vec3(0.25, 0.34, 0.52), clamp(d.y, 0.0, 1.0)), sky)
        + vec3(1.0, 0.95, 0.86) * min(window * 2.2, 9.0);
}
vec3 lit(LacquerLobes l, vec3 n, vec3 v, vec3 direct) {
    vec3 r = reflect(-v, n);
    vec3 around = l.top * room(r, l.top_alpha) + 1.6 * direct;
    if (dot(l.inner, vec3(1.0)) > 0.0) around += l.inner * room(r, l.inner_alpha);
    if (dot(l.base, vec3(1.0)) > 0.0) around += l.base * room(n, 1.0);
    return around;
}
vec3 shown(vec3 x) { return pow(clamp(x, 0.0, 1.0), vec3(1.0 / 2.2)); }
vec3 soft(vec3 x) { return furnace > 0.5 ? x : x / (1.0 + 0.35 * x); }
void main() {
    float panel = floor(at.x * panels);
    vec2 p = vec2(fract(at.x * panels), at.y) * 2.2 - 1.1;
    vec3 v = vec3(0.0, 0.0, 1.0), n = vec3(p, sqrt(max(1.0 - dot(p, p), 0.0))), h = normalize(v + towards);
    float mu = n.z, light = dot(n, towards);
    vec3 there = room(normalize(vec3(p * 0.55, -1.0)), 0.25);
    if (dot(p, p) > 1.0) { colour = vec4(panel > 1.5 ? vec3(0.0) : shown(soft(there)), 1.0); return; }
    float half_cosine = max(dot(n, h), 0.0);
    if (panel < 0.5) {
        LacquerLobes a = lacquer_CALL(atlas, mu ARGUMENTS);
        vec3 direct = light > 0.0 && furnace < 0.5 ? lacquer_shade(atlas, a, mu, light, half_cosine) : vec3(0.0);
        colour = vec4(shown(soft(lit(a, n, v, direct))), 1.0);
    } else if (panel < 1.5) {
        LacquerLobes b = exact_CALL(exact, mu ARGUMENTS);
        vec3 direct = light > 0.0 && furnace < 0.5 ? exact_shade(exact, b, mu, light, half_cosine) : vec3(0.0);
        colour = vec4(shown(soft(lit(b, n, v, direct))), 1.0);
    } else {
        // Of energies, which the budget is about, whatever the room shines with.
        LacquerLobes a = lacquer_CALL(atlas, mu ARGUMENTS), b = exact_CALL(exact, mu ARGUMENTS);
        colour = vec4(10.0 * (abs(a.top - b.top) + abs(a.inner - b.inner) + abs(a.base - b.base)), 1.0);
    }
}`;

function compile(type, source) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw Error(gl.getShaderInfoLog(shader));
    return shader;
}

const programs = new Map();
function program(material) {
    if (programs.has(material.name)) return programs.get(material.name);
    const names = material.ranges.map((_, i) => `, knob.${'xy'[i]}`).join('') + (material.rho ? ', rho' : '');
    const main = sphere.replace(/CALL/g, material.function.replace('lacquer_', '')).replace(/ ARGUMENTS/g, names);
    const made = gl.createProgram();
    gl.attachShader(made, compile(gl.VERTEX_SHADER, `#version 300 es
        out vec2 at; void main() { at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0; gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0); }`));
    gl.attachShader(made, compile(gl.FRAGMENT_SHADER,
        '#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n' + text('decode') + reference + main));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw Error(gl.getProgramInfoLog(made));
    programs.set(material.name, made);
    return made;
}

// ------------------------------------------------------------------------------- drawing

const state = { material: data.materials[0], knobs: new Map(), rho: [0.55, 0.32, 0.18], light: 40, height: 45, furnace: false };
const middle = range => range.min + (range.max - range.min) * 0.35;
const value = range => state.knobs.get(`${state.material.name} ${range.name}`) ?? middle(range);

function draw(panels = 3) {
    const { material } = state, turn = state.light * Math.PI / 180, rise = state.height * Math.PI / 180;
    const used = program(material), where = name => gl.getUniformLocation(used, name);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.useProgram(used);
    gl.uniform1i(where('atlas'), 0);
    gl.uniform1i(where('exact'), 1);
    const knob = [...material.ranges.map(value), 0, 0, 0, 0].slice(0, 4);
    gl.uniform4fv(where('knob'), knob);
    gl.uniform3fv(where('rho'), state.rho.map(x => material.rho ? Math.min(Math.max(x, material.rho.min), material.rho.max) : x));
    gl.uniform3f(where('towards'), Math.cos(rise) * Math.sin(turn), Math.sin(rise), Math.cos(rise) * Math.cos(turn));
    gl.uniform1f(where('furnace'), state.furnace ? 1 : 0);
    gl.uniform1f(where('panels'), panels);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
}

// The largest difference on the screen, of energies: a byte is 1/2550.
function difference() {
    const third = Math.floor(canvas.width / 3), pixels = new Uint8Array(4 * third * canvas.height);
    gl.readPixels(canvas.width - third, 0, third, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let most = 0;
    for (let i = 0; i < pixels.length; i++) if (i % 4 < 3 && pixels[i] > most) most = pixels[i];
    return most / 2550;
}

let waiting = false;
function refresh() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
        waiting = false;
        draw();
        document.getElementById('seen').textContent =
            `largest difference seen: ${difference().toFixed(4)}` + (data.max ? `, budget ${data.max}` : '');
    });
}

// ------------------------------------------------------------------------------- knobs

function element(tag, attributes = {}, ...children) {
    const made = Object.assign(document.createElement(tag), attributes);
    made.append(...children);
    return made;
}

function slider(name, min, max, start, change, digits = 3) {
    const shown = element('output', { textContent: start.toFixed(digits) });
    const input = element('input', { type: 'range', min, max, step: (max - min) / 200, value: start });
    input.setAttribute('aria-label', name);
    input.addEventListener('input', () => {
        shown.textContent = (+input.value).toFixed(digits);
        change(+input.value);
        refresh();
    });
    return element('label', {}, name, input, shown);
}

const hex = rho => '#' + rho.map(x => Math.round(255 * x ** (1 / 2.2)).toString(16).padStart(2, '0')).join('');
function rhoPicker() {
    const input = element('input', { type: 'color', value: hex(state.rho) });
    input.setAttribute('aria-label', 'rho');
    input.addEventListener('input', () => {
        state.rho = [1, 3, 5].map(i => (parseInt(input.value.slice(i, i + 2), 16) / 255) ** 2.2);
        refresh();
    });
    return element('label', {}, 'rho', input);
}

function knobs() {
    const { material } = state, box = document.getElementById('knobs'), check = element('input', { type: 'checkbox', checked: state.furnace });
    check.addEventListener('change', () => { state.furnace = check.checked; refresh(); });
    box.replaceChildren(element('h2', { textContent: material.name }),
        ...material.ranges.map(r => slider(r.name.replace(/_/g, ' '), r.min, r.max, value(r), v => state.knobs.set(`${material.name} ${r.name}`, v))),
        ...(material.rho ? [rhoPicker()] : []),
        slider('light', -180, 180, state.light, v => state.light = v, 0), slider('its height', -90, 90, state.height, v => state.height = v, 0),
        element('label', { className: 'check' }, check, 'furnace: light 1 from everywhere; what is lost is dark'),
        element('p', { id: 'seen' }));
    refresh();
}

function choose(material, button) {
    state.material = material;
    for (const other of document.querySelectorAll('#gallery button')) other.setAttribute('aria-pressed', other === button);
    knobs();
}

// Each material once, small.
function gallery() {
    const width = canvas.width, height = canvas.height, box = document.getElementById('gallery');
    canvas.width = canvas.height = 160;
    for (const material of data.materials) {
        state.material = material;
        draw(1);
        const small = element('canvas', { width: 160, height: 160 }), button = element('button', { type: 'button' }, small, material.name);
        small.getContext('2d').drawImage(canvas, 0, 0);
        button.addEventListener('click', () => choose(material, button));
        box.append(button);
    }
    canvas.width = width;
    canvas.height = height;
}

try {
    gallery();
    choose(data.materials[0], document.querySelector('#gallery button'));
    window.stage = { state, draw, difference, choose: name => {
        const i = data.materials.findIndex(m => m.name === name);
        choose(data.materials[i], document.querySelectorAll('#gallery button')[i]);
    } };
} catch (error) {
    fail(`The spheres are not drawn: ${error.message}`);
    throw error;
}
})();
