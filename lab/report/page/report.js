// SPDX-License-Identifier: Apache-2.0
// Shows a report: text, tables, plots and pictures. The data is JSON in the page (lab/report/report_page.cpp). Its
// texts reach the page only as text nodes and attributes, never as markup.
'use strict';

function element(space, name, attributes, children) {
  const made = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes))
    made.setAttribute(key, typeof value === 'number' ? Math.round(value * 10) / 10 : value);
  made.append(...children);
  return made;
}
const html = (name, attributes = {}, ...children) => element('http://www.w3.org/1999/xhtml', name, attributes, children);
const svg = (name, attributes = {}, ...children) => element('http://www.w3.org/2000/svg', name, attributes, children);

// ---- Numbers: raw ones are in SI units and bytes. Unknown ones are null, infinite ones {infinite: 1 or -1}.

const valueOf = cell => cell === null || cell === undefined ? NaN : typeof cell === 'object' ? cell.infinite * Infinity : cell;

// The unit in which numbers up to `largest` are easiest to read.
function unitOf(quantity, largest) {
  const size = Number.isFinite(largest) ? Math.abs(largest) : 0;
  const unit = (factor, symbol) => {
    const shown = size * factor;
    return {factor, symbol, decimals: shown >= 1000 ? 0 : shown >= 100 ? 1 : shown >= 10 ? 2 : 3};
  };
  switch (quantity) {
    case 'count': return {factor: 1, symbol: '', decimals: 0};
    case 'seconds': return size > 0 && size < 0.1 ? unit(1e3, 'ms') : unit(1, 's');
    case 'bytes':
      if (size < 2 ** 10) return {factor: 1, symbol: 'B', decimals: size < 1000 ? 1 : 0};
      return size < 2 ** 20 ? unit(2 ** -10, 'KiB') : size < 10 * 2 ** 30 ? unit(2 ** -20, 'MiB') : unit(2 ** -30, 'GiB');
    case 'rate': return {factor: 1, symbol: '1/s', decimals: size < 100 ? 2 : 0};
    case 'percent': return {factor: 100, symbol: '%', decimals: 1};
    case 'error': return {factor: 100, symbol: '%', decimals: 3};
    default: return unit(1, '');
  }
}

// Digits are in groups of three from 10 000 on, with narrow no-break spaces.
function numberText(number, unit) {
  if (Number.isNaN(number)) return '–';
  if (!Number.isFinite(number)) return number > 0 ? '∞' : '−∞';
  const text = Math.abs(number * unit.factor).toFixed(unit.decimals);
  const [whole, fraction] = text.split('.');
  const grouped = whole.length < 5 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, '\u202f');
  const sign = number < 0 && /[1-9]/.test(text) ? '−' : '';
  return sign + grouped + (fraction ? '.' + fraction : '');
}

const withUnit = (name, unit) => unit.symbol ? `${name} (${unit.symbol})` : name;

// ---- Plots

// After Okabe and Ito: distinguishable for colour-blind readers. On dark paper the dark ones are lighter.
const kPapers = {
  light: {ink: '#222222', grid: '#dddddd', series: ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9',
                                                    '#666666', '#8c564b', '#000000', '#b8b000']},
  dark: {ink: '#e6e6e6', grid: '#3a3d42', series: ['#3d9fd9', '#ee7733', '#1fbf94', '#d98cb8', '#eeb53a', '#8fd0f5',
                                                   '#a0a0a0', '#b98478', '#ffffff', '#d6cf4a']}};
const kDashes = ['', '7 3', '2 2.5', '9 3 2 3', '5 2 1 2 1 2'];  // tell lines apart without colours

