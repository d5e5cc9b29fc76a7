// The page of a bake of visibility, from its JSON (schema sightline.vis/1).
// SPDX-License-Identifier: MIT
'use strict';

const kVisOrder = ['most', 'sightline', 'graph', 'middle', 'matrix', 'matrix-alike'];

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
    leaks.length > 0 && ['Leaks', `from ${leaks[0].from}: the map is not sealed`],
    run.pvs_bytes > 0 && ['Size', `${bytes(run.pvs_bytes)} packed, ${bytes(run.resident_bytes)} when opened` +
      (run.lump_bytes > 0 ? `, ${bytes(run.lump_bytes)} as a lump` : '')],
    ['Work', `${grouped(run.steps)} portals clipped` + (run.over_budget ? `; ${grouped(run.over_budget)} portals and ` +
      'directions ended by the budget' : '') + (run.stopped ? '; stopped by a limit in seconds' : '')],
    ['Time', `${run.wall_seconds.toFixed(2)} s on ${plural(run.threads, 'thread')}`],
    ['Numbers', ['in ', h('code', {}, 'vis.json'), ' beside this page, and each picture as a PNG']]]));
}

function visPage() {
  const {run, pictures} = data;
  setHead('Visibility of ' + fileName(run.map), `${grouped(run.leafs)} leaves in ${grouped(run.clusters)} cells, ` +
    `with ${grouped(run.portals)} portals`,
  run.verification && verdict(run.verification.false_negatives ? 'bad' : 'good',
    `${grouped(run.verification.false_negatives)} of ${grouped(run.verification.segments)} sight lines were missed`));
  const sorted = [...pictures].sort((a, b) => kVisOrder.indexOf(a.name) - kVisOrder.indexOf(b.name));
  at('main').append(
    tiles([percent(run.visible_leaf_pairs, run.leafs ** 2), 'of all pairs of leaves are visible'],
      [percent(run.unresolved_pairs, run.visible_leaf_pairs),
        'of the visible are unresolved; the others are witnessed by rays'],
      [run.cpu_seconds.toFixed(2) + ' s', 'of CPU time']),
    ...[pictures.length > 0 && card('pictures', 'What can be seen from where', h('div', {class: 'pair maps'},
      sorted.map(({name, image, text}) => figure(h('a', {href: name + '.png', title: name + '.png, in full size'},
        picture(image, text)), text, name.startsWith('matrix') ? 'crisp' : '')))), visFacts(run)].filter(Boolean));
}
