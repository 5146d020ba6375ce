// SPDX-License-Identifier: Apache-2.0
// Requests to the server that served this page.
const token = new URLSearchParams(location.search).get("token");

const page = crypto.getRandomValues(new Uint32Array(2)).join("-");  // the server counts pages

const address = (name, values = {}) => `${name}?${new URLSearchParams({...values, token})}`;

export async function readState() {
  const answer = await fetch(address("state.json", {page}));
  if (!answer.ok) throw new Error(`state.json: ${answer.status}`);
  return answer.json();
}

// Half floats as numbers, by their 16 bits.
export const halfValues = (() => {
  const values = new Float32Array(1 << 16);
  for (let bits = 0; bits < 1 << 16; ++bits) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
    if (exponent === 31) values[bits] = fraction ? NaN : sign * Infinity;
    else if (exponent === 0) values[bits] = sign * fraction * 2 ** -24;
    else values[bits] = sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
  }
  return values;
})();

const arrays = {half: Uint16Array, float: Float32Array, uint: Uint32Array};

// Some layers of one picture: {version, edit, width, height, grid, full, channels: [{name, type, data}]}; null if there are
// none yet. The data of half channels are the bits of the values.
export async function readLayers(names) {
  const query = new URLSearchParams([...names.map(name => ["name", name]), ["token", token]]);
  const answer = await fetch(`layer.bin?${query}`);
  if (answer.status === 204 || answer.status === 404) return null;
  if (!answer.ok) throw new Error(`layer.bin: ${answer.status}`);
  const bytes = await answer.arrayBuffer();
  const start = new Uint8Array(bytes).indexOf(10) + 1;
  const layer = JSON.parse(new TextDecoder().decode(bytes.slice(0, start)));
  let at = start;
  for (const channel of layer.channels) {
    const type = arrays[channel.type], count = layer.width * layer.height;
    // A copy: the start of a channel need not be a multiple of its element size.
    channel.data = new type(bytes.slice(at, at + count * type.BYTES_PER_ELEMENT));
    at += count * type.BYTES_PER_ELEMENT;
  }
  return layer;
}

// Why a pixel is what it is. Throws an Error with the server's message.
export async function readWhy(x, y) {
  const answer = await fetch(address("why.json", {x, y}));
  const result = await answer.json().catch(() => ({error: `why.json: ${answer.status}`}));
  if (!answer.ok) throw new Error(result.error);
  return result;
}

// Runs a command. Returns its answer; throws an Error with the server's message.
export async function command(name, values) {
  const answer = await fetch(address(name), {
    method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(values)});
  const result = await answer.json().catch(() => ({error: `${name}: ${answer.status}`}));
  if (!answer.ok) throw new Error(result.error);
  return result;
}

// The index of the pixel that stands for (x, y): between the pixels of a coarse grid, one of the grid.
export function pixelFor(layer, x, y) {
  const {width, grid, full: [x0, y0, x1, y1]} = layer;
  if (grid === 1 || (x >= x0 && x < x1 && y >= y0 && y < y1)) return y * width + x;
  return (y - y % grid) * width + x - x % grid;
}

export const valueAt = (channel, pixel) =>
  channel.type === "half" ? halfValues[channel.data[pixel]] : channel.data[pixel];
