// SPDX-License-Identifier: Apache-2.0
// How the values of a layer become colours of the screen.
import {halfValues, pixelFor} from "./server.js";

const srgb = x => x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;

// The same curve as image/view_transform.h.
export function viewTransform(linear, film) {
  if (!(linear > 0)) return 0;
  const x = Math.min(linear, 1000);
  if (!film) return srgb(Math.min(x, 1));
  const e = 0.72 * x;
  return srgb(Math.min(e * (2.51 * e + 0.03) / (e * (2.43 * e + 0.59) + 0.14), 1));
}

const tables = new Map();
// Bytes of the screen by the bits of a half float.
function halfBytes(stops, film) {
  const key = `${stops} ${film}`;
  if (!tables.has(key)) {
    if (tables.size > 8) tables.clear();
    const gain = 2 ** stops;
    tables.set(key, Uint8Array.from(halfValues, v => Math.floor(255 * viewTransform(v * gain, film) + 0.5)));
  }
  return tables.get(key);
}

// Polynomial fit to the colour map Turbo (Mikhailov 2019), for t in [0, 1].
function turbo(t) {
  const x = Math.min(Math.max(t, 0), 1);
  const p = c => 255 * Math.min(Math.max(c.reduceRight((sum, k) => sum * x + k, 0), 0), 1);
  return [p([0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943]),
          p([0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604]),
          p([0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973])];
}

// A colour for each number, such that neighbouring numbers differ.
function idColor(id) {
  if (id === 0xffffffff) return [0, 0, 0];  // no strand
  let h = Math.imul(id, 0x9e3779b1) >>> 0;
  h = Math.imul(h ^ (h >>> 15), 0x85ebca6b) >>> 0;
  return [64 + (h & 127), 64 + ((h >>> 8) & 127), 64 + ((h >>> 16) & 127)];
}

function range(data) {
  let low = Infinity, high = -Infinity;
  for (const v of data) {
    if (!Number.isFinite(v)) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  return low < high ? [low, high] : [low === Infinity ? 0 : low, low === Infinity ? 1 : low + 1];
}

function painter(layer, stops, film) {
  const [a, b, c] = layer.channels.map(channel => channel.data);
  if (layer.channels[0].type === "half") {
    const bytes = halfBytes(stops, film);
    return c ? p => [bytes[a[p]], bytes[b[p]], bytes[c[p]]] : p => Array(3).fill(bytes[a[p]]);
  }
  if (layer.name === "id") return p => idColor(a[p]);
  if (c) return p => [a, b, c].map(v => v[p] === 0 && a[p] === 0 && b[p] === 0 && c[p] === 0 ? 0 : 127.5 + 127.5 * v[p]);
  if (layer.name === "root") return p => [255 * a[p], 255 * b[p], 0];
  if (b) {  // motion: grey where nothing moves
    const most = Math.max(1e-6, ...range(a).map(Math.abs), ...range(b).map(Math.abs));
    return p => [127.5 + 127.5 * a[p] / most, 127.5 + 127.5 * b[p] / most, 127.5];
  }
  if (layer.name === "lod") return p => turbo(a[p]);
  const [low, high] = range(a);
  return p => Number.isFinite(a[p]) ? turbo((a[p] - low) / (high - low)) : [0, 0, 0];
}

// The picture of a layer. Between the pixels of a coarse grid, it repeats them.
export function paint(layer, stops, film) {
  const {width, height} = layer, image = new ImageData(width, height), out = image.data;
  const color = painter(layer, stops, film);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const from = pixelFor(layer, x, y), to = 4 * (y * width + x);
      const [r, g, b] = color(from);
      out[to] = r; out[to + 1] = g; out[to + 2] = b; out[to + 3] = 255;
    }
  }
  return image;
}
