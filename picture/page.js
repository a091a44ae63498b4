// Draws a page of `lacquer view`: a table to be cut along any two axes, and panels of maps, curves and areas.
// Everything comes from the JSON of the page's element "data"; picture/page.c says what is in it.
'use strict';
(() => {
const data = JSON.parse(document.getElementById('data').textContent);
const clamp = (v, low, high) => Math.min(Math.max(v, low), high);
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const figure = v => Number.isFinite(v) ? String(+v.toPrecision(6)) : 'no number';

function element(tag, attributes = {}, ...children) {
    const made = Object.assign(document.createElement(tag), attributes);
    made.append(...children);
    return made;
}

// ------------------------------------------------------------------------------- numbers

function floats(base64) {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    const view = new DataView(bytes.buffer), values = new Float32Array(bytes.length / 4);
    for (let i = 0; i < values.length; i++) values[i] = view.getFloat32(4 * i, true);
    return values;
}

// An axis is drawn in its own map: u in [0,1]. Nodes are evenly spaced in it, unless some were left out.
const whereIs = (axis, i) => axis.at ? axis.at[i] : axis.nodes.length > 1 ? i / (axis.nodes.length - 1) : 0;

// The fractional number of the node at u.
function nodeAt(axis, u) {
    const last = axis.nodes.length - 1;
    if (!axis.at) return u * last;
    let i = 0;
    while (i < last - 1 && axis.at[i + 1] <= u) i++;
    return i + clamp((u - axis.at[i]) / (axis.at[i + 1] - axis.at[i]), 0, 1);
}

function valueAt(axis, u) {
    const last = axis.nodes.length - 1, low = axis.nodes[0], high = axis.nodes[last];
    if (last === 0) return low;
    if (axis.exponent > 0) return low + (high - low) * u ** axis.exponent;
    const at = nodeAt(axis, u), i = Math.min(Math.floor(at), last - 1);
    return axis.nodes[i] + (axis.nodes[i + 1] - axis.nodes[i]) * (at - i);
}

function placeOf(axis, value) {
    const last = axis.nodes.length - 1, low = axis.nodes[0], high = axis.nodes[last];
    if (last === 0) return 0;
    if (axis.exponent > 0) return clamp((value - low) / (high - low), 0, 1) ** (1 / axis.exponent);
    let i = 0;
    while (i < last - 1 && axis.nodes[i + 1] <= value) i++;
    const f = clamp((value - axis.nodes[i]) / (axis.nodes[i + 1] - axis.nodes[i]), 0, 1);
    return whereIs(axis, i) + (whereIs(axis, i + 1) - whereIs(axis, i)) * f;
}

const linear = (low, high) => ({ nodes: [low, high], exponent: 1, size: 2 });

// Round values at least `gap` apart, by the rules of picture/ticks.c.
function ticks(axis, gap) {
    const low = axis.nodes[0], high = axis.nodes[axis.nodes.length - 1], even = axis.exponent === 1;
    if (axis.nodes.length < 2) return [{ value: low, at: 0, text: figure(low) }];
    gap = Math.max(gap, 1 / 30) * (1 - 1e-9);
    const start = 10 ** Math.ceil(Math.log10(high - low));
    let list = [];
    const near = at => list.reduce((least, t) => Math.min(least, Math.abs(t.at - at)), Infinity);
    const interval = at => list.filter(t => t.at < at).length;
    for (let s = 0; s < 12; s++) {
        const step = start * [1, 0.5, 0.2][s % 3] * 10 ** -Math.floor(s / 3);
        const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
        const all = [];
        for (let k = first; k <= last && all.length < 32768; k++)
            all.push({ value: k * step, at: placeOf(axis, k * step), text: figure(k * step) });
        if (all.every((t, i) => i === 0 || t.at - all[i - 1].at >= gap)) {
            list = all;
            continue;
        }
        const full = new Set();
        all.forEach((t, i) => {
            const room = near(t.at);
            if (room >= 1e-9 && (room < gap || i > 0 && t.at - all[i - 1].at < gap)) full.add(interval(t.at));
        });
        const added = [];
        for (const t of all) {
            const last = added.length ? t.at - added[added.length - 1].at : Infinity;
            const wanted = even ? !full.has(interval(t.at)) : t.value - low <= 10 * step;
            if (wanted && near(t.at) >= gap && last >= gap) added.push(t);
        }
        list = list.concat(added).sort((a, b) => a.at - b.at);
    }
    return list;
}

// The ends of a scale, as picture/figure.c sets them.
function rangeOf(values) {
    let low = Infinity, high = -Infinity;
    for (const v of values) if (Number.isFinite(v)) low = Math.min(low, v), high = Math.max(high, v);
    if (!(low <= high)) low = 0, high = 1;
    const signed = low < 0 && high > 0;
    if (signed) high = Math.max(high, -low), low = -high;
    const least = Math.max(1e-6 * Math.max(Math.abs(low), Math.abs(high)), 1e-30);
    if (high - low < least) low -= least / 2, high += least / 2;
    return { low, high, signed };
}

// ------------------------------------------------------------------------------- colours

const steps = hex => Array.from({ length: hex.length / 6 }, (_, i) =>
    [0, 2, 4].map(k => parseInt(hex.slice(6 * i + k, 6 * i + k + 2), 16)));
const { colours } = data;
const maps = { value: steps(colours.value), signed: steps(colours.signed), bad: steps(colours.bad)[0] };
const isDark = () => matchMedia('(prefers-color-scheme: dark)').matches;

function colour(scale, v) {
    if (!Number.isFinite(v)) return maps.bad;
    const t = clamp((v - scale.low) / (scale.high - scale.low), 0, 1);
    return maps[scale.signed ? 'signed' : 'value'][Math.round(255 * t)];
}

function seriesColour(panel, i) {
    const count = panel.series.length - (panel.reference ? 1 : 0), dark = isDark();
    if (i === count) return css('--axis');
    if (!panel.ordered && count <= 4) return css('--hue' + i);
    const from = dark ? 0.38 : 0.25, t = from + (dark ? 0.57 : 0.6) * i / Math.max(count - 1, 1);
    return `rgb(${maps.value[Math.round(255 * t)]})`;
}

// ------------------------------------------------------------------------------- drawing

// A canvas as wide as its place, and the plot inside it, in px.
function begin(canvas, ratio, right) {
    const scale = window.devicePixelRatio || 1, width = Math.max(canvas.clientWidth, 200);
    const plot = { x: 60, y: 12, width: width - 60 - right, height: 0 };
    plot.height = Math.round(plot.width * ratio);
    const height = plot.height + 56;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    canvas.style.height = height + 'px';
    const c = canvas.getContext('2d');
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, width, height);
    c.font = '12px system-ui, sans-serif';
    return { c, plot, scale };
}

function text(c, words, x, y, align, ink) {
    c.textAlign = align;
    c.fillStyle = css(ink);
    c.fillText(words, x, y);
}

function line(c, ...points) {
    c.beginPath();
    for (let i = 0; i < points.length; i += 2) c.lineTo(points[i], points[i + 1]);
    c.stroke();
}

function frame(c, p) {
    c.strokeStyle = css('--axis');
    c.lineWidth = 1;
    c.strokeRect(p.x - 0.5, p.y - 0.5, p.width + 1, p.height + 1);
}

const axisName = axis => axis.name + ' (' + axis.size + ' nodes' + (axis.map ? ', ' + axis.map : '') + ')';

function xAxis(c, p, axis) {
    const bottom = p.y + p.height + 1;
    c.strokeStyle = css('--axis');
    if (p.width / axis.nodes.length >= 3)
        axis.nodes.forEach((_, i) => {
            const x = p.x + p.width * whereIs(axis, i);
            line(c, x, bottom, x, bottom + 2.5);
        });
    for (const t of ticks(axis, 40 / p.width)) {
        line(c, p.x + p.width * t.at, bottom, p.x + p.width * t.at, bottom + 6);
        text(c, t.text, p.x + p.width * t.at, bottom + 19, 'center', '--soft');
    }
    text(c, axisName(axis), p.x + p.width / 2, bottom + 37, 'center', '--ink');
}

function yLabel(c, p, words) {
    c.save();
    c.translate(10, p.y + p.height / 2);
    c.rotate(-Math.PI / 2);
    text(c, words, 0, 0, 'center', '--ink');
    c.restore();
}

function yAxis(c, p, axis) {
    c.strokeStyle = css('--axis');
    if (p.height / axis.nodes.length >= 3)
        axis.nodes.forEach((_, i) => {
            const y = p.y + p.height * (1 - whereIs(axis, i));
            line(c, p.x - 1, y, p.x - 3.5, y);
        });
    for (const t of ticks(axis, 24 / p.height)) {
        const y = p.y + p.height * (1 - t.at);
        line(c, p.x - 1, y, p.x - 7, y);
        text(c, t.text, p.x - 10, y + 4, 'right', '--soft');
    }
    yLabel(c, p, axisName(axis));
}

function bar(c, p, scale) {
    const x = p.x + p.width + 12, rows = Math.round(p.height);
    for (let i = 0; i < rows; i++) {
        c.fillStyle = `rgb(${colour(scale, scale.high + (scale.low - scale.high) * i / (rows - 1))})`;
        c.fillRect(x, p.y + i, 12, 1);
    }
    frame(c, { x, y: p.y, width: 12, height: p.height });
    for (const t of ticks(linear(scale.low, scale.high), 30 / p.height)) {
        const y = p.y + p.height * (1 - t.at);
        line(c, x + 13, y, x + 17, y);
        text(c, t.text, x + 20, y + 4, 'left', '--soft');
    }
}

// Two nodes and the share of the second.
function between(axis, u) {
    const last = axis.nodes.length - 1;
    if (last === 0) return [0, 0, 0];
    const at = nodeAt(axis, u), low = Math.min(Math.floor(at), last - 1);
    return [low, low + 1, at - low];
}
const mix = (a, b, f) => f === 0 ? a : f === 1 ? b : a + (b - a) * f;

function mapValue(map, u, v) {
    const [x0, x1, fx] = between(map.x, u), [y0, y1, fy] = between(map.y, v), w = map.x.nodes.length;
    return mix(mix(map.values[y0 * w + x0], map.values[y0 * w + x1], fx),
               mix(map.values[y1 * w + x0], map.values[y1 * w + x1], fx), fy);
}

function drawMap(canvas, map, ratio) {
    const { c, plot: p, scale } = begin(canvas, ratio, 76);
    const left = Math.round(p.x * scale), top = Math.round(p.y * scale);
    const width = Math.round(p.width * scale), height = Math.round(p.height * scale);
    const image = c.createImageData(width, height), columns = [], w = map.x.nodes.length;
    for (let i = 0; i < width; i++) columns.push(between(map.x, i / (width - 1)));
    for (let j = 0, k = 0; j < height; j++) {
        const [y0, y1, fy] = between(map.y, 1 - j / (height - 1));
        for (const [x0, x1, fx] of columns) {
            const rgb = colour(map, mix(mix(map.values[y0 * w + x0], map.values[y0 * w + x1], fx),
                                        mix(map.values[y1 * w + x0], map.values[y1 * w + x1], fx), fy));
            for (const part of rgb) image.data[k++] = part;
            image.data[k++] = 255;
        }
    }
    c.putImageData(image, left, top);
    frame(c, p);
    xAxis(c, p, map.x);
    yAxis(c, p, map.y);
    bar(c, p, map);
    return p;
}

// Sums of the series below number `s` at node `i`.
const below = (panel, s, i) => {
    let sum = 0;
    for (let k = 0; k < s; k++) sum += panel.values[k * panel.x.nodes.length + i];
    return sum;
};

function drawSeries(c, panel, p, s, x, y) {
    const n = panel.x.nodes.length, last = panel.reference && s === panel.series.length - 1;
    c.strokeStyle = c.fillStyle = seriesColour(panel, s);
    c.lineWidth = 2;
    c.setLineDash(last ? [5, 4] : []);
    c.beginPath();
    if (panel.form === 'areas') {
        for (let i = 0; i < n; i++) c.lineTo(x(i), y(below(panel, s, i)));
        for (let i = n - 1; i >= 0; i--) c.lineTo(x(i), y(below(panel, s + 1, i)));
        c.fill();
    } else {
        for (let i = 0, drawn = false; i < n; i++) {
            const v = panel.values[s * n + i];
            if (!Number.isFinite(v)) drawn = false;
            else c[drawn ? 'lineTo' : 'moveTo'](x(i), y(v)), drawn = true;
        }
        c.stroke();
    }
    c.setLineDash([]);
}

function names(c, panel, p) {
    const count = panel.series.length, every = Math.ceil(count / Math.max(1, Math.floor(p.height / 18)));
    let y = p.y + 10;
    for (let k = 0; count > 1 && k < count; k++) {
        const i = panel.form === 'areas' ? count - 1 - k : k;
        if (i % every) continue;
        c.fillStyle = seriesColour(panel, i);
        c.fillRect(p.x + p.width + 10, y - 9, 11, 11);
        text(c, panel.series[i], p.x + p.width + 26, y, 'left', '--ink');
        y += 18;
    }
}

// Where a value of a chart lies; curves keep clear of the frame above and below.
function placer(panel, p) {
    const inset = panel.form === 'lines' ? 6 : 0;
    return v => p.y + inset + (p.height - 2 * inset) * (1 - (v - panel.low) / (panel.high - panel.low));
}

function drawChart(canvas, panel, ratio) {
    const { c, plot: p } = begin(canvas, ratio, panel.series.length > 1 ? 96 : 20);
    const x = i => p.x + p.width * whereIs(panel.x, i);
    const y = placer(panel, p);
    for (const t of ticks(linear(panel.low, panel.high), 26 / p.height)) {
        c.strokeStyle = css('--grid');
        line(c, p.x, y(t.value), p.x + p.width, y(t.value));
        text(c, t.text, p.x - 8, y(t.value) + 4, 'right', '--soft');
    }
    c.save();
    c.beginPath();
    c.rect(p.x, p.y - 1, p.width, p.height + 2);
    c.clip();
    panel.series.forEach((_, s) => drawSeries(c, panel, p, s, x, y));
    c.restore();
    frame(c, p);
    xAxis(c, p, panel.x);
    yLabel(c, p, panel.quantity);
    names(c, panel, p);
    return p;
}

// ------------------------------------------------------------------------------- panels

// Where the pointer is in a plot, or null.
function place(event, canvas, p) {
    const box = canvas.getBoundingClientRect();
    const u = (event.clientX - box.left - p.x) / p.width, v = 1 - (event.clientY - box.top - p.y) / p.height;
    return u < -0.02 || u > 1.02 || v < -0.02 || v > 1.02 ? null : [clamp(u, 0, 1), clamp(v, 0, 1)];
}

function read(panel, u, v) {
    const at = panel.x.name + ' ' + figure(valueAt(panel.x, u));
    if (panel.form === 'map')
        return `${at}, ${panel.y.name} ${figure(valueAt(panel.y, v))}: ${figure(mapValue(panel, u, v))}`;
    const [low, high, f] = between(panel.x, u), n = panel.x.nodes.length;
    return at + ': ' + panel.series.map((name, s) => (panel.series.length > 1 ? name + ' ' : '') +
        figure(mix(panel.values[s * n + low], panel.values[s * n + high], f))).slice(0, 8).join(', ');
}

function addPanel(panel, home) {
    panel.values = floats(panel.values);
    const canvas = element('canvas'), value = element('p', { className: 'value' });
    home.append(element('section', {}, element('h3', { textContent: panel.title }),
                        element('p', { textContent: panel.caption }), canvas, value));
    let plot = null;
    const draw = () => { plot = (panel.form === 'map' ? drawMap : drawChart)(canvas, panel, 0.68); };
    canvas.addEventListener('pointermove', event => {
        const at = place(event, canvas, plot);
        value.textContent = at ? read(panel, ...at) : '';
    });
    canvas.addEventListener('pointerleave', () => { value.textContent = ''; });
    return draw;
}

// ------------------------------------------------------------------------------- the table

const table = data.table, axes = table ? table.axes : [];
const free = axes.map((_, i) => i).filter(i => axes[i].nodes.length > 1); // of several nodes
const state = {}; // axes x and y (-1: none) of the map, along of the curve; channel; whole: the scale; point u

function start() {
    table.values = table.values.map(floats);
    const { x, y, channel, at } = table.start;
    const u = axes.map((axis, i) => i === x || i === y ? 0.5 : placeOf(axis, at[i]));
    Object.assign(state, { x, y, channel, along: -1, whole: false, u });
}

// Multilinear at a point of places, as the table's own look-up.
function lookup(u) {
    const values = table.values[state.channel];
    let list = [[0, 1]], stride = 1; // offsets of entries and their weights
    axes.forEach((axis, a) => {
        const [low, high, f] = between(axis, u[a]), step = stride;
        list = list.flatMap(([offset, weight]) => [[offset + low * step, weight * (1 - f)],
                                                   [offset + high * step, weight * f]]);
        list = list.filter(([, weight]) => weight > 0);
        stride *= axis.nodes.length;
    });
    return list.reduce((sum, [offset, weight]) => sum + weight * values[offset], 0);
}

// Values at the nodes of axis x, and of y where there is one, through the point.
function slice(x, y) {
    const columns = axes[x].nodes.length, rows = y < 0 ? 1 : axes[y].nodes.length;
    const values = new Float32Array(columns * rows), u = state.u.slice();
    for (let i = 0; i < values.length; i++) {
        u[x] = whereIs(axes[x], i % columns);
        if (y >= 0) u[y] = whereIs(axes[y], Math.floor(i / columns));
        values[i] = lookup(u);
    }
    return values;
}

function scaleOf(values) {
    if (!table.range) return rangeOf(state.whole ? table.values[state.channel] : values);
    const [low, high] = table.range;
    return { low, high, signed: low === -high };
}

const heat = element('canvas', { id: 'map', tabIndex: 0 }), curve = element('canvas', { id: 'curve' });
const value = element('p', { className: 'value', id: 'value' }), controls = element('div', { id: 'controls' });
const curveTitle = element('h2', { id: 'curve-title' });
let plot = null, bare = null; // of the map: where it is, and its pixels without the mark

function drawCurve() {
    const axis = axes[state.along], values = slice(state.along, -1), { low, high } = scaleOf(values);
    const name = table.channels[state.channel];
    curveTitle.textContent = `Along ${axis.name}, through the point`;
    const panel = { form: 'lines', series: [name], quantity: name, x: axis, values, low, high };
    const p = drawChart(curve, panel, 0.32), c = curve.getContext('2d');
    c.fillStyle = css('--accent');
    c.beginPath();
    c.arc(p.x + p.width * state.u[state.along], placer(panel, p)(lookup(state.u)), 4, 0, 7);
    c.fill();
}

function markPoint() {
    const c = heat.getContext('2d');
    c.putImageData(bare, 0, 0);
    for (const [ink, width] of [['#000', 3], ['#fff', 1.5]]) {
        c.strokeStyle = ink;
        c.lineWidth = width;
        c.beginPath();
        c.arc(plot.x + plot.width * state.u[state.x], plot.y + plot.height * (1 - state.u[state.y]), 5, 0, 7);
        c.stroke();
    }
}

function drawPoint() {
    if (state.y >= 0) markPoint();
    const at = free.map(i => axes[i].name + ' ' + figure(valueAt(axes[i], state.u[i]))).join(', ');
    const number = element('b', { textContent: figure(lookup(state.u)) });
    value.replaceChildren(number, ` ${table.channels[state.channel]} at ${at}`);
    drawCurve();
}

function drawTable() {
    heat.hidden = state.y < 0;
    if (state.y >= 0) {
        const values = slice(state.x, state.y);
        plot = drawMap(heat, { x: axes[state.x], y: axes[state.y], values, ...scaleOf(values) }, 0.72);
        bare = heat.getContext('2d').getImageData(0, 0, heat.width, heat.height);
    }
    drawPoint();
}

function move(u, v) {
    state.u[state.x] = u;
    state.u[state.y] = v;
    drawPoint();
}

function followPointer(event) {
    const at = place(event, heat, plot);
    if (at) move(...at);
}

function followKey(event) {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!by) return;
    event.preventDefault();
    move(...[state.x, state.y].map((a, k) => clamp(state.u[a] + by[k] / (axes[a].size - 1), 0, 1)));
}

