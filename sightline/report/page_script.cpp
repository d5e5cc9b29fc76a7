// The script of the report page: the film, the charts that follow it, and the table of objects.
// SPDX-License-Identifier: MIT
#include "sightline/report/page_assets.h"

namespace sightline {

const char* const kPageScript = R"js('use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const at = (id) => document.getElementById(id);
const all = (selector) => [...document.querySelectorAll(selector)];
const put = (id, text) => { const place = at(id); if (place) place.textContent = text; };
const grouped = (value) => Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, ',');
const readable = (value) => value === null || value === undefined ? '–'
  : Math.abs(value) < 1000 ? String(+value.toPrecision(4)) : grouped(value);
const slider = at('frame'), play = at('play');
let frame = 0, look = 'shaded', timer = 0;

function nearestPicture(f) {
  let best = null;
  for (const shot of data.pictures)
    if (!best || Math.abs(shot.frame - f) < Math.abs(best.frame - f)) best = shot;
  return best;
}
function showPicture(f) {
  const shot = nearestPicture(f);
  if (!shot) return;
  for (const [id, uri] of Object.entries(shot.images)) {
    const image = at(id);
    if (image && image.src !== uri) image.src = uri;
  }
  put('plan-text', shot.plan);
  put('section-text', shot.section);
  if (at('windows-text')) put('windows-text', shot.windows);
  if (shot.depth_all !== undefined) {
    put('depth-all', shot.depth_all.toFixed(2));
    put('depth-kept', shot.depth_kept.toFixed(2));
    put('same', shot.same ? 'The picture with culling is the same, sample by sample.'
                          : 'The picture with culling differs.');
  }
  const stale = at('stale');
  if (stale) {
    stale.hidden = shot.frame === f;
    stale.textContent = 'picture of frame ' + shot.frame;
  }
}
function showLook() {
  const layers = {objects: look === 'objects', culled: look === 'culled', buffer: look === 'buffer',
                  windows: look === 'windows'};
  for (const [id, on] of Object.entries(layers)) if (at(id)) at(id).hidden = !on;
  for (const id of ['buffer', 'windows']) if (at(id + '-text')) at(id + '-text').hidden = look !== id;
  if (at('same')) at('same').hidden = look === 'buffer' || look === 'windows';
  const screen = document.querySelector('.screen');
  if (screen) screen.classList.toggle('through', look === 'culled');
}
function valuesAt(id, f) {
  return 'frame ' + f + ': ' + data.charts[id].map((series) =>
    series.name + ' ' + readable(series.values[f])).join(', ') + ' ' + data.charts[id][0].unit;
}
function share(f) { return data.frames > 1 ? 100 * f / (data.frames - 1) : 50; }
function showNumbers(now) {
  put('this-frame', 'frame ' + frame);
  put('at-kept', grouped(now.kept[frame]) + ' of ' + grouped(data.objects));
  put('at-exact', now.exact[frame] === null ? '–' : grouped(now.exact[frame]));
  put('at-triangles', grouped(now.triangles[frame]));
  put('at-query', readable(now.query[frame]));
  now.stages.forEach((stage, i) => {
    for (const name of ['tested', 'culled', 'doubt']) put(name + '-' + i, grouped(stage[name][frame]));
    put('time-' + i, stage.time[frame].toFixed(1));
  });
  put('query-culled', grouped(data.objects - now.kept[frame]));
  put('query-time', now.query[frame].toFixed(1));
}
function show(f) {
  frame = Math.min(Math.max(f, 0), data.frames - 1);
  slider.value = frame;
  slider.setAttribute('aria-valuetext', 'frame ' + frame);
  put('at', data.labels ? data.labels[frame] : 'frame ' + frame + ' of ' + data.frames);
  if (data.frame) showNumbers(data.frame);
  showPicture(frame);
  for (const plot of all('.plot')) {
    plot.querySelector('.now').style.left = share(frame) + '%';
    plot.setAttribute('aria-valuenow', frame);
    plot.setAttribute('aria-valuetext', valuesAt(plot.id, frame));
    put(plot.id + '-values', valuesAt(plot.id, frame));
  }
  fillTable();
}

