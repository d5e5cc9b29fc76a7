// The page of a bake of any scene, from its JSON (schema sightline.bake/1).
// SPDX-License-Identifier: MIT
'use strict';

const kMostGaps = 200;  // rows of the table

function bakeFacts(run) {
  const {walls, view_cells: views} = run;
  return card('how', 'The bake', definitions([
    ['Cells are', run.cells_are],
    walls && ['Walls', `${grouped(walls.planes)} planes with surfaces from ${short(walls.smallest_occluder)} x ` +
      `${short(walls.smallest_occluder)} on, of ${grouped(walls.triangles)} opaque triangles; ${grouped(walls.shut)} of ` +
      `${plural(walls.faces, 'face')} between cells are shut`],
    walls && ['Holes', `narrower than ${short(walls.smallest_hole)} count as shut`],
    views && ['View cells', `${grouped(views.used)} of ${grouped(views.hiders)} flat parts hide something from a cell; ` +
      `portals take ${grouped(views.hidden_by_portals)} more pairs of a cell and an object`],
    views && views.rays && ['Rays', `${grouped(views.rays)} from each view cell have seen ${grouped(views.witnessed_pairs)} of ` +
      `${grouped(views.visible_pairs)} pairs`],
    ['Objects', `${grouped(run.objects.count)}, each in ` +
      `${(run.objects.places / Math.max(1, run.objects.count)).toFixed(2)} cells`],
    ['Size', `${bytes(run.bytes)}, ${bytes(run.resident_bytes)} when opened`],
    ['Time', `${run.wall_seconds.toFixed(2)} s on ${plural(run.threads, 'thread')}`],
    ['Numbers', ['in ', h('code', {}, 'bake.json'), ' beside this page, and each picture as a PNG']]]));
}

/** The plan of the view cells: one that is asked shows the objects that may be seen from it. */
function askedViews(plan, objects) {
  const rows = bytesOf(plan.rows), witnessed = plan.seen && bytesOf(plan.seen);
  const map = svg('svg', {viewBox: `0 0 ${plan.width} ${plan.height}`, class: 'cells views', role: 'img',
    'aria-label': 'Plan of the view cells, and of what may be seen from the asked one'});
  map.append(svg('image', {href: plan.walls, width: plan.width, height: plan.height}));
  plan.cells.forEach(({points, colour}, cell) => map.append(svg('polygon', {points, fill: colour, 'data-cell': cell})));
  // What is as large as a floor would colour all that stands on it.
  const large = ([, , w, h]) => w * h > 5 * plan.width * plan.height;
  const draw = (boxes) => boxes.map(([x, y, w, h]) => `M${x / 10} ${y / 10}h${w / 10}v${h / 10}h${-w / 10}z`).join('');
  const isIn = (bits, cell, i) => bits[cell * plan.row_bytes + (i >> 3)] >> (i & 7) & 1;
  const seen = svg('path', {}), open = svg('path', {class: 'open'}), floors = svg('path', {class: 'floors'}), asked = svg('polygon', {class: 'asked'});
  map.append(floors, open, seen, asked);
  function ask(cell) {
    const held = plan.objects.map((box, i) => ({box, i})).filter(({box, i}) => box && isIn(rows, cell, i));
    const isSeen = ({i}) => !witnessed || isIn(witnessed, cell, i);
    const boxesOf = (list) => draw(list.map(({box}) => box));
    const small = held.filter(({box}) => !large(box));
    seen.setAttribute('d', boxesOf(small.filter(isSeen)));
    open.setAttribute('d', boxesOf(small.filter((one) => !isSeen(one))));
    floors.setAttribute('d', boxesOf(held.filter(({box}) => large(box))));
    asked.setAttribute('points', plan.cells[cell].points);
    const {held: all, witnessed: sure} = plan.cells[cell];
    return `from it ${grouped(all)} of ${plural(objects, 'object')} may be seen` +
      (witnessed ? `: rays have seen ${grouped(sure)}, ${grouped(all - sure)} are unresolved, ` +
        `${grouped(objects - all)} are proved hidden` : '') + `; ${grouped(held.length)} are on this storey`;
  }
  return [askedByNumber(map, plan.cells.length, plan.first, ask), map,
    note('Click a view cell. The boxes are objects that may be seen from somewhere in it' +
      (witnessed ? ': blue where a ray has seen one, orange where that is not known' : '') +
      '; cells are the brighter, the more may be seen.')];
}

function gapTable({gaps, widest_gap: widest}) {
  const place = (point) => point.map(short).join(', ');
  const shown = gaps.slice(0, kMostGaps);
  return card('gaps', `${plural(gaps.length, 'gap')} between walls`,
    note(`Walls that do not quite touch, up to ${short(widest)} apart. Light passes, and so does sight: what lies beyond ` +
      'such a gap is kept where one looks through it. The largest first, by width times length.'),
    gaps.length > 0 && table('Gaps between walls', ['Between', 'Width', 'Length', 'From', 'To'],
      shown.map(({from, to, width, objects}) => [
        [...new Set(objects.map(({key, name}) => name || 'object ' + key))].map((name, i) => [i ? ' and ' : '', named(name, 40)]),
        short(width), short(Math.hypot(...from.map((value, axis) => to[axis] - value))), place(from), place(to)]), 'wide gaps'),
    gaps.length > kMostGaps && note(`and ${grouped(gaps.length - kMostGaps)} smaller ones, in bake.json`));
}

function bakePage() {
  const {run, pictures, plan} = data, {walls, view_cells: views} = run;
  const seen = views && views.count > 0 && views.visible_pairs / views.count;
  setHead('Bake of ' + fileName(run.scene), `${plural(run.cells, 'cell')}, ${run.cells_are}, with ` +
    plural(run.portals, 'portal') + (seen ? `; ${plural(views.count, 'view cell')}` : ''));
  at('main').append(...[
    tiles(seen && [readable(seen), `of ${plural(run.objects.count, 'object')} may be seen from a view cell, in the mean`],
      seen && views.rays && [views.median_looseness.toFixed(2), 'times what rays see is held by a view cell, in the median'],
      walls && [percent(walls.shut, walls.faces), 'of the faces between cells are shut by walls'],
      walls && [grouped(walls.gaps.length), 'gaps between walls that nearly touch']),
    plan && card('plan', 'Ask a view cell', askedViews(plan, run.objects.count)),
    card('pictures', 'From above', h('div', {class: 'pair maps'}, pictures.map(({name, image, text}) =>
      figure(h('a', {href: name + '.png', title: name + '.png, in full size'}, picture(image, text)), text)))),
    walls && gapTable(walls), bakeFacts(run)].filter(Boolean));
}
