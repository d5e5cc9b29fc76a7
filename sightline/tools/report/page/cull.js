// The page of a cull along a path, from the run's JSON (schema sightline.cull/1).
// SPDX-License-Identifier: MIT
'use strict';

const stageColour = (name) => 'stage-' + (data.stage_names.indexOf(name) + 1);
const stageSwatch = (name) => h('i', {class: 'swatch ' + stageColour(name)});
const culledBy = (digit) => digit === 0 ? 'visible' : data.whole ? 'culled by ' +
  data.stage_names[digit - 1] : 'culled';
const overEstimate = ({kept, verification}) =>
  verification && verification.exactly_visible > 0 ? kept / verification.exactly_visible : null;
/** "2.3×", or how it stands to a median of nothing. */
const against = (value, middle) => middle > 0 ? short(value / middle) + '×' : value > 0 ?
  'where the median is 0' : '1×';

/** Where several objects share a key, what is culled and judged is instances of them. */
const countsInstances = ({scene}) => scene.instances > scene.objects;
const unitOf = (run) => countsInstances(run) ? 'instance' : 'object';
const culledOf = (run, stage) => countsInstances(run) ? stage.instances : stage.culled;

function cullVerdict(run) {
  const {verification, frames, scene} = run;
  if (!verification)
    return verdict('', 'Not verified', 'Run it with --verify to let two witnesses judge every cull.');
  const {samples, id_samples: ids, proofs} = verification;
  const wrong = verification.false_instances, culled = verification.culled_instances;
  if (!culled)
    return verdict('', 'Nothing to judge', `No ${unitOf(run)} was culled in ${plural(frames.length, 'frame')}.`);
  const what = frames.length === 1 ? `culled ${unitOf(run)}s`
    : `culls of ${plural(countsInstances(run) ? scene.instances : scene.objects, unitOf(run))} over ` +
      plural(frames.length, 'frame');
  const exactly = proofs && ` ${grouped(proofs.culled_hidden)} are proved to be hidden by exact arithmetic` +
    (proofs.culled_undecided ? `, and of ${grouped(proofs.culled_undecided)} neither is known.` : '.');
  return verdict(wrong ? 'bad' : 'good',
    `${grouped(wrong)} of ${grouped(culled)} ${what} ${wrong === 1 ? 'was' : 'were'} visible`,
    `held against ${grouped(samples)} rays and ${grouped(ids)} id-buffer samples.${exactly || ''}`);
}
const interruption = (run) => run.interrupted && verdict('note', 'The run was interrupted',
  `${run.frames.length} of ${run.frames_wanted > run.frames.length ? grouped(run.frames_wanted) : 'more'} frames ` +
  'were finished; all numbers here are of these.');

function cullTiles({frames, scene, verification}) {
  const kept = mean(frames.map((frame) => frame.kept));
  return tiles(
    [grouped(kept), `objects kept a frame, ${percent(kept, scene.objects)} of the scene`],
    [percent(mean(frames.map((frame) => frame.triangles)), scene.triangles), 'of the scene’s triangles submitted'],
    [grouped(median(frames.map((frame) => frame.query_microseconds))) + ' µs', 'a query, median over the frames'],
    verification && [verification.over_estimate === null ? '–' : verification.over_estimate.toFixed(2) + '×',
      'reported ÷ exactly visible objects']);
}

/** What a renderer is left to draw: everything, by the frustum alone, by all stages; the mean, and the film's frame. */
function leftTable({scene, frames}) {
  const share = (value, whole) => [grouped(value), ' ', h('small', {class: 'soft'}, percent(value, whole)),
    h('div', {class: 'share'}, h('div', {style: `width:${whole ? 100 * value / whole : 0}%`}))];
  const row = (name, objects, triangles) =>
    tableRow([name, share(objects, scene.objects), share(triangles, scene.triangles)]);
  const rows = (of) => [row('everything', scene.objects, scene.triangles),
    frames.every((frame) => frame.frustum_alone) && row('frustum alone, by boxes',
      of((frame) => frame.frustum_alone.objects), of((frame) => frame.frustum_alone.triangles)),
    row('all stages', of((frame) => frame.kept), of((frame) => frame.triangles))].filter(Boolean);
  const group = (name) => h('tr', {class: 'groups'}, h('th', {colspan: 3, scope: 'rowgroup'}, name));
  const made = table('What is left to draw', ['', 'draw calls (objects)', 'triangles'], [], 'left');
  made.querySelector('tbody').append(group('mean over the frames'), ...rows((value) => mean(frames.map(value))));
  made.querySelector('table').append(
    live(h('tbody'), (f) => [group('frame ' + f), rows((value) => value(frames[f]))]));
  return made;
}

