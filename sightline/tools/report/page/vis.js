// The page of a bake of visibility, from its JSON (schema sightline.vis/1).
// SPDX-License-Identifier: MIT
'use strict';

const kVisOrder = ['most', 'sightline', 'graph', 'middle', 'matrix', 'matrix-alike'];

/** How often the witnesses say that rows or their tree are wrong. */
const wrongBy = ({false_negatives: wrong, brushes}) =>
  wrong + (brushes ? brushes.false_negatives + brushes.solid_leaves : 0);

function visFacts(run) {
  const {verification, objects, leaks} = run;
  return card('how', 'The bake', definitions([
    ['Cells are', run.clusters_are],
    ['Pairs of cells', `${grouped(run.visible_cluster_pairs)} visible, ${grouped(run.witnessed_cluster_pairs)} of ` +
      'them witnessed by rays'],
    ['Pairs of leaves', `${grouped(run.visible_leaf_pairs)} visible, ${grouped(run.witnessed_pairs)} witnessed, ` +
      `${grouped(run.unresolved_pairs)} unresolved`],
    objects && ['Objects', `${grouped(objects.count)}: ${grouped(objects.visible_pairs)} pairs of a cell and an ` +
      `object, where the cells alone give ${grouped(objects.pairs_by_cells)}`],
    verification && ['Verified', `${grouped(verification.false_negatives)} of ${grouped(verification.segments)} ` +
      `sight lines join leaves that the rows call hidden; ${grouped(verification.doubtful)} are in doubt`],
    verification && verification.brushes && ['By brushes', `${grouped(verification.brushes.false_negatives)} of ` +
      `${grouped(verification.brushes.segments)} sight lines through the brushes join leaves that the rows call hidden; ` +
      `${grouped(verification.brushes.solid_leaves)} leaves are solid where no brush is`],
    leaks.length > 0 && ['Leaks', `from ${leaks[0].from}: the map is not sealed`],
    run.pvs_bytes > 0 && ['Size', `${bytes(run.pvs_bytes)} packed, ${bytes(run.resident_bytes)} when opened` +
      (run.lump_bytes > 0 ? `, ${bytes(run.lump_bytes)} as a lump` : '')],
    ['Work', `${grouped(run.steps)} portals clipped` + (run.over_budget ? `; ${grouped(run.over_budget)} portals and ` +
      'directions ended by the budget' : '') + (run.stopped ? '; stopped by a limit in seconds' : '')],
    ['Time', `${run.wall_seconds.toFixed(2)} s on ${plural(run.threads, 'thread')}`],
    ['Numbers', ['in ', h('code', {}, 'vis.json'), ' beside this page, and each picture as a PNG']]]));
}

/** The plan of the cells: one that is asked, by a click or its number, shows what it sees. */
function askedPlan(plan) {
  const visible = bytesOf(plan.visible), witnessed = bytesOf(plan.witnessed), count = plan.cells.length;
  const has = (rows, row, cell) => rows[row * plan.row_bytes + (cell >> 3)] >> (cell & 7) & 1;
  const shapes = plan.cells.map((points, cell) => svg('polygon', {points, 'data-cell': cell}));
  const map = svg('svg', {viewBox: `0 0 ${plan.width} ${plan.height}`, class: 'cells', role: 'img',
    'aria-label': 'Plan of the cells; colours show what the asked cell sees'});
  map.append(...shapes);
  function ask(cell) {
    const seen = {witnessed: 0, unresolved: 0};
    shapes.forEach((shape, other) => {
      const kind = !has(visible, cell, other) ? 'hidden' : has(witnessed, cell, other) ? 'witnessed' : 'unresolved';
      if (other !== cell && kind !== 'hidden') ++seen[kind];
      shape.setAttribute('class', other === cell ? 'asked' : kind);
    });
    map.append(shapes[cell]);  // the last is drawn on top
    return `sees ${grouped(seen.witnessed + seen.unresolved)} of ${plural(count - 1, 'other cell')}: ` +
      `${grouped(seen.witnessed)} proved by rays, ${grouped(seen.unresolved)} not proved hidden`;
  }
  return [askedByNumber(map, count, plan.first, ask), map,
    legend([['witnessed', 'seen: a ray proves it'], ['unresolved', 'not proved hidden'], ['hidden', 'proved hidden'],
      ['asked', 'the cell']]),
    note('Click a cell. Of cells above one another, another click takes the next.')];
}

function visPage() {
  const {run, pictures, plan} = data;
  setHead('Visibility of ' + fileName(run.map), `${grouped(run.leafs)} leaves in ${grouped(run.clusters)} cells, ` +
    `with ${grouped(run.portals)} portals`,
  run.verification && verdict(wrongBy(run.verification) ? 'bad' : 'good',
    `${grouped(run.verification.false_negatives)} of ${grouped(run.verification.segments)} sight lines were missed` +
    (run.verification.brushes ? `, ${grouped(wrongBy(run.verification) - run.verification.false_negatives)} by brushes` : '')));
  const sorted = [...pictures].sort((a, b) => kVisOrder.indexOf(a.name) - kVisOrder.indexOf(b.name));
  at('main').append(
    tiles([percent(run.visible_leaf_pairs, run.leafs ** 2), 'of all pairs of leaves are visible'],
      [percent(run.unresolved_pairs, run.visible_leaf_pairs),
        'of the visible are unresolved; the others are witnessed by rays'],
      [run.cpu_seconds.toFixed(2) + ' s', 'of CPU time']),
    ...[plan && card('plan', 'Ask a cell', askedPlan(plan)), pictures.length > 0 && card('pictures', 'What can be seen from where', h('div', {class: 'pair maps'},
      sorted.map(({name, image, text}) => figure(h('a', {href: name + '.png', title: name + '.png, in full size'},
        picture(image, text)), text, name.startsWith('matrix') ? 'crisp' : '')))), visFacts(run)].filter(Boolean));
}