function plotStyle({ink, grid, series}) {
  const colors = series.map((color, i) => `svg .line.s${i} { stroke: ${color}; } svg .fill.s${i} { fill: ${color}; }\n`);
  return `svg text { font: 11.5px 'Source Sans 3', 'Helvetica Neue', Arial, sans-serif; fill: ${ink}; }
svg text.value { font-size: 10.5px; }
svg .axis { stroke: ${ink}; stroke-width: 1; } svg .grid { stroke: ${grid}; stroke-width: .8; }
svg .line { fill: none; stroke-width: 1.8; stroke-linejoin: round; }
svg .line.ink { stroke: ${ink}; } svg .fill.ink { fill: ${ink}; }
${colors.join('')}`;
}

const colorOf = index => 's' + index % kPapers.light.series.length;
const textWidth = text => 6.3 * [...text].length;  // roughly

const drawLine = (x1, y1, x2, y2, style) => svg('line', {class: style, x1, y1, x2, y2});
const drawText = (x, y, anchor, text, style = 'label') => svg('text', {class: style, x, y, 'text-anchor': anchor}, text);
const drawShape = (name, style, points, dash) =>
  svg(name, {class: style, ...(dash ? {'stroke-dasharray': dash} : {}),
             points: points.map(([x, y]) => `${Math.round(x * 10) / 10},${Math.round(y * 10) / 10}`).join(' ')});

// About `wanted` round numbers between two others: 1, 2 or 5 times a power of ten.
function linearTicks(low, high, wanted) {
  const raw = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(raw)), lead = raw / power;
  const step = (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10) * power;
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i <= Math.floor(high / step + 1e-9); ++i) ticks.push(i * step);
  return ticks;
}

// Powers of ten and, if the axis spans only a few decades, also 2 and 5 times these.
function logTicks(low, high) {
  const ticks = [];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) {
    for (const lead of high / low < 2000 ? [1, 2, 5] : [1]) {
      const tick = lead * 10 ** e;
      if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push(tick);
    }
  }
  return ticks;
}

// The shortest labels that distinguish the ticks: on a linear axis, all have as many decimals as its step.
function tickLabels(ticks, log) {
  const decimals = x => x === 0 ? 0 : Math.min(12, Math.max(0, -Math.floor(Math.log10(Math.abs(x)) + 1e-9)));
  const step = ticks.length > 1 ? ticks[1] - ticks[0] : 0;
  return ticks.map(tick => numberText(tick, {factor: 1, decimals: decimals(log || !step ? tick : step)}));
}

// Maps the numbers of an axis to pixels. A linear scale starts at 0 or at the smallest number if that is negative, a
// logarithmic one at the smallest positive number. There is a small margin, but not at 0.
function makeScale(axis, numbers, from, to) {
  const shows = x => Number.isFinite(x) && (!axis.log || x > 0);
  const shown = numbers.filter(shows);
  let low = shown.reduce((a, b) => Math.min(a, b), Infinity), high = shown.reduce((a, b) => Math.max(a, b), axis.end);
  if (axis.log) {
    if (!(high > 0)) high = 1;
    low = Math.min(low, high) / 1.15;
    high *= 1.15;
  } else {
    if (low === Infinity) low = 0;
    if (low >= 0 && !(high > 0)) high = 1;
    const room = 0.04 * (Math.max(high, 0) - Math.min(low, 0));
    low = low < 0 ? low - room : 0;
    high = Math.max(high, 0) + room;
  }
  const unit = unitOf(axis.quantity, Math.max(Math.abs(low), high));
  const part = axis.log ? x => Math.log(x / low) / Math.log(high / low) : x => (x - low) / (high - low);
  const pixel = x => from + part(x) * (to - from);
  const bounds = [low * unit.factor, high * unit.factor];
  const ticks = axis.log ? logTicks(...bounds) : linearTicks(...bounds, Math.max(2, Math.floor(Math.abs(to - from) / 50)));
  const labels = tickLabels(ticks, axis.log);
  return {shows, pixel, unit, from, to, zero: pixel(axis.log ? low : 0), title: withUnit(axis.label, unit),
          ticks: ticks.map((tick, i) => [pixel(tick / unit.factor), labels[i]])};
}

