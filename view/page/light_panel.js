// SPDX-License-Identifier: Apache-2.0
// One row of controls for each light.
import {neutral} from "./light_mix.js";

const linear = v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;

function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

export class LightPanel {
  // `onChange`: called after each move of a control.
  constructor(list, onChange) {
    this.list = list;
    this.onChange = onChange;
    this.settings = new Map();  // by the name of the light
    this.moved = null;          // name of the light that moved last
    this.lights = new Map();
  }

  show(lights) {
    const shape = map => JSON.stringify([...map]);
    if (shape(lights) === shape(this.lights)) return;
    this.lights = lights;
    for (const name of lights.keys()) if (!this.settings.has(name)) this.settings.set(name, neutral());
    for (const name of this.settings.keys()) if (!lights.has(name)) this.settings.delete(name);
    this.list.replaceChildren(...[...lights].map(([name, parts]) => this.row(name, parts)));
  }

  isNeutral() {
    return [...this.settings.values()].every(s => s.stops === 0 && s.tint.every(t => t === 1) && !s.muted && !s.solo &&
                                                  s.mutedParts.size === 0);
  }

  // The changes that a scene can hold: {light: {stops, tint}}.
  changes() {
    const changed = [...this.settings].filter(([, s]) => s.stops !== 0 || s.tint.some(t => t !== 1));
    return Object.fromEntries(changed.map(([name, {stops, tint}]) => [name, {stops, tint}]));
  }

  // After the scene got the changes, or to begin anew with `all`.
  reset(all) {
    for (const [name, own] of this.settings)
      this.settings.set(name, all ? neutral() : {...own, stops: 0, tint: [1, 1, 1], hex: undefined});
    const lights = this.lights;
    this.lights = new Map();
    this.show(lights);
    this.onChange();
  }

  row(name, parts) {
    const own = this.settings.get(name);
    const changed = () => { this.moved = name; this.onChange(); };
    const value = make("output", {textContent: own.stops.toFixed(2)});
    const slider = make("input", {type: "range", min: -6, max: 6, step: 0.05, value: own.stops,
                                  title: "Stops; double-click for 0"});
    const move = stops => {
      own.stops = stops;
      slider.value = stops;
      value.textContent = (stops > 0 ? "+" : "") + stops.toFixed(2);
      changed();
    };
    slider.addEventListener("input", () => move(Number(slider.value)));
    slider.addEventListener("dblclick", () => move(0));
    const tint = make("input", {type: "color", value: own.hex ?? "#ffffff", title: "Tint: a factor on the light's colour"});
    tint.addEventListener("input", () => {
      own.hex = tint.value;
      own.tint = [1, 3, 5].map(i => linear(parseInt(tint.value.slice(i, i + 2), 16) / 255));
      changed();
    });
    const toggle = (text, title, holds, set) => {
      const button = make("button", {textContent: text, title, className: "toggle"});
      button.setAttribute("aria-pressed", holds);
      button.addEventListener("click", event => {
        holds = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", holds);
        set(holds, event);
        changed();
      });
      return button;
    };
    // Alt and a click show one part alone, or all parts again.
    const mute = (part, shown, event) => {
      const others = parts.filter(other => other !== part).map(other => other.name);
      const isAlone = !own.mutedParts.has(part.name) && others.every(other => own.mutedParts.has(other));
      if (event.altKey) own.mutedParts = new Set(isAlone ? [] : others);
      else if (shown) own.mutedParts.delete(part.name);
      else own.mutedParts.add(part.name);
      parts.forEach((other, i) => lobes[i].setAttribute("aria-pressed", !own.mutedParts.has(other.name)));
    };
    const lobes = parts.map(part => toggle(part.name, "Click: mute this part. Alt and click: show it alone",
      !own.mutedParts.has(part.name), (shown, event) => mute(part, shown, event)));
    const row = make("section", {className: "light"},
      make("h3", {textContent: name}),
      make("span", {className: "mutes"}, toggle("S", "Solo: only lights with S", own.solo, on => own.solo = on),
           toggle("M", "Mute", own.muted, on => own.muted = on)),
      slider, value, tint, make("div", {className: parts.some(part => part.name.includes(" ")) ? "lobes pairs" : "lobes"}, ...lobes));
    row.dataset.light = name;
    return row;
  }
}
