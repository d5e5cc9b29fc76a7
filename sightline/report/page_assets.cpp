// The style and the script of the report page.
// SPDX-License-Identifier: MIT
#include "sightline/report/page_assets.h"

namespace sightline {

const char* const kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f6f7f9; --card: #ffffff; --ink: #16202c; --soft: #5a6778; --line: #dce1e8;
  --good: #0f7a55; --good-back: #e3f5ed; --bad: #b3261e; --bad-back: #fde8e6; --note-back: #eef1f6;
  --one: #1f6feb; --two: #b45f06; --visible: #16a378; --frustum: #94a3b8; --occlusion: #ea7828;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #10151c; --card: #182029; --ink: #e6ebf2; --soft: #9aa7b8; --line: #2b3644;
    --good: #5fd3a3; --good-back: #12352a; --bad: #ff8a80; --bad-back: #43191a; --note-back: #1f2935;
    --one: #6cabff; --two: #f0a35c;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main, header.page, footer { max-width: 1180px; margin: 0 auto; padding: 0 20px; }
header.page { padding-top: 28px; }
h1 { font-size: 1.7rem; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 0 0 12px; }
p { margin: 6px 0; }
.soft { color: var(--soft); }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 18px; margin: 18px 0; }
.verdict { padding: 14px 18px; border-radius: 10px; margin: 18px 0 0; background: var(--note-back); }
.verdict strong { font-size: 1.12rem; }
.verdict.good { background: var(--good-back); color: var(--good); }
.verdict.bad { background: var(--bad-back); color: var(--bad); }
.verdict span { display: block; color: var(--ink); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(200px, 1fr)); gap: 14px; margin: 18px 0; }
.tile { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 14px 18px; }
.tile b { display: block; font-size: 1.65rem; line-height: 1.25; font-variant-numeric: tabular-nums; }
.player { display: flex; gap: 14px; align-items: center; margin: 0 0 14px; flex-wrap: wrap; }
.player input { flex: 1 1 240px; accent-color: var(--one); min-height: 28px; }
.player output { min-width: 9.5em; font-variant-numeric: tabular-nums; }
button { font: inherit; color: var(--ink); background: var(--note-back); border: 1px solid var(--line);
  border-radius: 8px; padding: 5px 16px; cursor: pointer; min-width: 5.5em; }
button:focus-visible, input:focus-visible { outline: 3px solid var(--one); outline-offset: 2px; }
figure { margin: 0; }
figure img { display: block; width: 100%; height: auto; border-radius: 6px; background: #0006; }
figcaption { color: var(--soft); font-size: .92rem; margin-top: 6px; }
figcaption b { color: var(--ink); font-variant-numeric: tabular-nums; }
.stage { display: grid; grid-template-columns: minmax(0, 1.85fr) minmax(0, 1fr); gap: 18px; align-items: start; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 18px; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 340px), 1fr)); gap: 22px 18px; }
.gallery h3 { font-size: 1rem; margin: 0 0 6px; } .gallery .heat { margin-top: 8px; }
.crisp img { image-rendering: pixelated; }
.costs { display: grid; grid-template-columns: max-content minmax(0, 1fr) max-content; gap: 8px 14px; align-items: center;
  font-variant-numeric: tabular-nums; }
.costs > span:nth-child(3n) { text-align: right; }
.costs .share { margin: 0; display: flex; border-radius: 3px; } .costs .share div { min-width: 0; } .costs .share div + div { background: var(--two); }
.tag { display: inline-block; font-size: .82rem; padding: 0 8px; border-radius: 9px; background: var(--note-back);
  color: var(--soft); }