// ------------------------------------------------------------------------------- its controls

function choose(id, label, list, current, take) {
    const made = element('select', { id });
    for (const [v, words] of list)
        made.append(element('option', { value: v, textContent: words, selected: v === current }));
    made.addEventListener('change', () => {
        take(+made.value);
        layOut();
        drawTable();
    });
    controls.append(element('label', {}, label, made));
}

function slider(a) {
    const axis = axes[a], shown = element('output', { textContent: figure(valueAt(axis, state.u[a])) });
    const range = element('input', { type: 'range', id: 'at-' + axis.name, min: 0, max: 1, step: 0.001 });
    range.value = state.u[a];
    range.addEventListener('input', () => {
        state.u[a] = +range.value;
        shown.textContent = figure(valueAt(axis, state.u[a]));
        drawTable();
    });
    controls.append(element('label', { className: 'slider', title: axis.meaning }, axis.name, range, shown));
}

function scaleBox() {
    const box = element('input', { type: 'checkbox', id: 'whole', checked: state.whole });
    box.addEventListener('change', () => {
        state.whole = box.checked;
        drawTable();
    });
    controls.append(element('label', { className: 'check' }, box, 'scale of the whole table'));
}

// An axis of the map; where it is the other one's, they are exchanged.
function chooseAxis(id, label, mine, other) {
    choose(id, label, free.map(i => [i, axes[i].name]), state[mine], v => {
        if (v === state[other]) state[other] = state[mine];
        state[mine] = v;
    });
}