/** The whole scene with the path of the camera, and what is left to draw of it. */
function overviewCard(run, {overview}) {
  const left = leftTable(run);
  if (!overview) return card('overview', 'What is left to draw', left);
  const {image, eyes} = overview, mark = h('i', {class: 'eye', hidden: true});
  follow((f) => {
    mark.hidden = !eyes[f];
    if (eyes[f]) [mark.style.left, mark.style.top] = eyes[f].map((part) => 100 * part + '%');
  });
  const whole = picture(image, 'The whole scene from outside, with the path of the camera', {id: 'overview-image'});
  return card('overview', 'The scene, the path, and what is left to draw', h('div', {class: 'stage'},
    figure(h('div', {class: 'over'}, whole, mark), 'The whole scene, and the path of the camera. It begins at the ' +
      'dot, and is paler where it lies behind something.' +
      (eyes.length ? ' The ring is the eye of the frame below.' : '')), left));
}

const kLooks = [['shaded', 'As seen'], ['culled', 'Culled objects drawn through'], ['outside', 'From outside'],
  ['objects', 'One colour an object'],
  ['buffer', 'Occlusion buffer'], ['windows', 'Windows']];
/** The picture, and the switch of what it shows. */
function screen(run, film) {
  const layers = [
    filmImage(film, 'shaded', 'The scene as the camera sees it'),
    filmImage(film, 'objects', 'The same picture, each object in a colour of its own', {hidden: true}),
    filmImage(film, 'culled', 'What was culled within the view, drawn through what hides it', {hidden: true}),
    filmImage(film, 'outside', 'From behind and above the eye: what was drawn is solid, what was culled is wires',
      {hidden: true}),
    filmImage(film, 'buffer', 'What the occlusion buffer claims: light is near, dark is far, blue is open',
      {hidden: true}),
    filmImage(film, 'windows', 'The windows through which cells are seen, over the picture', {hidden: true})];
  const stack = h('div', {class: 'screen', style: `aspect-ratio:${film.width}/${film.height}`}, layers,
    staleMark(film));
  let look = 'shaded';
  const caption = (f) => {
    const shot = shotOf(film, f);
    if (look === 'buffer') return 'What each pixel of the occlusion buffer hides, once all was drawn: what is ' +
      'farther than its grey, from light for the nearest claim to dark for the farthest. Blue hides nothing. The ' +
      `buffer’s longer side has at most ${run.occlusion_size} pixels.`;
    if (look === 'windows') return shot.windows;
    if (look === 'outside') return 'From behind and above the eye, which is the dark dot; the lines are its frustum. ' +
      'What was drawn is solid. What was culled is wires in the colour of its stage. A roof over the eye is cut ' +
      'away, with all that lies above it.';
    if (shot.same === undefined) return '';
    return shot.same ? 'The picture with culling is the same, sample by sample.' : 'The picture with culling differs.';
  };
  const looks = kLooks.filter(([id]) => hasImage(film, id));
  const change = (event) => {
    look = event.target.value;
    for (const layer of layers) if (layer && layer.id !== 'shaded') layer.hidden = layer.id !== look;
    stack.classList.toggle('through', look === 'culled');
    show(player.frame);
  };
  const choice = looks.length > 1 && h('fieldset', {class: 'switch'},
    h('legend', {class: 'unseen'}, 'What the picture shows'),
    looks.map(([id, name]) => h('label', {},
      h('input', {type: 'radio', name: 'look', value: id, checked: id === look, onchange: change}), h('span', {},
        name))));
  return [choice, h('figure', {}, stack, live(h('figcaption', {id: 'look-text'}), caption))];
}

