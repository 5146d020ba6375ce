// SPDX-License-Identifier: Apache-2.0
// The answer to why a pixel is what it is (why.json), as headings and tables.
const kMaxLights = 12, kMaxSeen = 5;  // rows

const number = v => v === 0 ? "0" : String(Number(v.toPrecision(3)));
const list = values => values.map(number).join("  ");
const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
const distance = v => Math.hypot(...v);

function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

function table(head, rows, className = "") {
  const cells = (tag, values) => values.map(v => v instanceof Node ? make(tag, {}, v) : make(tag, {textContent: v}));
  return make("table", {className},
    ...(head ? [make("thead", {}, make("tr", {}, ...cells("th", head)))] : []),
    make("tbody", {}, ...rows.map(row => make("tr", {}, ...cells("td", row)))));
}

const section = (title, ...children) => make("section", {}, make("h3", {textContent: title}), ...children);

function swatch(color) {
  const srgb = v => Math.round(255 * Math.min(Math.max(v, 0), 1) ** (1 / 2.2));
  const box = make("span", {className: "swatch", title: list(color)});
  box.style.background = `rgb(${color.map(srgb).join(" ")})`;
  return box;
}

function surface({strand, skin, depth}) {
  if (strand) {
    const root = strand.root && ["root", `face ${strand.root.face}, u ${number(strand.root.u)}, v ${number(strand.root.v)}`];
    return section(`Strand ${strand.id} of ${strand.coat}`, table(null, [
      ...(root ? [root, ["texture", list(strand.root_uv)]] : []),
      ["at rest", list(strand.rest)],
      ["hit at", `${(100 * strand.along).toFixed(1)} % of its length from the root`],
      ["across", `${strand.across.toFixed(2)} radii`], ["depth", number(depth)]]));
  }
  if (!skin) return section("Nothing", make("p", {textContent: "The camera sees neither fur nor skin here, only lights."}));
  return section(`Skin ${skin.name}`, table(null, [
    ["face", `${skin.face}, u ${number(skin.place[0])}, v ${number(skin.place[1])}`], ["texture", list(skin.uv)],
    ["at rest", list(skin.rest)], ["depth", number(depth)]]));
}

function steps({steps}) {
  const places = ["root", "middle", "tip"];
  const color = after => after.tip.color ? make("span", {}, ...places.map(place => swatch(after[place].color))) : "";
  return section("Steps of its growth", table(["", ...places, "length", "tip width", ""], steps.map(({name, moved, after}) =>
    [name, ...places.map(place => moved ? number(distance(moved[place])) : ""), number(after.length),
     number(after.tip.width), color(after)]), "numbers"));
}

function detail({lod}) {
  if (!lod) return section("Level of detail", make("p", {textContent: "not reduced"}));
  return section("Level of detail", table(null, [
    ["kept here", `${(100 * lod.share).toFixed(1)} % of the strands; priority ${number(lod.priority)}`],
    ["mean strand", `${number(lod.width_pixels)} × ${number(lod.length_pixels)} pixels`],
    ["motion, blur", `${number(lod.motion_pixels)}, ${number(lod.confusion_pixels)} pixels`],
    ["factors", `size ${number(lod.size_share)}, blur ${number(lod.blur_share)}, facing ${number(lod.facing_share)}, role ${number(lod.budget)}`],
    ["width", `× ${number(lod.width_factor)}`]]));
}

function lights({lights, radiance}) {
  const whole = luminance(radiance), shown = lights.filter(term => luminance(term.radiance) !== 0);
  const rows = shown.slice(0, kMaxLights).map(({light, lobe, event, radiance: part}) => {
    const share = whole > 0 ? luminance(part) / whole : 0, bar = make("span", {className: "share"});
    bar.style.width = `${Math.max(0, Math.min(1, share)) * 60}px`;
    return [`${light} ${lobe}${event ? ` ${event}` : ""}`, bar, `${(100 * share).toFixed(1)} %`];
  });
  if (shown.length > kMaxLights) rows.push([`and ${shown.length - kMaxLights} more`, "", ""]);
  return section("Light", table(null, rows, "light_terms"));
}

function chunkRows(chunk) {
  if (!chunk) return [];
  const grown = chunk.growths === 0 ? "kept from an earlier picture" : `grown ${chunk.growths === 1 ? "once" : `${chunk.growths} times`}`;
  return [["chunk", `${chunk.index}: ${chunk.strands} strands, ${grown}`],
          ["box", `${list(chunk.box[0])} to ${list(chunk.box[1])}`], ["fine boxes", String(chunk.segment_cell_bounds)]];
}

// Replaces the children of `place`; `why`: the answer, or null.
export function showWhy(place, why) {
  place.replaceChildren();
  if (!why) return;
  const {pixel, samples, radiance, noise, material, cost} = why;
  const head = section(`Pixel ${pixel[0]} ${pixel[1]}`, table(null, [
    ["radiance", make("span", {}, swatch(radiance), list(radiance))], ["samples", String(samples)],
    ...(noise === null ? [] : [["noise", number(noise)]])]));
  place.append(head, surface(why), lights(why));
  if (material) {
    place.append(section(`Material ${material.name} (${material.model})`, table(null, [
      ["colour here", make("span", {}, swatch(material.color), list(material.color))],
      ...Object.entries(material.parameters)])));
  }
  if (why.strand) place.append(steps(why.strand), detail(why.strand));
  place.append(section("Seen by its samples", table(null, why.seen.slice(0, kMaxSeen).map(seen =>
    [String(seen.samples), seen.name === null ? "nothing" : seen.strand === null ? seen.name : `strand ${seen.strand} of ${seen.name}`]))));
  place.append(section("Cost", table(null, [
    ["rays", `${cost.camera_rays} camera, ${cost.shadow_rays} shadow, ${cost.indirect_rays} indirect`],
    ["CPU", `${(1000 * cost.trace_s).toFixed(1)} ms`],
    ...(cost.strands_grown ? [["growth", `${cost.strands_grown} strands in ${(1000 * cost.growth_s).toFixed(0)} ms`]] : []),
    ...chunkRows(why.chunk)])));
}
