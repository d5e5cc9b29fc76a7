// The style of the pages of reports.
// SPDX-License-Identifier: MIT
#include "sightline/report/page_assets.h"

namespace sightline {

const char* const kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f6f7f9; --card: #ffffff; --ink: #16202c; --soft: #5a6778; --line: #dce1e8;
  --good: #0f7a55; --good-back: #e3f5ed; --bad: #b3261e; --bad-back: #fde8e6; --note-back: #eef1f6;
  --one: #0b62b8; --two: #b45f06; --shade: #0002;
  --stage-0: #0072b2; --stage-1: #5b4a8a; --stage-2: #8f6fd1; --stage-3: #8a94a3; --stage-4: #009e73;
  --stage-5: #968414; --stage-6: #cc79a7; --stage-7: #e67e00; --stage-8: #6b2d1e; --in-view: #facc15aa;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #10151c; --card: #182029; --ink: #e6ebf2; --soft: #9aa7b8; --line: #2b3644;
    --good: #5fd3a3; --good-back: #12352a; --bad: #ff8a80; --bad-back: #43191a; --note-back: #1f2935;
    --one: #6cabff; --two: #f0a35c; --shade: #fff1;
    --stage-0: #3aa0e0; --stage-1: #8577bd; --stage-2: #b39df0; --stage-3: #8a94a3; --stage-4: #35b48f;
    --stage-5: #c4b13c; --stage-6: #d58db5; --stage-7: #f0922b; --stage-8: #f3d6cd;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main, header.page, footer { max-width: 1520px; margin: 0 auto; padding: 0 clamp(14px, 2.4vw, 40px); }
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
.verdict.note { border-left: 5px solid var(--two); }
nav { display: flex; flex-wrap: wrap; gap: 4px 18px; margin-top: 14px; }
a { color: var(--one); text-underline-offset: 2px; }
.player { display: flex; gap: 10px 12px; align-items: center; margin: 0 0 14px; flex-wrap: wrap; }
.player input[type=range] { flex: 1 1 200px; min-width: 0; accent-color: var(--one); min-height: 32px; }
.player input[type=search] { flex: 1 1 200px; min-width: 0; font: inherit; color: var(--ink); background: var(--page);
  border: 1px solid var(--line); border-radius: 8px; padding: 5px 10px; }
.tick-box { display: flex; gap: 7px; align-items: center; }
.tick-box input { width: 18px; height: 18px; accent-color: var(--one); }
#back, #forth { min-width: 2.6em; padding: 5px 10px; }
.player output { min-width: 9.5em; font-variant-numeric: tabular-nums; }
button { font: inherit; color: var(--ink); background: var(--note-back); border: 1px solid var(--line);
  border-radius: 8px; padding: 5px 16px; cursor: pointer; min-width: 5.5em; }
button:focus-visible, input:focus-visible, a:focus-visible, [tabindex]:focus-visible,
  .switch input:focus-visible + span {
  outline: 3px solid var(--one); outline-offset: 2px; }
.unseen { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
.switch { display: flex; flex-wrap: wrap; gap: 6px; border: 0; padding: 0; margin: 0 0 10px; }
.switch label { position: relative; }
.switch input { position: absolute; inset: 0; opacity: 0; margin: 0; cursor: pointer; }
.switch span { display: block; padding: 5px 14px; border: 1px solid var(--line); border-radius: 8px;
  background: var(--note-back); }
.switch input:checked + span { background: var(--one); border-color: var(--one); color: var(--card); }
.screen { position: relative; border-radius: 6px; overflow: hidden; background: var(--shade); }
.screen img { position: absolute; inset: 0; width: 100%; height: 100%; border-radius: 0; background: none;
  transition: opacity .25s; }
.screen.through #shaded { filter: saturate(.25) brightness(.8) contrast(.8); }
#stale { position: absolute; right: 10px; bottom: 10px; padding: 2px 10px; border-radius: 6px; background: #000c;
  color: #fff;
  font-size: .86rem; }
[hidden] { display: none !important; }
.facts { display: flex; flex-wrap: wrap; gap: 8px 30px; margin: 12px 0 0; }
.facts dd { font-size: 1.2rem; font-variant-numeric: tabular-nums; }
.plans { display: grid; gap: 14px; align-content: start; }
i[class^=stage-], i.in-view, i.ink { display: inline-block; width: .8em; height: .8em; border-radius: 2px;
  margin-right: .45em; }
i.stage-0 { background: var(--stage-0); } i.stage-1 { background: var(--stage-1); }
i.stage-2 { background: var(--stage-2); } i.stage-3 { background: var(--stage-3); }
i.stage-4 { background: var(--stage-4); } i.stage-5 { background: var(--stage-5); }
i.stage-6 { background: var(--stage-6); } i.stage-7 { background: var(--stage-7); }
i.stage-8 { background: var(--stage-8); }
i.in-view { background: var(--in-view); } i.ink { background: var(--ink); }
.plot polygon { stroke: none; } g.one polygon { fill: var(--one); } g.two polygon { fill: var(--two); }
g.stage-1 polygon { fill: var(--stage-1); } g.stage-2 polygon { fill: var(--stage-2); }
g.stage-3 polygon { fill: var(--stage-3); } g.stage-4 polygon { fill: var(--stage-4); }
g.stage-5 polygon { fill: var(--stage-5); } g.stage-6 polygon { fill: var(--stage-6); }
g.stage-7 polygon { fill: var(--stage-7); } g.stage-8 polygon { fill: var(--stage-8); }
.plot { padding: 10px 14px 30px 64px; border-radius: 8px; cursor: pointer; touch-action: pan-y; }
.plot .area { position: relative; height: 210px; }
.plot svg { position: absolute; inset: 0; width: 100%; height: 100%; overflow: visible; }
.plot svg * { vector-effect: non-scaling-stroke; } .plot .grid { stroke: var(--line); fill: none; }
.plot polyline { fill: none; stroke-width: 2; stroke-linejoin: round; }
.plot .dots { stroke-width: 6; stroke-linecap: round; }
.plot .one { stroke: var(--one); } .plot .two { stroke: var(--two); } .plot .ink { stroke: var(--ink); }
.plot .tick { position: absolute; font-size: .8rem; color: var(--soft); font-variant-numeric: tabular-nums;
  white-space: nowrap; }
.plot .up { right: calc(100% + 8px); transform: translateY(50%); }
.plot .along { top: calc(100% + 6px); transform: translateX(-50%); }
.plot .now, .plot .at { position: absolute; top: 0; bottom: 0; width: 0; border-left: 2px dashed var(--soft);
  left: 0; }
.plot .at { border-left: 8px solid var(--shade); margin-left: -4px; display: none; }
.readout { min-height: 1.5em; font-size: .92rem; font-variant-numeric: tabular-nums; margin: 0 0 4px; }
.cards > .card:first-child:last-child { grid-column: 1 / -1; } .cards { align-items: stretch; }
.cards > .card { margin: 0; }
.cards { margin: 18px 0; }
.names { padding-left: 1.2em; margin: 4px 0 12px; } .names li { overflow-wrap: anywhere; }
.objects td:nth-child(1), .objects .path, .objects #paths { text-align: left; white-space: normal;
  overflow-wrap: anywhere; }