function filmCard(run, film) {
  const facts = live(h('dl', {class: 'facts'}), (f) => {
    const {kept, triangles, query_microseconds: time, verification} = run.frames[f];
    return [['objects kept', grouped(kept) + ' of ' + grouped(run.scene.objects)],
      run.verification && ['exactly visible', verification ? grouped(verification.exactly_visible) : '–'],
      ['triangles submitted', grouped(triangles)], ['query, µs', readable(time)]].filter(Boolean).map(([term, text]) =>
      h('div', {}, h('dt', {}, term), h('dd', {}, text)));
  });
  const bar = controls(run.frames.length, (f) => `frame ${f} (0 to ${run.frames.length - 1})`);
  if (!film.shots.length) return card('film', 'Frame by frame', bar, facts);
  const map = (id, alt) => hasImage(film, id) && figure(filmImage(film, id, alt),
    live(h('span'), (f) => shotOf(film, f)[id]), 'plan');
  const maps = [map('plan', 'The scene from above, objects coloured by what culled them'),
    map('section', 'The scene from the side, objects coloured by what culled them')];
  const plans = maps.some(Boolean) && h('div', {class: 'plans'}, maps, legend([['stage-0', 'visible'],
    ...run.frames[0].stages.map(({name}) => [stageColour(name), 'culled by ' + name]), ['in-view', 'in view']]));
  return card('film', 'Frame by frame', bar,
    h('div', {class: plans ? 'stage' : ''}, h('div', {}, screen(run, film), facts), plans));
}

function depthCard(film) {
  if (!hasImage(film, 'heat-all')) return null;
  const half = (id, key, what, alt) => figure(filmImage(film, id, alt), [what, film.heat_scale > 0 &&
    [': ', live(h('b'), (f) => shotOf(film, f)[key].toFixed(2)), ' a pixel on average']]);
  return card('depth', 'Depth complexity: surfaces drawn for a pixel', h('div', {class: 'pair'},
    half('heat-all', 'depth_all', 'Without culling', 'Heat map of surfaces drawn for each pixel without culling'),
    half('heat-kept', 'depth_kept', 'With culling', 'Heat map of surfaces drawn for each pixel with culling')),
  film.heat_scale > 0 && heatLegend(film.heat_scale));
}

function cullCharts(run) {
  const of = (value) => run.frames.map(value), submitted = mean(of((frame) => frame.triangles));
  const exact = run.verification && {name: 'exactly visible', colour: 'two',
    values: of(({verification}) => verification ? verification.exactly_visible : null)};
  return [card('time', 'What each stage cost, µs a frame',
    plot('time-chart', 'Time of each stage in each frame', 'µs', [
      ...run.frames[0].stages.map(({name}, i) => ({name, colour: stageColour(name), area: true,
        values: of((frame) => frame.stages[i].microseconds)})),
      {name: 'whole query', colour: 'ink', values: of((frame) => frame.query_microseconds)}]),
    note(`One thread, ${run.repeat === 1 ? 'one run' : `median of ${run.repeat} runs`}. The stages are timed in a ` +
      'run of their own.')),
  pair(card('kept', 'Objects kept', plot('kept-chart', 'Objects kept and exactly visible in each frame', 'objects',
    [{name: 'kept', colour: 'one', values: of((frame) => frame.kept)}, exact].filter(Boolean))),
  card('submitted', 'Triangles submitted against triangles in the scene',
    plot('triangle-chart', 'Triangles submitted in each frame', 'triangles',
      [{name: 'submitted', colour: 'one', values: of((frame) => frame.triangles)}]),
    h('div', {class: 'share', role: 'img', 'aria-label': percent(submitted, run.scene.triangles) + ' of the triangles'},
      h('div', {style: `width:${run.scene.triangles ? 100 * submitted / run.scene.triangles : 0}%`})),
    note(`${grouped(submitted)} of ${grouped(run.scene.triangles)} triangles a frame: ` +
      percent(submitted, run.scene.triangles)))),
  exact && card('loose', 'Over-estimate: objects kept for each exactly visible one',
    plot('loose-chart', 'Objects kept for each exactly visible one', 'kept for one that is visible',
      [{name: 'over-estimate', colour: 'two', values: of(overEstimate)}]))];
}

const kMeasures = [['nodes_visited', 'tree nodes visited'], ['occluder_triangles', 'occluder triangles rasterized'],
  ['seam_pixels', 'seam pixels resolved'], ['kept', 'objects kept'], ['triangles', 'triangles submitted']];
