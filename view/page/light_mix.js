// SPDX-License-Identifier: Apache-2.0
// The picture as a sum of its light layers, each multiplied by a factor of its light.
import {viewTransform} from "./colors.js";
import {halfValues, pixelFor} from "./server.js";

// The lights of a picture by the names of its layers: "key.diffuse", "sky.emission". With layers of events,
// "key.diffuse.direct" and "key.diffuse.indirect" replace "key.diffuse".
export function lightsOf(layers) {
  const lights = new Map();
  const isEvent = name => name.endsWith(".direct") || name.endsWith(".indirect");
  const divided = new Set(layers.filter(isEvent).map(name => name.slice(0, name.lastIndexOf("."))));
  for (const layer of layers) {
    if (!layer.includes(".") || divided.has(layer)) continue;
    const end = isEvent(layer) ? layer.lastIndexOf(".", layer.lastIndexOf(".") - 1) : layer.lastIndexOf(".");
    const name = layer.slice(0, end), part = layer.slice(end + 1).replace(".", " ");
    if (!lights.has(name)) lights.set(name, []);
    lights.get(name).push({name: part, layer});
  }
  // The parts of a lobe side by side, and the emission last.
  const lobe = part => part.name === "emission" ? Infinity : lobes.indexOf(part.name.split(" ")[0]);
  const lobes = [...new Set([...lights.values()].flat().map(part => part.name.split(" ")[0]))];
  for (const parts of lights.values()) parts.sort((a, b) => lobe(a) < lobe(b) ? -1 : lobe(a) > lobe(b) ? 1 : 0);
  return lights;
}

export const neutral = () => ({stops: 0, tint: [1, 1, 1], muted: false, solo: false, mutedParts: new Set()});

// What each light's radiance is multiplied by, for red, green and blue.
export function factorsOf(settings, anySolo) {
  const heard = !settings.muted && (!anySolo || settings.solo);
  return settings.tint.map(t => heard ? t * 2 ** settings.stops : 0);
}

// Bytes of the screen by the upper 19 bits of a float: as many bits of the fraction as a half float has.
const tables = new Map();
function floatBytes(film) {
  if (!tables.has(film)) {
    const bits = Uint32Array.from({length: (1 << 18) + 1}, (_, i) => i << 13);
    const values = new Float32Array(bits.buffer);
    const table = new Uint8Array((1 << 19) + 1);
    for (let i = 0; i < values.length; ++i) table[i] = Math.floor(255 * viewTransform(values[i], film) + 0.5);
    tables.set(film, table);
  }
  return tables.get(film);
}

const kBlock = 2048;  // pixels that are mixed together, such that they fit the cache

export class LightMix {
  constructor() {
    this.layers = null;   // as readLayers() returns them
    this.sums = new Map();  // radiance of each light: {key, data: [red, green, blue]}
    this.others = null;
  }

  setLayers(layers) {
    this.layers = layers;
    this.byName = new Map(layers.channels.map(channel => [channel.name, channel.data]));
    this.sums.clear();
    this.others = null;
  }

  has(lights) {
    return this.layers !== null && [...lights.values()].flat().every(part => this.byName.has(part.layer + ".R"));
  }

  sumOf(light, parts) {
    const key = parts.map(part => part.layer).join("\n"), known = this.sums.get(light);
    if (known && known.key === key) return known.data;
    const count = this.layers.width * this.layers.height;
    const data = ["R", "G", "B"].map(color => {
      const sum = new Float32Array(count);
      for (const part of parts) {
        const bits = this.byName.get(`${part.layer}.${color}`);
        for (let i = 0; i < count; ++i) sum[i] += halfValues[bits[i]];
      }
      return sum;
    });
    this.sums.set(light, {key, data});
    return data;
  }

  // The sum of some lights: [red, green, blue].
  sum(names, terms) {
    const count = this.layers.width * this.layers.height;
    const total = [0, 1, 2].map(() => new Float32Array(count));
    for (const name of names) {
      const {factors, data} = terms.get(name);
      factors.forEach((factor, c) => {
        const from = data[c], to = total[c];
        if (factor !== 0) for (let i = 0; i < count; ++i) to[i] += factor * from[i];
      });
    }
    return total;
  }

  // The sum of all lights but one, which is the one that moves: it stays while a slider is dragged.
  othersOf(moved, terms) {
    const others = [...terms.keys()].filter(name => name !== moved);
    const key = JSON.stringify([moved, others.map(name => [name, terms.get(name).factors, terms.get(name).key])]);
    if (this.others?.key !== key) this.others = {key, data: this.sum(others, terms)};
    return this.others.data;
  }

  // The factors and the radiance of each light.
  termsOf(lights, settings, gain) {
    const anySolo = [...settings.values()].some(own => own.solo), terms = new Map();
    for (const [name, parts] of lights) {
      const own = settings.get(name) ?? neutral(), shown = parts.filter(part => !own.mutedParts.has(part.name));
      const key = shown.map(part => part.layer).join("\n");
      terms.set(name, {key, factors: factorsOf(own, anySolo).map(f => gain * f), data: this.sumOf(name, shown)});
    }
    return terms;
  }

  // The mixed radiance of a pixel: red, green and blue.
  valueAt(lights, settings, pixel) {
    const terms = [...this.termsOf(lights, settings, 1).values()];
    return [0, 1, 2].map(c => terms.reduce((sum, term) => sum + term.factors[c] * term.data[c][pixel], 0));
  }

  // The mixed picture. `settings`: by the name of the light. `moved`: the light that moved last.
  paint(lights, settings, moved, stops, film) {
    const {width, height} = this.layers, table = floatBytes(film);
    if (this.image?.width !== width || this.image.height !== height) this.image = new ImageData(width, height);
    const terms = this.termsOf(lights, settings, 2 ** stops), others = this.othersOf(moved, terms);
    const {factors: [fr, fg, fb], data: [r, g, b]} = terms.get(moved) ?? {factors: [0, 0, 0], data: others};
    const [rest_r, rest_g, rest_b] = others, out = new Uint32Array(this.image.data.buffer);
    const sums = new Float32Array(3 * kBlock), bits = new Uint32Array(sums.buffer);
    for (let from = 0; from < out.length; from += kBlock) {
      const count = Math.min(kBlock, out.length - from);
      for (let i = 0, p = from; i < count; ++i, ++p) {
        sums[i] = rest_r[p] + fr * r[p];
        sums[kBlock + i] = rest_g[p] + fg * g[p];
        sums[2 * kBlock + i] = rest_b[p] + fb * b[p];
      }
      for (let i = 0; i < count; ++i) {
        out[from + i] = 0xff000000 | table[(bits[2 * kBlock + i] + 0x1000) >>> 13] << 16 |
                        table[(bits[kBlock + i] + 0x1000) >>> 13] << 8 | table[(bits[i] + 0x1000) >>> 13];
      }
    }
    if (this.layers.grid > 1) repeat(out, this.layers);
    return this.image;
  }
}

// Between the pixels of a coarse grid, repeats them.
function repeat(pixels, layers) {
  const {width, height} = layers;
  for (let y = 0, i = 0; y < height; ++y)
    for (let x = 0; x < width; ++x, ++i) pixels[i] = pixels[pixelFor(layers, x, y)];
}