.objects td:nth-child(1) { min-width: 9em; } .objects td:last-child { text-align: left; }
.objects th:last-child { text-align: left; }
.objects thead tr:first-child th { text-align: right; padding-bottom: 7px; border-bottom: 1px solid var(--line); }
.objects thead tr:first-child th:first-child, .objects thead tr:first-child #paths,
  .objects thead tr:first-child th:last-child { text-align: left; }
.sort { background: none; border: 0; padding: 0; min-width: 0; color: inherit; text-decoration: underline dotted; }
.wide tbody th { white-space: normal; overflow-wrap: anywhere; min-width: 9em; }
.wide thead th { white-space: normal; vertical-align: bottom; } .wide thead th:first-child { width: 46%; }
thead td { border-bottom: 0; } .go { margin-top: 12px; }
i.swatch { display: inline-block; width: .8em; height: .8em; border-radius: 2px; margin-right: .45em; }
.sides td { white-space: normal; overflow-wrap: anywhere; }
.path { white-space: normal; overflow-wrap: anywhere; min-width: 10em; }
.mini { float: left; margin-top: .5em; width: 56px; height: 9px; margin-right: 10px; border-radius: 3px;
  background: var(--line); overflow: hidden; }
.mini i { display: block; height: 100%; background: var(--stage-7); }
figure { margin: 0; }
figure img { display: block; width: 100%; height: auto; border-radius: 6px; background: #0006; }
figcaption { color: var(--soft); font-size: .92rem; margin-top: 6px; }
figcaption b { color: var(--ink); font-variant-numeric: tabular-nums; }
.stage { display: grid; grid-template-columns: minmax(0, 2.15fr) minmax(0, 1fr); gap: 18px; align-items: start; }
.pair { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 18px; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 340px), 1fr)); gap: 22px 18px; }
.gallery h3 { font-size: 1rem; margin: 0 0 6px; } .gallery .heat { margin-top: 8px; }
.crisp img { image-rendering: pixelated; }
.costs { display: grid; grid-template-columns: max-content minmax(0, 1fr) max-content; gap: 8px 14px;
  align-items: center;
  font-variant-numeric: tabular-nums; }
