// SPDX-License-Identifier: Apache-2.0
import {readLayer, readState, valueAt} from "./server.js";
import {paint} from "./colors.js";
import {PictureCanvas} from "./canvas.js";

const element = id => document.getElementById(id);
const kPoll_ms = 120;
let state = null, layer = null, kept = null, showsKept = false, cursor = null;

const canvas = new PictureCanvas(element("canvas"), pixel => { cursor = pixel; showValues(); });

function draw() {
  const shown = showsKept && kept ? kept : layer;
  if (!shown) return;
  canvas.show(paint(shown, Number(element("exposure").value), element("transform").value === "film"));
  showValues();
}

function showValues() {
  const shown = showsKept && kept ? kept : layer;
  if (!shown || !cursor || cursor.x >= shown.width || cursor.y >= shown.height) {
    element("values").textContent = "";
    return;
  }
  const pixel = (cursor.y - cursor.y % shown.grid) * shown.width + cursor.x - cursor.x % shown.grid;
  const values = shown.channels.map(channel => {
    const value = valueAt(channel, pixel);
    return `${channel.name} ${channel.type === "uint" ? value : value.toPrecision(4)}`;
  });
  element("values").textContent = `(${cursor.x}, ${cursor.y})  ${values.join("  ")}`;
}

function showState() {
  element("error").hidden = state.error === "";
  if (element("error").textContent !== state.error) element("error").textContent = state.error;
  const chooser = element("layer");
  if (state.layers.length && state.layers.join() !== [...chooser.options].map(o => o.value).join()) {
    const chosen = state.layers.includes(chooser.value) ? chooser.value : "beauty";
    chooser.replaceChildren(...state.layers.map(name => new Option(name, name, false, name === chosen)));
  }
  const samples = `${Number(state.samples.toFixed(1))} of ${state.wanted_samples} samples`;
  const memory = `${(state.memory_bytes / 2 ** 20).toFixed(0)} MiB`;
  const what = state.done ? `done in ${state.render_s.toFixed(1)} s` : state.error ? "waiting for an edit" : state.stage;
  element("status").textContent = `${state.width} × ${state.height} · ${what} · ${samples} · ${memory}`;
  element("progress").hidden = state.done;
  element("progress").value = state.progress;
}

async function refresh() {
  state = await readState();
  const name = element("layer").value;
  if (state.version && (!layer || layer.version !== state.version || layer.name !== name)) {
    const read = await readLayer(name);
    if (read) {
      layer = Object.assign(read, {name});
      draw();
    }
  }
  showState();
  document.body.dataset.version = layer ? layer.version : 0;
  document.body.dataset.done = state.done;
}

async function follow() {
  try {
    await refresh();
  } catch (problem) {
    element("status").textContent = "no answer: has `pelage view` ended?";
  }
  setTimeout(follow, kPoll_ms);
}

element("layer").addEventListener("change", () => refresh().catch(() => {}));
element("exposure").addEventListener("input", event => {
  element("stops").textContent = Number(event.target.value).toFixed(1);
  draw();
});
element("transform").addEventListener("change", draw);
element("fit").addEventListener("click", () => canvas.fit());
element("one").addEventListener("click", () => canvas.one());
element("keep").addEventListener("click", () => { kept = layer; element("before").disabled = !kept; });
const compare = shows => { if (showsKept !== shows) { showsKept = shows; draw(); } };
element("before").addEventListener("pointerdown", () => compare(true));
addEventListener("pointerup", () => compare(false));
addEventListener("keydown", event => {
  if (event.target.tagName === "SELECT") return;
  if (event.key === "f") canvas.fit();
  if (event.key === "1") canvas.one();
  if (event.key === "k") element("keep").click();
  if (event.key === "b") compare(true);
});
addEventListener("keyup", event => { if (event.key === "b") compare(false); });
follow();
