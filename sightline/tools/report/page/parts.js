// What all pages are made of: elements, numbers for reading, cards, tables and tiles.
// SPDX-License-Identifier: MIT
'use strict';

// Texts of unknown origin: what ends a line, moves a cursor or turns the direction of writing is a space.
const kUnfit = /[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]/g;
const data = JSON.parse(document.getElementById('data').textContent, (key, value) =>
  typeof value === 'string' && !value.startsWith('data:') ? value.replace(kUnfit, ' ') : value);
const at = (id) => document.getElementById(id);
const all = (selector, within = document) => [...within.querySelectorAll(selector)];

/** An element: h('td', {class: 'path'}, 'text', node, [more]). Text stays text; null, false and '' are left out. */
function h(tag, attributes, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children.flat(9).filter((child) => child || child === 0));
  return made;
}

const grouped = (value) => Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, ',');
/** Four digits, grouped if it is large. */
const readable = (value) => value === null || value === undefined || !isFinite(value) ? '–'
  : Math.abs(value) < 1e-6 ? '0' : Math.abs(value) < 1000 ? String(+value.toPrecision(4)) : grouped(value);
const short = (value) => Math.abs(value) < 1e-6 ? '0' : value < 1000 ? String(+value.toPrecision(3)) : grouped(value);
const plural = (count, one, many = one + 's') => grouped(count) + ' ' + (count === 1 ? one : many);
function percent(part, whole) {
  const value = whole > 0 ? 100 * part / whole : 0;
  return value > 0 && value < 0.01 ? 'under 0.01 %' : value.toFixed(value < 1 ? 2 : 1) + ' %';
}
const sum = (values) => values.reduce((total, value) => total + value, 0);
const mean = (values) => values.length ? sum(values) / values.length : 0;
function median(values) {
  const sorted = [...values].sort((a, b) => a - b), n = sorted.length;
  return n ? (sorted[n >> 1] + sorted[(n - 1) >> 1]) / 2 : 0;
}
/** The index of the largest value. */
const largest = (values) => values.reduce((best, value, i) => value > values[best] ? i : best, 0);
/** A name, or both ends of a long one; the whole of it shows when it is pointed at. */
function named(name, most = 60) {
  const letters = [...name], head = Math.floor(most / 3);
  return letters.length <= most ? name : h('span', {title: name},
    letters.slice(0, head).join('') + '…' + letters.slice(letters.length - (most - head - 1)).join(''));
}
const fileName = (path) => path.slice(path.lastIndexOf('/') + 1);

function card(id, heading, ...body) {
  if (!body.flat(9).some(Boolean)) return null;
  return h('section', {class: 'card', id, 'aria-labelledby': 'h-' + id}, h('h2', {id: 'h-' + id}, heading), body);
}
/** Two cards beside one another, or one alone. */
const pair = (...cards) => cards.some(Boolean) ? h('div', {class: 'pair cards'}, cards) : null;
const note = (...text) => h('p', {class: 'soft'}, text);
const tiles = (...list) => h('div', {class: 'tiles'}, list.filter(Boolean).map(([value, text]) =>
  h('div', {class: 'tile'}, h('b', {}, value), h('span', {class: 'soft'}, text))));
const verdict = (kind, strong, ...lines) => h('div', {class: 'verdict ' + kind, role: 'status'},
  h('strong', {}, strong), lines.flat().filter(Boolean).map((line) => h('span', {}, line)));
const definitions = (rows) => h('dl', {}, rows.filter(Boolean).map(([term, text]) =>
  [h('dt', {}, term), h('dd', {}, text)]));
const legend = (entries) => h('div', {class: 'legend'}, entries.map(([css, name]) =>
  h('span', {}, h('i', {class: 'swatch ' + css}), name)));
const bytes = (count) => count < 1e6 ? readable(count / 1e3) + ' kB' : readable(count / 1e6) + ' MB';

/** A table in an area that scrolls. The first cell of a row is its heading; a cell is text, a number or an element. */
function table(label, head, rows, css = '') {
  return h('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': label},
    h('table', {class: css},
      h('thead', {}, h('tr', {}, head.map((cell) => cell === '' ? h('td') : h('th', {scope: 'col'}, cell)))),
      h('tbody', {}, rows.map(tableRow))));
}
const tableRow = ([first, ...cells]) =>
  h('tr', {}, h('th', {scope: 'row'}, first), cells.map((cell) => h('td', {}, cell)));

const picture = (src, alt, attributes = {}) => h('img', {src, alt, ...attributes});
const figure = (image, caption, css = '') => h('figure', {class: css}, image, h('figcaption', {}, caption));
/** The colours of heat maps with their values, which grow with the square. */
function heatLegend(full) {
  const ticks = [0, 0.125, 0.25, 0.5, 1].map((part) => h('span', {style:
    `left:${100 * Math.sqrt(part)}%;transform:translateX(-${part === 0 ? 0 : part < 1 ? 50 : 100}%)`},
    short(part * full) + (part < 1 ? '' : ' or more')));
  return [h('div', {class: 'bar', role: 'img', 'aria-label': 'Colour scale'}), h('div', {class: 'scale'}, ticks)];
}
/** An element of a drawing. */
function svg(tag, attributes) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}
/** The bytes of a base64 text. */
const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
/** Lets the cells of a map be asked, by a click or a number: ask(cell) shows the answer and returns it in words. */
function askedByNumber(map, count, first, ask) {
  const number = h('input', {type: 'number', min: 0, max: count - 1, step: 1, 'aria-label': 'Cell'});
  const words = h('output', {'aria-live': 'polite'});
  const answer = (cell) => {
    number.value = cell;
    words.textContent = ask(cell);
  };
  map.addEventListener('click', (event) => {
    // Of cells above one another a second click takes the next.
    const under = document.elementsFromPoint(event.clientX, event.clientY).filter((at) => at.dataset.cell)
      .map((at) => +at.dataset.cell).sort((a, b) => a - b);
    if (under.length > 0) answer(under[(under.indexOf(+number.value) + 1) % under.length]);
  });
  number.addEventListener('change', () => answer(Math.min(count - 1, Math.max(0, Math.round(+number.value) || 0))));
  answer(first);
  return h('div', {class: 'player'}, h('label', {}, 'Cell ', number), words);
}
function setHead(title, subtitle, ...below) {
  document.title = title.slice(0, 200) + ' – Sightline';
  at('head').append(h('h1', {}, named(title, 120)), note(subtitle), ...below.filter(Boolean));
}
const repeatRow = () => data.command && ['Repeat it', h('code', {}, data.command)];