.tag.good { background: var(--good-back); color: var(--good); } .tag.bad { background: var(--bad-back); color: var(--bad); }
.bars rect { fill: var(--one); } .bars .tick { fill: var(--soft); font-size: 12px; }
.plan img { background: var(--note-back); image-rendering: auto; border: 1px solid var(--line); }
.legend { display: flex; flex-wrap: wrap; gap: 4px 16px; font-size: .92rem; color: var(--soft); margin-top: 6px; }
.legend i { display: inline-block; width: .8em; height: .8em; border-radius: 2px; margin-right: .45em; }
.bar { height: 12px; border-radius: 3px; margin-top: 14px; }
.scale { display: flex; justify-content: space-between; margin-top: 4px; font-size: .92rem; color: var(--soft); }
.heatscale { position: relative; height: 1.5em; } .heatscale span { position: absolute; white-space: nowrap; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: 7px 12px; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { color: var(--soft); font-weight: 500; }
thead tr:first-child th { text-align: center; border-bottom: 0; padding-bottom: 0; }
.counts thead tr:first-child th { text-align: right; padding-bottom: 7px; } .counts tbody th { font-weight: 400; } .counts thead tr:first-child th:first-child { text-align: left; }
.counts th, .counts td { padding: 6px 8px; font-size: .92rem; }
.methods th, .methods td { padding: 5px 6px; font-size: .86rem; } .methods th { white-space: normal; }
.methods td + td, .methods thead th + th { min-width: 5.4em; } .methods tbody th { min-width: 9em; }
.methods thead th { vertical-align: bottom; } .methods th:first-child { position: sticky; left: 0; background: var(--card); }
.apart { border-left: 1px solid var(--line); }
.share { height: 14px; border-radius: 7px; background: var(--line); overflow: hidden; margin: 8px 0 4px; }
.share div { height: 100%; background: var(--one); min-width: 2px; }
.chart { display: block; width: 100%; height: auto; }
.chart .grid { stroke: var(--line); } .chart .tick { fill: var(--soft); font-size: 12px; }
.chart polyline { fill: none; stroke-width: 2; stroke-linejoin: round; }
.one polyline { stroke: var(--one); } .one circle, i.one { fill: var(--one); background: var(--one); }
.two polyline { stroke: var(--two); } .two circle, i.two { fill: var(--two); background: var(--two); }
.chart .now { stroke: var(--soft); stroke-dasharray: 3 3; } .chart .hit { fill: transparent; }
.chart .hit:hover { fill: var(--soft); fill-opacity: .15; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 6px 20px; margin: 0; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
code { font: .92em ui-monospace, monospace; background: var(--note-back); padding: 1px 5px; border-radius: 4px; }
footer { padding-bottom: 30px; color: var(--soft); font-size: .92rem; }
@media (max-width: 760px) {
  .stage, .pair { grid-template-columns: 1fr; }
  .methods tbody th { min-width: 7.8em; overflow-wrap: break-word; }
  .costs { grid-template-columns: 1fr max-content; grid-auto-flow: dense; gap: 2px 14px; }
  .costs .share, .costs .scale { grid-column: 1 / -1; margin-bottom: 8px; }
  dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: 8px; }
}
)css";

const char* const kPageScript = R"js(
const data = JSON.parse(document.getElementById('data').textContent);
const slider = document.getElementById('frame'), play = document.getElementById('play');
const put = (id, text) => { document.getElementById(id).textContent = text; };
function show(index) {
  const shot = data.pictures[index];
  if (!shot) return;
  slider.value = index;
  for (const [id, uri] of Object.entries(shot.images)) document.getElementById(id).src = uri;
  for (const [id, text] of Object.entries(shot.texts)) put(id, text);
  slider.setAttribute('aria-valuetext', shot.texts['at']);
  for (const line of document.querySelectorAll('.now')) {
    const left = +line.dataset.left, right = +line.dataset.right;
    const x = left + (right - left) * (data.frames > 1 ? shot.frame / (data.frames - 1) : 0);
    line.setAttribute('x1', x);
    line.setAttribute('x2', x);
  }
}
let timer = 0;
function stop() { clearInterval(timer); timer = 0; play.textContent = 'Play'; }
play.addEventListener('click', () => {
  if (timer) return stop();
  play.textContent = 'Pause';
  timer = setInterval(() => show((+slider.value + 1) % data.pictures.length), 700);
});
slider.addEventListener('input', () => { stop(); show(+slider.value); });
for (const hit of document.querySelectorAll('.hit')) hit.addEventListener('click', () => {
  const frame = +hit.dataset.frame;
  let best = 0;
  data.pictures.forEach((shot, i) => {
    if (Math.abs(shot.frame - frame) < Math.abs(data.pictures[best].frame - frame)) best = i;
  });
  stop();
  show(best);
});
show(0);
)js";

}  // namespace sightline
