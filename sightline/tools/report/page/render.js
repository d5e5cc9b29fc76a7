// The page of hidden-surface methods beside one another, from the run's JSON (schema sightline.render/1).
// SPDX-License-Identifier: MIT
'use strict';

/** What a reader should know of a method before its numbers. */
const kAbout = {
  painter: 'Far to near by one depth a polygon. Wrong wherever that is not enough.',
  newell: 'Far to near in an order that is proved pair by pair; what has no order is cut.',
  'bsp-back-to-front': 'Far to near in the order of a BSP tree, each over what is there.',
  'bsp-front-to-back': 'Near to far in the same order, each sample written once.',
  warnock: 'The screen is quartered until each window is simple.',
  zbuffer: 'A depth at each sample.',
  raycast: 'A ray through each sample, through a tree of boxes.'};

const agrees = ({agreement}) => agreement.wrong === 0;
function agreementText({agreement: {differing, samples, at_edges: edges, ties, wrong}}) {
  if (differing === 0) return 'the same surface at every sample';
  return [`differs at ${grouped(differing)} samples (${percent(differing, samples)}): ${grouped(edges)} at edges, ` +
    `${grouped(ties)} ties, `, h('b', {}, grouped(wrong) + ' wrong')];
}

function renderVerdict(methods) {
  const exact = methods.filter((method) => method.exact), wrong = sum(exact.map((method) => method.agreement.wrong));
  const excused = methods.find((method) => method.why);
  const apart = excused && `${grouped(excused.agreement.wrong)} samples of ${excused.name} show a surface that is ` +
    `not the nearest: ${excused.why}`;
  if (!exact.length) return apart && verdict('', apart);
  const what = wrong > 0 ? grouped(wrong) + ' samples of exact methods show a surface that is not the nearest'
    : exact.length === 1 ? 'The method agrees' : `All ${exact.length} exact methods agree`;
  return verdict(wrong > 0 ? 'bad' : 'good', what, (apart ? apart + ', so that it is not counted among the exact ' +
    'methods; ' : '') + 'compared with a plain z-buffer in double, sample by sample; differences on edges and ' +
    'between surfaces at one depth are counted apart');
}

function renderTiles(run, methods) {
  const exact = methods.filter((method) => method.exact), painter = methods.find(({name}) => name === 'painter');
  const fastest = exact[largest(exact.map((method) => -method.milliseconds))];
  return tiles(
    [grouped(run.scene.polygons_in_view), 'polygons to draw, of ' +
      `${grouped(run.scene.triangles_in_view)} triangles in view`],
    fastest && [readable(fastest.milliseconds) + ' ms', `${fastest.name}, the fastest exact method here` +
      (fastest.prepare_milliseconds > 0 ? `, after ${readable(fastest.prepare_milliseconds)} ms of preparation` : '')],
    painter && painter.per_sample && [painter.per_sample.generated.mean.toFixed(2),
      'fragments a pixel: the depth complexity'],
    painter && [grouped(painter.agreement.wrong), 'samples that the painter’s algorithm gets wrong']);
}

/** Why heat maps and the timed runs' counters disagree. */
function countingNote(methods) {
  const zbuffer = methods.find(({name}) => name === 'zbuffer');
  if (!zbuffer || !zbuffer.counting_run || zbuffer.counting_run.generated === zbuffer.counters.generated) return '';
  return ' There the z-buffer looks at the fragments that its hierarchy rejects unseen, and counts them as ' +
    'generated; in the runs that were timed it never sees them. It also accepts partly covered tiles there, so that ' +
    'fewer fragments are tested one by one.';
}

