// Charts over the frames of a run, and bars, drawn by Chart.js in the colours of the page.
// SPDX-License-Identifier: MIT
'use strict';

const charts = [];  // {canvas, config(): what Chart takes, chart}
const mostPoints = 800;
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();

function canvasFor(label, config) {
  const canvas = h('canvas', {role: 'img', 'aria-label': label});
  charts.push({canvas, config});
  return window.Chart ? canvas : note('This page was built without Chart.js.');
}
/** Once all is in the page, and again when its colours change. */
function drawCharts() {
  if (!window.Chart) return;
  Object.assign(Chart.defaults, {animation: false, maintainAspectRatio: false, color: ink('soft'),
    borderColor: ink('line'), font: {...Chart.defaults.font, family: getComputedStyle(document.body).fontFamily}});
  for (const entry of charts) {
    if (entry.chart) entry.chart.destroy();
    entry.chart = new Chart(entry.canvas, entry.config());
  }
}

/** A dashed line at the frame of the film. */
const marker = {id: 'marker', afterDatasetsDraw(chart) {
  const {ctx, chartArea: {top, bottom}, scales: {x}} = chart, place = x.getPixelForValue(player.frame);
  ctx.save();
  ctx.strokeStyle = ink('soft');
  ctx.lineWidth = 2;
  ctx.setLineDash([5, 4]);
  ctx.beginPath();
  ctx.moveTo(place, top);
  ctx.lineTo(place, bottom);
  ctx.stroke();
  ctx.restore();
}};

/** Of very many frames, each point is the largest value of its group. */
function pointsOf(values) {
  const group = Math.ceil(values.length / mostPoints), points = [];
  for (let i = 0; i < values.length; i += group) {
    const here = values.slice(i, i + group).filter((value) => value !== null && isFinite(value));
    points.push({x: i, y: here.length ? Math.max(...here) : null});
  }
  return points;
}

/**
 * Values over the frames. The chart follows the film, takes the focus and the arrow keys, and a click goes to a frame.
 * @param series  [{name, colour: a colour of the page, values: one a frame, area: stacked upon those before it}]
 */
function plot(id, title, unit, series) {
  const frames = series[0].values.length, single = frames === 1;
  const valuesAt = (f) => `frame ${f}: ` + series.map((one) => `${one.name} ${readable(one.values[f])}`).join(', ') +
    ' ' + unit;
  const config = () => ({
    type: single ? 'bar' : 'line',
    data: {labels: single ? [0] : undefined, datasets: series.map((one, i) => ({
      label: one.name, data: single ? [one.values[0]] : pointsOf(one.values), parsing: single ? undefined : false,
      stack: one.area ? 'areas' : one.name, clip: one.area ? 0 : 6, fill: one.area ? (i === 0 ?
        'origin' : '-1') : false,
      borderColor: ink(one.colour), backgroundColor: ink(one.colour), borderWidth: one.area ? 0 : 2,
      pointRadius: one.area || frames > 100 ? 0 : 3, order: one.area ? 1 : 0, maxBarThickness: 90}))},
    plugins: [marker],
    options: {
      interaction: {mode: 'index', intersect: false},
      scales: {
        x: single ? {grid: {display: false}} : {type: 'linear', min: 0, max: frames - 1, grid: {display: false},
          ticks: {precision: 0, maxTicksLimit: 12, maxRotation: 0}},
        y: {stacked: true, beginAtZero: true, grid: {drawBorder: false},
          ticks: {maxTicksLimit: 6, callback: (value) => readable(value)}}},
      plugins: {legend: {display: false}, tooltip: {callbacks: {
        title: (items) => 'frame ' + items[0].parsed.x,
        label: (item) => `${item.dataset.label}: ${readable(item.parsed.y)} ${unit}`}}}}});
  const values = h('p', {class: 'readout', id: id + '-values'});
  const area = h('div', {class: 'plot', id, tabindex: 0, role: 'slider', 'aria-label': title, 'aria-valuemin': 0,
    'aria-valuemax': frames - 1}, canvasFor(title, config));
  const chartOf = () => (charts.find((entry) => entry.canvas.parentElement === area) || {}).chart;
  area.addEventListener('click', (event) => {
    const {left} = event.currentTarget.getBoundingClientRect(), chart = chartOf();
    if (chart) goTo(Math.round(chart.scales.x.getValueForPixel(event.clientX - left)));
  });
  follow((f) => {
    area.setAttribute('aria-valuenow', f);
    area.setAttribute('aria-valuetext', valuesAt(f));
    values.textContent = valuesAt(f);
    if (chartOf()) chartOf().draw();
  });
  return [area, values, legend(series.map((one) => [one.colour, one.name]))];
}

/** How often samples have each count. */
function histogram(label, counts) {
  const rest = counts.length - 1;
  return h('div', {class: 'plain-plot'}, canvasFor(label, () => ({type: 'bar',
    data: {labels: counts.map((_, i) => i), datasets: [{data: counts, backgroundColor: ink('one')}]},
    options: {scales: {x: {grid: {display: false}}, y: {ticks: {callback: (value) => readable(value)}}},
      plugins: {legend: {display: false}, tooltip: {callbacks: {
        title: (items) => items[0].label + (counts.length > 32 && items[0].dataIndex === rest ? ' and more' : ''),
        label: (item) => grouped(item.parsed.y) + ' pixels'}}}}})));
}

/** Bars on a logarithmic scale, one part behind the other: rows of [name, first, second], in milliseconds. */
function logBars(label, names, rows) {
  const least = 10 ** Math.floor(Math.log10(Math.max(0.5 * Math.min(...rows.map((row) => row[1])), 1e-4)));
  const part = (name, colour, range) => ({label: name, backgroundColor: ink(colour), grouped: false,
    data: rows.map(range), maxBarThickness: 22});
  return h('div', {class: 'plain-plot', style: `height:${60 + 46 * rows.length}px`}, canvasFor(label, () => ({
    type: 'bar',
    data: {labels: rows.map(([name, first, second]) =>
      [name, readable(first) + ' ms' + (second > 0 ? ` + ${readable(second)} to prepare` : '')]), datasets: [
      part(names[0], 'one', ([, first]) => [least, Math.max(first, least)]),
      part(names[1], 'two', ([, first, second]) => second > 0 ? [first, first + second] : null)]},
    options: {indexAxis: 'y', scales: {y: {grid: {display: false}},
      x: {type: 'logarithmic', min: least, ticks: {maxTicksLimit: 8, callback: (value) =>
        Math.abs(Math.log10(value) % 1) < 1e-9 ? readable(value) + ' ms' : null}}},
    plugins: {legend: {display: false}, tooltip: {callbacks: {label: (item) =>
      `${item.dataset.label}: ${readable(rows[item.dataIndex][1 + item.datasetIndex])} ms`}}}}})));
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawCharts);