/** The slowest and the loosest frame, by what they did against the medians. */
function outliers(run) {
  if (run.frames.length < 2) return null;
  const notes = ({notes: said}) => said && h('ul', {}, said.map((text) => h('li', {}, named(text, 600))));
  const times = run.frames.map((frame) => frame.query_microseconds), slow = largest(times), frame = run.frames[slow];
  const busier = kMeasures.some(([key]) => frame[key] > 1.05 * median(run.frames.map((one) => one[key])));
  const slowest = card('slowest', 'The slowest: frame ' + slow,
    h('p', {}, h('b', {}, readable(times[slow]) + ' µs'), `, ${against(times[slow], median(times))} the median.`,
      !busier && ' Only the clock differs: no count of its work is larger than the median by a twentieth.',
      frame.budget_spent && ' It spent its work budget: some visible occluders were left out.'), notes(frame),
    table('Against the median', ['', 'this frame', 'median', 'ratio'], kMeasures.map(([key, name]) =>
      [name, run.frames.map((one) => one[key]), frame[key]]).filter(([, values]) => values.some((value) => value > 0))
      .map(([name, values, value]) => [name, readable(value), readable(median(values)), against(value,
        median(values))]),
    'counts'), goButton(slow));
  if (!data.loosest) return pair(slowest);
  const {frame: loose, unseen, names} = data.loosest, it = run.frames[loose];
  const doubt = sum(it.stages.map((stage) => stage.doubt));
  return pair(slowest, card('loosest', 'The loosest: frame ' + loose,
    h('p', {}, h('b', {}, `${grouped(it.kept)} kept for ${grouped(it.verification.exactly_visible)} exactly visible`),
      `: ${overEstimate(it).toFixed(2)}×, where the median is ` +
      median(run.frames.map(overEstimate).filter((value) => value !== null)).toFixed(2) + '×. ' +
      plural(doubt, 'object was', 'objects were') + ' kept in doubt.'), loose !== slow && notes(it),
    unseen > 0 && [h('p', {}, `Kept, though no witness saw ${unseen === 1 ? 'it' : 'them'}:`), h('ul', {class: 'names'},
      names.map((name) => h('li', {}, named(name))),
      unseen > names.length && h('li', {}, `and ${grouped(unseen - names.length)} more`))], goButton(loose)));
}

function stagesCard(run) {
  const average = (i, of) => mean(run.frames.map((frame) => of(frame.stages[i], i, frame)));
  const kCounts = [({tested}, i, {stages}) => !countsInstances(run) ? tested
    : whole - sum(stages.slice(0, i).map((stage) => stage.instances)),
  (stage) => culledOf(run, stage), ({doubt}) => doubt];
  const whole = countsInstances(run) ? run.scene.instances : run.scene.objects;
  const keptOf = (frame) => countsInstances(run) ? frame.instances : frame.kept, kept = mean(run.frames.map(keptOf));
  const row = (cells) => {
    const made = tableRow(cells);
    made.children[5].className = 'apart';
    return made;
  };
  const rows = (f) => [...run.frames[f].stages.map((stage, i) => row(
    [[stageSwatch(stage.name), stage.name], ...kCounts.map((count) => grouped(count(stage, i, run.frames[f]))),
      stage.microseconds.toFixed(1), ...kCounts.map((count) => grouped(average(i, count))),
      average(i, ({microseconds}) => microseconds).toFixed(1)])),
  row(['whole query', grouped(whole), grouped(whole - keptOf(run.frames[f])), '',
    run.frames[f].query_microseconds.toFixed(1), grouped(whole), grouped(whole - kept), '',
    mean(run.frames.map((frame) => frame.query_microseconds)).toFixed(1)])];
  const heads = ['tested', 'culled', 'in doubt', 'µs'], made = table('What each stage did', ['stage', ...heads,
    ...heads], []);
  made.querySelector('thead').prepend(h('tr', {class: 'groups'}, h('td'),
    live(h('th', {colspan: 4, scope: 'colgroup'}), (f) => 'frame ' + f),
    h('th', {colspan: 4, scope: 'colgroup', class: 'apart'}, 'mean over the frames')));
  live(made.querySelector('tbody'), rows);
  const off = [...new Set(run.frames.flatMap((frame) => frame.off || []))].map((name) => h('li', {},
    'Switched off: ' + data.off_words[name]));
  return card('stages', 'What each stage did', made, note(`Culled are ${unitOf(run)}s. What is in doubt is kept. All ` +
    'times are means, those of the stages of a run of their own, which the clocks slow down. Facing is timed with ' +
    'occlusion.'), off.length > 0 && h('ul', {}, off));
}