function drawXAxis(scale, top, bottom) {
  return [...scale.ticks.flatMap(([x, label]) => [drawLine(x, top, x, bottom, 'grid'),
                                                  drawText(x, bottom + 15, 'middle', label)]),
          drawLine(scale.from, bottom, scale.to, bottom, 'axis'),
          drawText((scale.from + scale.to) / 2, bottom + 33, 'middle', scale.title)];
}

function drawYAxis(scale, left, right) {
  const title = drawText(0, 0, 'middle', scale.title);
  title.setAttribute('transform', `translate(14,${(scale.from + scale.to) / 2}) rotate(-90)`);
  return [...scale.ticks.flatMap(([y, label]) => [drawLine(left, y, right, y, 'grid'), drawText(left - 6, y + 4, 'end', label)]),
          drawLine(left, scale.from, left, scale.to, 'axis'), title];
}

// `entries`: {name, color, dash, area}. Returns the height and what to draw from y = 0 down.
function makeLegend(entries, left, width) {
  const drawn = [];
  let x = 0, y = 12;
  for (const {name, color, dash, area} of entries) {
    const needed = 22 + textWidth(name);
    if (x > 0 && x + needed > width) [x, y] = [0, y + 18];
    drawn.push(area ? svg('rect', {class: `fill ${color}`, x: left + x, y: y - 9, width: 16, height: 10})
                    : drawShape('polyline', `line ${color}`, [[left + x, y - 4], [left + x + 17, y - 4]], dash),
               drawText(left + x + 22, y, 'start', name));
    x += needed + 16;
  }
  return {height: entries.length ? y + 6 : 0, drawn};
}

const makePlot = (width, height, caption, ...children) =>
  svg('svg', {viewBox: `0 0 ${width} ${height}`, width, height, role: 'img', 'aria-label': caption}, ...children);

// Lines over x, on top of stacked areas, which all have the same x values.
function linePlot(plot) {
  const width = plot.half ? 480 : 780, left = 66, right = width - 14;
  const areas = plot.areas.map(({name}, i) => ({name, color: colorOf(i), area: true}));
  // Above areas, lines have the colour of text, because other colours would be mistaken for areas.
  const lines = plot.lines.map(({name}, i) => ({name, color: areas.length ? 'ink' : colorOf(i), dash: kDashes[i % kDashes.length]}));
  const legend = makeLegend([...areas, ...lines], left, right - left);
  const top = legend.height + 8, bottom = top + (plot.half ? 200 : 260);

  const xs = plot.areas.length ? plot.areas[0].points.map(point => point[0]) : [];
  const bounds = [xs.map(() => 0)];  // the lower bounds of the areas, and the upper bound of the last
  for (const {points} of plot.areas)
    bounds.push(bounds.at(-1).map((below, i) => below + (valueOf(points[i]?.[1]) || 0)));
  const points = plot.lines.flatMap(line => line.points);
  const x = makeScale(plot.x, [...xs, ...points.map(point => point[0])], left, right);
  const y = makeScale(plot.y, [...bounds.flat(), ...points.map(point => valueOf(point[1]))], bottom, top);

  const drawn = [...drawXAxis(x, top, bottom), ...drawYAxis(y, left, right)];
  areas.forEach((area, i) => {
    const edge = bound => xs.map((at, j) => [x.pixel(at), y.pixel(bound[j])]);
    if (xs.length) drawn.push(drawShape('polygon', `fill ${area.color}`, [...edge(bounds[i + 1]), ...edge(bounds[i]).reverse()]));
  });
  lines.forEach((line, i) => {
    let run = [];
    const flush = () => {
      if (run.length > 1) drawn.push(drawShape('polyline', `line ${line.color}`, run, line.dash));
      run = [];
    };
    for (const [px, value] of plot.lines[i].points) {
      const py = valueOf(value);
      if (!x.shows(px) || !y.shows(py)) {
        flush();
        continue;
      }
      run.push([x.pixel(px), y.pixel(py)]);
      if (!plot.markers) continue;
      const title = `${line.name}: ${numberText(px, unitOf(plot.x.quantity, px))}, ${numberText(py, y.unit)}`;
      drawn.push(svg('circle', {class: `fill ${line.color}`, cx: x.pixel(px), cy: y.pixel(py), r: 3}, svg('title', {}, title)));
    }
    flush();
  });
  return makePlot(width, bottom + 44, plot.caption, ...drawn, ...legend.drawn);
}