.costs > span:nth-child(3n) { text-align: right; }
.costs .share { margin: 0; display: flex; border-radius: 3px; } .costs .share div { min-width: 0; }
.costs .share div + div { background: var(--two); }
.tag { display: inline-block; font-size: .82rem; padding: 0 8px; border-radius: 9px; background: var(--note-back);
  color: var(--soft); }
.tag.good { background: var(--good-back); color: var(--good); }
.tag.bad { background: var(--bad-back); color: var(--bad); }
.bars rect { fill: var(--one); } .bars .tick { fill: var(--soft); font-size: 12px; }
.plan img { background: var(--note-back); image-rendering: auto; border: 1px solid var(--line); }
.legend { display: flex; flex-wrap: wrap; gap: 4px 16px; font-size: .92rem; color: var(--soft); margin-top: 6px; }
.legend i { display: inline-block; width: .8em; height: .8em; border-radius: 2px; margin-right: .45em; }
.bar { height: 12px; border-radius: 3px; margin-top: 14px; }
.scale { display: flex; justify-content: space-between; margin-top: 4px; font-size: .92rem; color: var(--soft); }
.heatscale { position: relative; height: 1.5em; } .heatscale span { position: absolute; white-space: nowrap; }
.scroll { overflow-x: auto; } .tall { max-height: 560px; overflow-y: auto; }
.tall thead th { position: sticky; top: 0; background: var(--card); }
.pair > figure.plan img { max-height: 440px; width: auto; max-width: 100%; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
tbody th { font-weight: 400; }
th, td { text-align: right; padding: 7px 12px; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { color: var(--soft); font-weight: 500; }
thead tr:first-child th { text-align: center; border-bottom: 0; padding-bottom: 0; }
.counts thead tr:first-child th { text-align: right; padding-bottom: 7px; } .counts tbody th { font-weight: 400; }
.counts thead tr:first-child th:first-child { text-align: left; }
.counts th, .counts td { padding: 6px 8px; font-size: .92rem; }
.methods th, .methods td { padding: 5px 6px; font-size: .86rem; } .methods th { white-space: normal; }
.methods td + td, .methods thead th + th { min-width: 5.4em; } .methods tbody th { min-width: 9em; }
.methods thead th { vertical-align: bottom; }
.methods th:first-child { position: sticky; left: 0; background: var(--card); }
.apart { border-left: 1px solid var(--line); }
.share { height: 14px; border-radius: 7px; background: var(--line); overflow: hidden; margin: 8px 0 4px; }
.share div { height: 100%; background: var(--one); min-width: 2px; }
.chart { display: block; width: 100%; height: auto; }
.chart .grid { stroke: var(--line); } .chart .tick { fill: var(--soft); font-size: 12px; }
i.one { background: var(--one); } i.two { background: var(--two); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 6px 20px; margin: 0; }
dl.facts { display: flex; } dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
code { font: .92em ui-monospace, monospace; background: var(--note-back); padding: 1px 5px; border-radius: 4px; }
footer { padding-bottom: 30px; color: var(--soft); font-size: .92rem; }
@media (max-width: 760px) {
  .stage, .pair { grid-template-columns: minmax(0, 1fr); }
  .plot { padding-left: 52px; padding-right: 4px; } .card { padding: 14px; }
  .tiles { grid-template-columns: 1fr 1fr; }
  .tile { padding: 10px 14px; } .tile b { font-size: 1.35rem; } th, td { padding: 6px 8px; }
  .methods tbody th { min-width: 7.8em; overflow-wrap: break-word; }
  .mini { float: none; display: block; margin: 0 0 4px auto; }
  .costs { grid-template-columns: 1fr max-content; grid-auto-flow: dense; gap: 2px 14px; }
  .costs .share, .costs .scale { grid-column: 1 / -1; margin-bottom: 8px; }
  dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: 8px; } dl.facts { gap: 4px 22px; }
  .facts dd { margin: 0; }
}
@media (prefers-reduced-motion: reduce) { * { transition: none !important; scroll-behavior: auto !important; } }
@media print {
  :root { color-scheme: light; } body { background: #fff; font-size: 11pt; }
  .player button, .player input, .switch, nav, .go, #more { display: none; }
  .card { break-inside: avoid; border-color: #999; } .scroll { overflow: visible; max-height: none; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";

}  // namespace sightline