function layOut() {
    const rest = free.filter(i => i !== state.x && i !== state.y);
    if (state.along < 0) state.along = rest.length ? rest[0] : state.x;
    controls.replaceChildren();
    if (state.y >= 0) {
        chooseAxis('axis-x', 'right', 'x', 'y');
        chooseAxis('axis-y', 'up', 'y', 'x');
        choose('along', 'curve along', free.map(i => [i, axes[i].name]), state.along, v => { state.along = v; });
    }
    if (table.channels.length > 1)
        choose('channel', 'channel', [...table.channels.entries()], state.channel, v => { state.channel = v; });
    (state.y >= 0 ? rest : free).forEach(slider);
    if (!table.range) scaleBox();
    for (const axis of axes) {
        const fixed = axis.nodes.length === 1 ? ' = ' + figure(axis.nodes[0]) : '';
        const words = axis.name + fixed + (axis.meaning ? ': ' + axis.meaning : '');
        if (words !== axis.name) controls.append(element('p', { textContent: words }));
    }
}

function addTable() {
    start();
    layOut();
    heat.setAttribute('aria-label', 'map of the slice; arrow keys move the point');
    heat.addEventListener('pointermove', followPointer);
    heat.addEventListener('pointerdown', followPointer);
    heat.addEventListener('keydown', followKey);
    const pictures = element('div', {}, value, heat, curveTitle, curve);
    document.getElementById('main').append(element('div', { id: 'explorer' }, pictures, controls));
}

const draws = [];
if (table) {
    addTable();
    draws.push(drawTable);
}
const home = document.getElementById('panels');
for (const panel of data.panels) draws.push(addPanel(panel, home));
const drawAll = () => draws.forEach(draw => draw());
let width = document.body.clientWidth;
drawAll();
new ResizeObserver(() => requestAnimationFrame(() => {
    if (document.body.clientWidth === width) return;
    width = document.body.clientWidth;
    drawAll();
})).observe(document.body);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawAll);
})();