// Horizontal bars in groups.
function barPlot(plot) {
  const width = plot.half ? 480 : 780, right = width - 60;
  const left = Math.min(Math.max(40, ...plot.groups.map(textWidth)) + 14, width / 2);
  const single = plot.stacked || plot.series.length === 1;
  const bar = single ? 16 : 12, gap = 8, groupHeight = (single ? bar : bar * plot.series.length) + gap;
  const legend = makeLegend(plot.series.length > 1 ? plot.series.map(({name}, i) => ({name, color: colorOf(i), area: true})) : [],
                            left, right - left);
  const top = legend.height + 8, bottom = top + groupHeight * Math.max(plot.groups.length, 1);

  const values = plot.groups.map((_, group) => plot.series.map(series => valueOf(series.values[group])));
  const sums = values.map(group => group.reduce((sum, value) => sum + (Number.isFinite(value) ? value : 0), 0));
  const ends = [...(plot.stacked ? sums : values.flat()), ...plot.spread.map(range => valueOf(range[1]))];
  const scale = makeScale(plot.value, ends, left, right);
  const drawn = drawXAxis(scale, top, bottom);
  const drawBar = (i, from, to, y, height, value) =>
    drawn.push(svg('rect', {class: `fill ${colorOf(i)}`, x: Math.min(from, to), y, width: Math.abs(to - from), height},
                   svg('title', {}, `${plot.series[i].name}: ${numberText(value, scale.unit)}`)));
  const drawValue = (x, y, text) => drawn.push(drawText(x + 4, y, 'start', text, 'value'));

  plot.groups.forEach((name, group) => {
    const y0 = top + groupHeight * group + gap / 2;
    drawn.push(drawText(left - 6, y0 + (groupHeight - gap) / 2 + 4, 'end', name));
    const known = values[group].some(scale.shows);
    let end = 0;
    values[group].forEach((value, i) => {
      if (plot.stacked) {
        if (!scale.shows(value)) return;
        drawBar(i, scale.pixel(end), Math.max(scale.pixel(end), scale.pixel(end + value)), y0, bar, value);
        end += value;
      } else {
        const x = scale.shows(value) ? scale.pixel(value) : scale.zero;
        drawBar(i, scale.zero, x, y0 + i * bar, bar - 1, value);
        if (scale.shows(value) || !plot.notes.length)
          drawValue(Math.max(x, scale.zero), y0 + (i + 1) * bar - 3, numberText(value, scale.unit));
      }
    });
    const [least, most] = (plot.spread[group] ?? [null, null]).map(valueOf);
    if (scale.shows(least) && scale.shows(most) && least !== most) {
      const [x0, x1] = [scale.pixel(least), scale.pixel(most)], y = y0 + bar / 2;
      drawn.push(drawLine(x0, y, x1, y, 'axis'), drawLine(x0, y - 3, x0, y + 3, 'axis'), drawLine(x1, y - 3, x1, y + 3, 'axis'));
      end = Math.max(end, most);
    }
    const note = known ? '' : plot.notes[group];
    if (note || plot.stacked)
      drawValue(known ? scale.pixel(end) : scale.zero, y0 + bar - 4, note || numberText(known ? sums[group] : NaN, scale.unit));
  });
  drawn.push(drawLine(scale.zero, top, scale.zero, bottom, 'axis'));
  return makePlot(width, bottom + 44, plot.caption, ...drawn, ...legend.drawn);
}