/** A count that several may share. */
const shared = (value) => value < 1000 ? value.toFixed(1) : grouped(value);
const andMore = (all, shown, what) => all > shown && note(`and ${grouped(all - shown)} more ${what}`);
function occluderCards({count, triangles, most, paying, idle, idle_count: idlers, idle_triangles: wasted}) {
  const bar = (hidden) => h('span', {class: 'mini'}, h('i', {style: `width:${100 * hidden / (most[0].hidden || 1)}%`}));
  const worth = (label, rows) => rows.length > 0 && table(label,
    ['occluder', 'triangles rasterized', 'triangles hidden', 'hidden for one'], rows.map((row) =>
      [named(row.name), grouped(row.triangles), grouped(row.hidden_triangles), shared(row.worth)]), 'counts wide');
  return pair(card('hides', 'Who hides most',
    table('Who hides most', ['occluder', 'objects hidden', 'their triangles', 'own triangles', 'frames'],
      most.map((row) => [named(row.name), [bar(row.hidden), shared(row.hidden)], grouped(row.hidden_triangles),
        grouped(row.triangles), row.frames]), 'counts wide'), andMore(count, most.length, 'occluders'),
    note('Sums over the frames. An object that several occluders hide is shared among them.')),
  card('pays', 'Which occluders pay',
    paying.length > 0 && h('p', {}, 'They hide the most triangles for each one that is rasterized:'),
    worth('Which occluders pay best', paying),
    h('p', {}, `${grouped(idlers)} of ${grouped(count)} rasterized occluders hid nothing on this path, with ` +
      `${grouped(wasted)} of the ${grouped(triangles)} triangles rasterized.${idlers ? ' The largest:' : ''}`),
    worth('Which occluders hid nothing', idle)));
}

const insightCards = ({occluders, never, together}, frames) => [occluders && occluderCards(occluders),
  never && pair(never.count > 0 && card('never', 'Never kept on this path',
    h('p', {}, `${grouped(never.count)} of ${grouped(never.of)} objects with ${grouped(never.triangles)} triangles ` +
      `are in none of the ${frames} frames: candidates for removal, as far as the path goes. The largest:`),
    table('Never kept on this path', ['object', 'triangles'],
      never.rows.map((row) => [named(row.name), grouped(row.triangles)]), 'counts wide')),
  together.count > 0 && card('merge', 'Kept together: candidates for one draw',
    table('Kept together', ['group', 'objects', 'triangles', 'frames'], together.rows.map((row) =>
      [[named(row.name), ` and ${grouped(row.objects - 1)} more`], grouped(row.objects), grouped(row.triangles),
        grouped(row.frames)]), 'counts wide'), andMore(together.count, together.rows.length, 'groups'),
    note('Small objects beside one another that appear and disappear in the same frames.')))];

/** The objects of the scene, found by name, path or key. */
function objectsCard({rows, stages, left_out: left}, frames) {
  if (!rows.length) return null;
  const made = at('objects-template').content.cloneNode(true), find = (id) => made.querySelector('#' + id);
  const search = find('search'), only = find('only-kept'), more = find('more'), body = find('rows');
  const found = find('found'), frameText = find('table-frame'), order = rows.map((row, i) => i), buttons = all('.sort',
    made);
  if (!rows.some((row) => row[2] !== row[1])) made.querySelector('.objects').classList.add('no-paths');
  if (!rows.some((row) => row[3] > 0)) made.querySelector('.objects').classList.add('no-triangles');
  let shown = 20, sorted = null, rising = false;
  const line = ([key, name, path, triangles, kept], digit) => h('tr', {}, h('td', {}, named(name || 'object ' + key)),
    h('td', {class: 'path'}, path === name ? '' : named(path)), h('td', {}, key),
    h('td', {class: 'count'}, grouped(triangles)), h('td', {}, `${kept} of ${frames}`),
    h('td', {}, h('i', {class: 'swatch stage-' + digit}), culledBy(digit)));
  const fill = () => {
    const wanted = search.value.trim().toLowerCase(), digits = stages[player.frame] || '';
    const fits = (i) => (!only.checked || digits[i] === '0') && (!wanted || String(rows[i][0]) === wanted ||
      rows[i][1].toLowerCase().includes(wanted) || rows[i][2].toLowerCase().includes(wanted));
    const list = order.filter(fits);
    found.textContent = grouped(list.length) + ' found';
    frameText.textContent = player.frame;
    more.hidden = list.length <= shown;
    body.replaceChildren(...list.slice(0, shown).map((i) => line(rows[i], parseInt(digits[i], 36))));
  };
  const sort = (button) => {
    const by = +button.dataset.by;
    rising = sorted === by && !rising;
    sorted = by;
    order.sort((a, b) => (rows[a][by] - rows[b][by]) * (rising ? 1 : -1) || a - b);
    for (const other of buttons)
      other.closest('th').setAttribute('aria-sort', other === button ? (rising ? 'ascending' : 'descending') : 'none');
    fill();
  };
  for (const button of buttons) button.addEventListener('click', () => sort(button));
  search.addEventListener('input', () => { shown = 20; fill(); });
  only.addEventListener('change', fill);
  more.addEventListener('click', () => { shown += 200; fill(); });
  follow(fill);
  return card('objects', 'Objects', left > 0 && note(`${grouped(rows.length)} of ${grouped(rows.length + left)} ` +
    'objects: those kept in most frames, and the largest of the others.'), made);
}