function stop() {
  clearInterval(timer);
  timer = 0;
  play.textContent = 'Play';
  play.setAttribute('aria-pressed', 'false');
}
function step(by) { stop(); show(frame + by); }
if (slider) {
  const slow = matchMedia('(prefers-reduced-motion: reduce)').matches;
  play.addEventListener('click', () => {
    if (timer) return stop();
    play.textContent = 'Pause';
    play.setAttribute('aria-pressed', 'true');
    timer = setInterval(() => show((frame + 1) % data.frames), slow ? 2000 : 700);
  });
  slider.addEventListener('input', () => { stop(); show(+slider.value); });
  at('back').addEventListener('click', () => step(-1));
  at('forth').addEventListener('click', () => step(1));
}
for (const radio of all('input[name=look]')) radio.addEventListener('change', () => {
  look = radio.value;
  showLook();
});
document.addEventListener('keydown', (event) => {
  const moves = {ArrowLeft: -1, ArrowRight: 1};
  const to = event.target;
  if (!(event.key in moves) || event.ctrlKey || event.altKey || event.metaKey || !slider) return;
  if (to.tagName === 'INPUT' || to.classList.contains('scroll')) return;
  event.preventDefault();
  step(moves[event.key]);
});

for (const plot of all('.plot')) {
  const area = plot.querySelector('.area'), mark = plot.querySelector('.at');
  const frameAt = (event) => {
    const box = area.getBoundingClientRect();
    return Math.round(Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1) * (data.frames - 1));
  };
  plot.addEventListener('pointermove', (event) => {
    mark.style.display = 'block';
    mark.style.left = share(frameAt(event)) + '%';
    put(plot.id + '-values', valuesAt(plot.id, frameAt(event)));
  });
  plot.addEventListener('pointerleave', () => {
    mark.style.display = 'none';
    put(plot.id + '-values', valuesAt(plot.id, frame));
  });
  plot.addEventListener('click', (event) => { stop(); show(frameAt(event)); });
}
for (const button of all('.go')) button.addEventListener('click', () => {
  stop();
  show(+button.dataset.frame);
  at('film').scrollIntoView({block: 'start'});
});

const rows = at('rows');
let order = data.rows.map((row, i) => i), shown = 20, sorted = null, rising = false;
function cell(line, text, tag) {
  const made = document.createElement(tag || 'td');
  made.textContent = text;
  line.appendChild(made);
  return made;
}
function fillTable() {
  if (!rows) return;
  const wanted = at('search').value.trim().toLowerCase(), digits = data.row_stages[frame] || '';
  const kept = at('only-kept').checked;
  const fits = (i) => (!kept || digits[i] === '0') && (!wanted || String(data.rows[i][0]) === wanted ||
    data.rows[i][1].toLowerCase().includes(wanted) || data.rows[i][2].toLowerCase().includes(wanted));
  const found = order.filter(fits);
  put('found', grouped(found.length) + ' found');
  put('table-frame', frame);
  at('more').hidden = found.length <= shown;
  const paths = !!at('paths'), lines = document.createDocumentFragment();
  const triangles = !!document.querySelector('.sort[data-by="3"]');
  for (const i of found.slice(0, shown)) {
    const [key, name, path, count, frames] = data.rows[i], line = document.createElement('tr');
    cell(line, name || 'object ' + key);
    if (paths) cell(line, path === name ? '' : path).className = 'path';
    cell(line, key);
    if (triangles) cell(line, grouped(count));
    cell(line, frames + ' of ' + data.frames);
    const stage = +digits[i], place = cell(line, ''), swatch = document.createElement('i');
    swatch.className = 'stage-' + stage;
    place.appendChild(swatch);
    place.appendChild(document.createTextNode(triangles || stage === 0 ? data.stage_names[stage] : 'culled'));
    lines.appendChild(line);
  }
  rows.replaceChildren(lines);
}
if (rows) {
  at('search').addEventListener('input', () => { shown = 20; fillTable(); });
  at('only-kept').addEventListener('change', fillTable);
  at('more').addEventListener('click', () => { shown += 200; fillTable(); });
  for (const button of all('.sort')) button.addEventListener('click', () => {
    const by = +button.dataset.by;
    rising = sorted === by ? !rising : false;
    sorted = by;
    order.sort((a, b) => (data.rows[a][by] - data.rows[b][by]) * (rising ? 1 : -1) || a - b);
    for (const other of all('.sort'))
      other.closest('th').setAttribute('aria-sort', other === button ? (rising ? 'ascending' : 'descending') : 'none');
    fillTable();
  });
}
function follow() {
  const wanted = /^#frame-(\d+)$/.exec(location.hash);
  if (slider && wanted) { stop(); show(+wanted[1]); }
}
addEventListener('hashchange', follow);
if (slider) show(0);
follow();
)js";

}  // namespace sightline
