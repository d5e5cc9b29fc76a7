// The page of two runs beside one another, from their comparison (schema sightline.compare/1) and both runs.
// SPDX-License-Identifier: MIT
'use strict';

function compareFilm(pairs, films) {
  const figures = (id, what, css = '') => {
    const sides = ['a', 'b'].map((side, i) => {
      const image = filmImage(films[i], id, `${what} of run ${side.toUpperCase()}`, {id: `${id}-${side}`},
        (f) => pairs[f][side]);
      return image && figure(h('div', {class: 'over'}, image, staleMark(films[i], (f) => pairs[f][side])),
        `${side.toUpperCase()}: ${what}`, css);
    });
    return sides.some(Boolean) && h('div', {class: 'pair'}, sides);
  };
  return card('film', 'Frame by frame', controls(pairs.length, (f) =>
    `frame ${pairs[f].a} of A, ${pairs[f].b} of B: B takes ${short(pairs[f].ratio)} times as long`),
  figures('shaded', 'what the camera sees'), figures('heat-kept', 'surfaces drawn for a pixel, with culling'),
  figures('plan', 'from above, by what culled each object', 'plan'));
}

function compareCharts(pairs, [a, b]) {
  const both = (key) => [{name: 'A', colour: 'one', values: pairs.map((pair) => a.frames[pair.a][key])},
    {name: 'B', colour: 'two', values: pairs.map((pair) => b.frames[pair.b][key])}];
  const of = (name, colour, key) => ({name, colour, values: pairs.map((pair) => pair[key])});
  return [pair(
    card('time', 'Query, µs', plot('time-chart', 'Time of the query in each frame', 'µs', both('query_microseconds'))),
    card('ratio', 'Time of B over time of A',
      plot('ratio-chart', 'Time of B over time of A', 'times A’s', [of('B over A', 'ink', 'ratio')]))),
  pair(card('kept', 'Objects kept', plot('kept-chart', 'Objects kept in each frame', 'objects', both('kept'))),
    card('apart', 'Objects that only one kept', plot('apart-chart', 'Objects that only one of them kept', 'objects',
      [{...of('only A', 'one', 'only_a'), area: true}, {...of('only B', 'two', 'only_b'), area: true}])))];
}

function sidesCard(c, runs) {
  const both = (what, of) => [what, ...runs.map(of)], pairs = Math.max(1, c.frames.length);
  const rate = (value) => value === null ? '–' : value.toFixed(3) + '×';
  const side = (colour, name) => [h('i', {class: 'swatch ' + colour}), name];
  return card('sides', 'Both runs', table('Both runs', ['', side('one', 'A'), side('two', 'B')], [
    ['file', c.a.file, c.b.file],
    both('scene', (run) => run.scene.file),
    both('objects', (run) => grouped(run.scene.objects)),
    both('triangles', (run) => grouped(run.scene.triangles)),
    both('frames', (run) => grouped(run.frames.length) + (run.interrupted ? ', interrupted' : '')),
    ['frames without a partner', grouped(c.unpaired.a), grouped(c.unpaired.b)],
    both('viewport', (run) => `${run.width} × ${run.height}`),
    both('image shift, pixels', (run) => run.jitter),
    both('occlusion buffer, longer side at most', (run) => grouped(run.occlusion_size)),
    both('queries a frame', (run) => run.repeat),
    ['query, median µs', readable(c.time.a_microseconds), readable(c.time.b_microseconds)],
    ['objects kept a frame', readable(c.kept.a / pairs), readable(c.kept.b / pairs)],
    ['triangles a frame', readable(c.triangles.a / pairs), readable(c.triangles.b / pairs)],
    ['over-estimate', rate(c.over_estimate.a), rate(c.over_estimate.b)],
    ['false culls', grouped(c.false_culls.a), grouped(c.false_culls.b)]], 'counts wide sides'));
}

const differencesCard = ({objects}) => objects.length > 0 && card('differ', 'Objects that differ',
  table('Objects that differ', ['object', 'path', 'key', 'frames, only A', 'frames, only B'], objects.map((row) =>
    [named(row.name || 'object ' + row.key),
      h('span', {class: 'path'}, row.path === row.name ? '' : named(row.path)), row.key,
      row.frames_only_a, row.frames_only_b]), 'counts wide'),
  data.different > objects.length && note(`and ${grouped(data.different - objects.length)} more, in the JSON`));

function comparePage() {
  const {compare: c, runs, films} = data, scene = fileName(runs[0].scene.file);
  setHead('Two runs of ' + scene, [h('b', {}, 'A'), ` ${c.a.file}, `, h('b', {}, 'B'), ` ${c.b.file}; ` +
    `${c.paired} frames have the same camera in both`],
  verdict(c.ok ? 'good' : 'bad', c.ok ? 'B passes: no new false culls' : 'B fails', c.verdict));
  at('main').append(...[
    c.paired > 0 && compareFilm(c.frames, films),
    tiles([short(c.time.ratio) + '×', `time of B over A, median; ${short(c.time.ratio_low)} to ` +
      `${short(c.time.ratio_high)} in the middle eight tenths`],
    [grouped(c.kept.only_a), 'times an object only A kept'], [grouped(c.kept.only_b), 'times an object only B kept'],
    [grouped(c.false_culls.new), 'false culls of B that A has not']),
    c.paired > 0 && compareCharts(c.frames, runs), sidesCard(c, runs), differencesCard(c)].flat(9).filter(Boolean));
  if (!c.paired) return null;
  return frameWorthALook(c.frames.map((pair) => runs[0].frames[pair.a]), {shots: []});
}