function proofCard(run, film) {
  const sums = run.verification, sides = run.frames.filter((frame) => frame.verification)
    .map((frame) => frame.verification.supersampling);
  const least = Math.min(...sides), most = Math.max(...sides), square = (n) => `${n}×${n}`;
  return card('how', 'How it was verified', definitions([
    ...(sums ? [
      ['First witness', `${grouped(sums.samples)} rays, ${grouped(sums.aimed_samples)} of them aimed at what was ` +
        'culled, the others spread over the frames. Single-sided back faces are passed through; masked and blended ' +
        'surfaces are seen and passed.'],
      ['Second witness', `an id-buffer of ${grouped(sums.id_samples)} samples, ` +
        `${least === most ? square(most) : `${square(least)} to ${square(most)}`} a pixel, drawn by a plain z-buffer ` +
        'that shares no code with the culling.'],
      ...(sums.proofs ? [['Third witness', 'exact proofs: the shadows of triangles are taken from each object until ' +
        `nothing is left of it, or a place where nothing hides it. ${grouped(sums.proofs.culled_hidden)} times a culled ` +
        `object was proved to be hidden, ${grouped(sums.proofs.kept_hidden)} times one that was kept.` +
        (sums.proofs.culled_undecided + sums.proofs.kept_undecided ?
          ` Undecided: ${grouped(sums.proofs.culled_undecided)} culled, ${grouped(sums.proofs.kept_undecided)} kept.`
          : '')]] : []),
      ['Judged', `${grouped(sums.culled)} times an object was culled in a frame; ${grouped(sums.false_culls)} of ` +
        `them were seen by a witness. ${grouped(sums.unconfirmed)} sightings did not hold in exact arithmetic: edges ` +
        'that graze, and surfaces that float cannot tell apart.'],
      ['Over-estimate', `${grouped(sums.reported)} objects reported, ${grouped(sums.exactly_visible)} seen by a ` +
        `witness: ${sums.over_estimate === null ? '–' : sums.over_estimate.toFixed(3)}.`]]
      : [['Verified', ['no; ', h('code', {}, '--verify'), ' was not given']]]),
    ['Image shift', `the answers hold for any shift of the image by up to ${run.jitter} pixels`], repeatRow(),
    film.shots.length > 0 && ['Pictures', film.shots.length === run.frames.length ? 'every frame'
      : `${film.shots.length} of ${run.frames.length} frames: ${film.shots.map((shot) => shot.frame).join(', ')}`],
    ['Numbers', ['in ', h('code', {}, 'cull.json'), ' beside this page; a timeline for Perfetto in ',
      h('code', {}, 'trace.json')]]]));
}

/** The links at the top: to the sections that the page has. */
const kSections = [['overview', 'Overview'], ['film', 'Film'], ['depth', 'Depth complexity'], ['time', 'Cost'],
  ['kept', 'Objects kept'], ['slowest', 'Outliers'], ['stages', 'Stages'], ['hides', 'Occluders'],
  ['never', 'Never kept'], ['merge', 'Merging'], ['objects', 'Objects'], ['how', 'Proof']];
const contents = () => h('nav', {'aria-label': 'Sections'}, kSections.filter(([id]) => at(id)).map(([id, name]) =>
  h('a', {href: '#' + id}, name)));

function cullPage() {
  const {run, film} = data, {frames, scene} = run;
  setHead(fileName(scene.file), `${grouped(scene.objects)} objects, ${grouped(scene.triangles)} triangles; ` +
    `${plural(frames.length, 'frame')} of ${run.width} × ${run.height}`, cullVerdict(run), interruption(run));
  const body = frames.length ? [overviewCard(run, film), filmCard(run, film), cullTiles(run), depthCard(film),
    cullCharts(run), outliers(run), stagesCard(run), insightCards(data, frames.length),
    objectsCard(data.table, frames.length)] : [];
  at('main').append(...[body, proofCard(run, film)].flat(9).filter(Boolean));
  at('head').append(contents());
  return frames.length ? frameWorthALook(frames, film) : null;
}