function picture({width, height, caption, source, labels}) {
  if (!labels.length) return html('img', {alt: caption, width, height, src: source});
  const texts = labels.map(label => {
    const text = drawText(label.x, label.y, label.anchor, label.text, '');
    text.setAttribute('style', `font-size:${label.size}px;fill:rgb(${label.color})`);
    return text;
  });
  return makePlot(width, height, caption, svg('image', {x: 0, y: 0, width, height, href: source}), ...texts);
}

// ---- The page

let tables = 0, figures = 0;

// Saves a plot as a file for papers and slides.
function save(plot, name) {
  const copy = plot.cloneNode(true);
  copy.prepend(svg('style', {}, plotStyle(kPapers.light)), svg('rect', {width: '100%', height: '100%', fill: '#ffffff'}));
  const text = new XMLSerializer().serializeToString(copy);
  html('a', {download: name, href: URL.createObjectURL(new Blob([text], {type: 'image/svg+xml'}))}).click();
}

function figure(block, body) {
  const number = ++figures;
  const caption = html('figcaption', {}, html('b', {}, `Figure ${number}.`), ' ' + block.caption);
  if (body.localName === 'svg') {
    const button = html('button', {title: 'Save this figure as SVG'}, 'SVG');
    button.addEventListener('click', () => save(body, `figure-${String(number).padStart(2, '0')}.svg`));
    caption.append(button);
  }
  return html('figure', block.half ? {class: 'half'} : {}, body, caption);
}

function table(block) {
  const isText = block.columns.map((_, i) => block.rows.some(row => typeof row[i] === 'string'));
  const units = block.columns.map((column, i) => unitOf(column.quantity, block.rows.reduce((largest, row) => {
    const size = typeof row[i] === 'string' ? NaN : Math.abs(valueOf(row[i]));
    return Number.isFinite(size) ? Math.max(largest, size) : largest;
  }, 0)));
  const cell = (name, i, text) => html(name, isText[i] ? {class: 'text'} : {}, text);
  const rows = block.rows.map(row => html('tr', {}, ...row.map(
    (value, i) => cell('td', i, typeof value === 'string' ? value : numberText(valueOf(value), units[i])))));
  const titles = block.columns.map(({title}, i) => cell('th', i, isText[i] ? title : withUnit(title, units[i])));
  return html('div', {class: 'table'}, html('table', {},
    html('caption', {}, html('b', {}, `Table ${++tables}.`), ' ' + block.caption),
    html('thead', {}, html('tr', {}, ...titles)), html('tbody', {}, ...rows)));
}

const kFigures = {lines: linePlot, bars: barPlot, picture};

function showSection(section) {
  document.body.append(html('h2', {}, section.heading));
  let row = null;  // consecutive figures share a row, in which those of half width are side by side
  for (const block of section.blocks) {
    if (kFigures[block.kind]) {
      if (!row) document.body.append(row = html('div', {class: 'figures'}));
      row.append(figure(block, kFigures[block.kind](block)));
      continue;
    }
    row = null;
    if (block.kind === 'table') document.body.append(table(block));
    else if (block.text) document.body.append(html('p', {}, block.text));
  }
}

// Control characters have no place in the files of save(), which are XML.
const plain = value => typeof value === 'string' ? value.replace(/[\0-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff]/g, '\ufffd') : value;
const report = JSON.parse(document.getElementById('report').textContent, (_, value) => plain(value));
document.title = report.title;
document.head.append(html('style', {}, plotStyle(kPapers.light) +
                          `@media screen and (prefers-color-scheme: dark) {\n${plotStyle(kPapers.dark)}}\n`));
document.body.append(html('h1', {}, report.title));
if (report.abstract) document.body.append(html('p', {}, report.abstract));
document.body.append(html('dl', {}, ...report.facts.flatMap(([name, value]) => [html('dt', {}, name), html('dd', {}, value)])));
report.sections.forEach(showSection);