function gallery(run, methods) {
  let drawn = '';
  const figures = methods.map((method) => {
    drawn = method.picture || drawn;
    const {name, prepare_milliseconds: before} = method, image = picture(drawn, 'The scene drawn by ' + name);
    return h('figure', {}, h('h3', {}, name, ' ', h('span', {class: 'tag ' + (agrees(method) ? 'good' : 'bad')},
      agrees(method) ? 'agrees' : grouped(method.agreement.wrong) + ' wrong')),
    data.linked ? h('a', {href: name + '.png', title: name + '.png, in full size'}, image) : image,
    method.heat && h('div', {class: 'heat'}, picture(method.heat, 'Heat map of ' + name)),
    h('figcaption', {}, kAbout[name], ' ', h('b', {}, readable(method.milliseconds) + ' ms'),
      before > 0 && ` after ${readable(before)} ms of preparation`, '; ', agreementText(method), '.'));
  });
  return card('images', 'The image by each method', h('div', {class: 'gallery'}, figures),
    methods.some((method) => method.heat) && [note(`Below each image, fragments ${run.settings.heat} at each pixel, ` +
      `of a counting run.${countingNote(methods)}`), heatLegend(data.scale)],
    run.left_out.map(({name, why}) => h('p', {}, h('b', {}, name), ` was left out: ${why}.`)));
}

const differenceCard = (methods) => methods.some((method) => method.wrong) && card('wrong', 'Where an image is wrong',
  h('div', {class: 'gallery'}, methods.filter((method) => method.wrong).map((method) => h('figure', {},
    h('h3', {}, method.name), picture(method.wrong, 'Wrong pixels of ' + method.name),
    h('figcaption', {}, agreementText(method))))), note('Red: another surface than the nearest.'));

/** Times, agreement and counters, a column a method. What all methods count alike is said in a sentence. */
function costCard(methods) {
  const rows = [], commons = [];
  const row = (title, of) => rows.push([title, ...methods.map(of)]);
  const counts = (title, of) => methods.some((method) => of(method) > 0) &&
    row(title, (method) => of(method) > 0 ? grouped(of(method)) : '–');
  row('ms a frame', (method) => readable(method.milliseconds));
  row('ms of preparation', (method) => readable(method.prepare_milliseconds));
  for (const [title, key] of [['samples differing', 'differing'], ['… at edges', 'at_edges'], ['… ties', 'ties'],
    ['… wrong', 'wrong']]) row(title, (method) => grouped(method.agreement[key]));
  for (const [key, title] of Object.entries(data.titles)) {
    const of = (method) => method.counters[key], counted = (method) => (method.counting_run || {})[key] || 0;
    const values = methods.map(of).filter((value) => value > 0), heat = methods.some((method) => counted(method) > 0);
    if (!heat && values.length > 1 && new Set(values).size === 1) commons.push(`${grouped(values[0])} ${title}`);
    else counts(title, of);
    if (heat && methods.some((method) => counted(method) > 0 && counted(method) !== of(method)))
      counts('… in the counting run', counted);
  }
  const names = ['a frame', 'preparation that can be kept: building a tree'];
  const prepared = methods.some((method) => method.prepare_milliseconds > 0);
  return card('cost', 'What each method cost',
    logBars('Times of the methods', names, methods.map((m) => [m.name, m.milliseconds, m.prepare_milliseconds])),
    legend([['one', names[0]], prepared && ['two', names[1]]].filter(Boolean)),
    note('Each step of the scale is ten times the one before.'),
    table('Times and counters', ['', ...methods.map(({name}) => name)], rows, 'counts methods'),
    commons.length > 0 && h('p', {}, `The same for all methods that count it: ${commons.join(', ')}.`),
    note('Times and counters are of the runs that were timed; bytes of depth, heat maps and the rows that say so, of ' +
      `a counting run.${countingNote(methods)}`));
}

function depthCards({depth, hierarchy}, methods) {
  const find = (wanted) => methods.find(({name}) => name === wanted), zbuffer = find('zbuffer');
  const {mean: average, maximum, histogram: counts} = depth ? find(depth.method).per_sample.generated : {};
  const half = (key, text) => figure(picture(hierarchy[key], 'Heat map of fragments ' + key),
    [text + ': ', h('b', {}, zbuffer.per_sample[key].mean.toFixed(2)), ' a pixel']);
  return [depth && card('depth', 'Depth complexity', h('div', {class: 'pair'},
    figure(picture(depth.heat, 'Heat map of depth complexity'),
      [`Fragments generated for each pixel by ${depth.method}, in the counting run: `, h('b', {}, average.toFixed(2)),
        ' on average, ', h('b', {}, maximum), ' at most']),
    figure(histogram('Pixels by their number of fragments', counts), 'Pixels by their number of fragments')),
  heatLegend(depth.scale)),
  hierarchy && card('hierarchy', 'What the z-buffer’s hierarchy spared', h('div', {class: 'pair'},
    half('generated', 'Generated, those included that the hierarchy rejects unseen'),
    half('tested', 'Tested one by one against a depth')), heatLegend(hierarchy.scale),
  note('Both of the counting run. What is missing on the right was rejected or accepted by whole polygons and tiles.')),
  zbuffer && zbuffer.counters.depth_bytes > 0 && trafficCard(zbuffer.counters)];
}
function trafficCard({depth_bytes: plain, depth_bytes_compressed: compressed}) {
  const bar = (name, count) => [h('span', {}, name), h('div', {class: 'share'}, h('div', {style:
    `width:${100 * count / Math.max(plain, compressed)}%`})), h('span', {}, readable(Math.round(count / 1000)) +
    ' kB')];
  return card('bytes', 'Depth read and written by the z-buffer',
    h('div', {class: 'costs'}, bar('plain', plain), bar('compressed', compressed)),
    h('p', {}, 'Compressed tile by tile, without loss: ', h('b', {}, (plain / (compressed || plain)).toFixed(2)),
      ' : 1.'));
}

/** Where the z-buffer's format cannot tell surfaces apart, and what other formats would make of the frame. */
function fightsCard({settings: {depth_format: own}, z_fighting: formats}) {
  if (!data.fights) return null;
  const mine = formats.find(({format}) => format === own);
  return card('fights', 'Z-fighting', h('div', {class: 'pair'},
    figure(picture(data.fights, 'Map of z-fighting'), [
      `Red: the two nearest surfaces lie apart, but have the same depth in ${own} (`, h('b', {},
      grouped(mine.fighting)),
      ' pixels). Blue: they lie at the same place, which no format tells apart (', h('b', {}, grouped(mine.coplanar)),
      ').']),
    table('Formats of depth', ['format', 'pixels fighting', `of ${grouped(mine.overlaid)} with two surfaces`],
      formats.map(({format, fighting, overlaid}) => [[format, format === own &&
        [' ', h('span', {class: 'tag'}, 'this run')]], grouped(fighting), percent(fighting, overlaid)]), 'counts')));
}

function madeCard({camera, frame, settings}) {
  const place = (v) => `(${v.map((value) => +value.toPrecision(6)).join(', ')})`;
  return card('how', 'How it was made', definitions([
    ['Camera', `frame ${frame} (0 to ${data.frames - 1}): from ${place(camera.eye)} to ${place(camera.target)}`],
    ['Samples', 'one a pixel, at its centre'],
    ['Surfaces', 'single-sided back faces are dropped; masked surfaces are drawn whole; blended and transmissive ' +
      'ones are not drawn'],
    ['Times', `${settings.repeat === 1 ? 'one run' : `median of ${settings.repeat} runs`}, on ` +
      `${settings.threads === 1 ? 'one thread' : `up to ${settings.threads} threads`}; heat maps and depth bytes are ` +
      'of a counting run of its own'],
    ['Reference', 'a plain z-buffer in double, one thread'], repeatRow(),
    ['Numbers', ['in ', h('code', {}, 'render.json'), ' beside this page']]]));
}

function renderPage() {
  const {run} = data, methods = run.methods.map((method, i) => ({...method, ...data.methods[i]}));
  setHead(fileName(run.scene.file), `${grouped(run.scene.objects)} objects, ${grouped(run.scene.triangles)} ` +
    `triangles; ${run.width} × ${run.height}, hidden surfaces removed by ${plural(methods.length, 'method')}`,
    renderVerdict(methods));
  at('main').append(...[renderTiles(run, methods), gallery(run, methods), differenceCard(methods), costCard(methods),
    depthCards(data, methods), fightsCard(run), madeCard(run)].flat(9).filter(Boolean));
}
