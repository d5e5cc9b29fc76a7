// The player: one frame of a run is shown at a time, and what follows it is told.
// SPDX-License-Identifier: MIT
'use strict';

const player = {frames: 0, frame: 0, timer: 0, followers: []};

/** Calls a function with each frame that is shown. */
const follow = (follower) => player.followers.push(follower);
/** An element whose children are made again for each frame. */
function live(element, render) {
  follow((frame) => element.replaceChildren(...[render(frame)].flat(9).filter((child) => child || child === 0)));
  return element;
}
function show(frame) {
  player.frame = Math.min(Math.max(frame, 0), player.frames - 1);
  for (const follower of player.followers) follower(player.frame);
}
function stop() {
  clearInterval(player.timer);
  player.timer = 0;
  at('play').textContent = 'Play';
  at('play').setAttribute('aria-pressed', 'false');
}
function goTo(frame) {
  stop();
  show(frame);
}
function play() {
  if (player.timer) return stop();
  const slow = matchMedia('(prefers-reduced-motion: reduce)').matches;
  at('play').textContent = 'Pause';
  at('play').setAttribute('aria-pressed', 'true');
  player.timer = setInterval(() => show((player.frame + 1) % player.frames), slow ? 2000 : 700);
}
const goButton = (frame) => h('button', {type: 'button', class: 'go', onclick: () => {
  goTo(frame);
  at('film').scrollIntoView({block: 'start'});
}}, 'Show frame ' + frame);

/** @param label  what is said of a frame beside the slider */
function controls(frames, label) {
  player.frames = frames;
  const made = at('player-template').content.cloneNode(true), find = (id) => made.querySelector('#' + id);
  const slider = find('frame'), text = find('at');
  slider.max = frames - 1;
  slider.addEventListener('input', () => goTo(+slider.value));
  find('play').addEventListener('click', play);
  find('back').addEventListener('click', () => goTo(player.frame - 1));
  find('forth').addEventListener('click', () => goTo(player.frame + 1));
  follow((frame) => {
    slider.value = frame;
    slider.setAttribute('aria-valuetext', 'frame ' + frame);
    text.textContent = label(frame);
  });
  return made;
}
document.addEventListener('keydown', (event) => {
  const moves = {ArrowLeft: -1, ArrowRight: 1}, to = event.target;
  if (!(event.key in moves) || event.ctrlKey || event.altKey || event.metaKey || !player.frames) return;
  if (to.tagName === 'INPUT' || to.classList.contains('scroll')) return;
  event.preventDefault();
  goTo(player.frame + moves[event.key]);
});
function followHash() {
  const wanted = /^#frame-(\d+)$/.exec(location.hash);
  if (wanted && player.frames) goTo(+wanted[1]);
}
addEventListener('hashchange', followHash);

/** The picture of a frame, or of the one nearest to it that has one. */
const shotOf = (film, frame) => film.shots.reduce((best, shot) =>
  !best || Math.abs(shot.frame - frame) < Math.abs(best.frame - frame) ? shot : best, null);
const hasImage = (film, id) => film.shots.some((shot) => id in shot.images);
/** An image of the film that follows it; null if the film has none. */
function filmImage(film, id, alt, attributes = {}, frameOf = (f) => f) {
  if (!hasImage(film, id)) return null;
  const image = h('img', {id, alt, ...attributes});
  follow((frame) => {
    const uri = shotOf(film, frameOf(frame)).images[id];
    if (uri && image.src !== uri) image.src = uri;
  });
  return image;
}
/** Says where the picture is of another frame. */
const staleMark = (film, frameOf = (f) => f) => live(h('span', {class: 'stale'}), (f) => {
  const {frame} = shotOf(film, frameOf(f));
  return frame === frameOf(f) ? '' : 'picture of frame ' + frame;
});

/**
 * The frame to open at: one with a false cull, or else the one that shows most, which is a picture that many objects
 * share, of a view with many in it.
 */
function frameWorthALook(frames, film) {
  const wrong = frames.findIndex((frame) => frame.verification && frame.verification.false_culls > 0);
  if (wrong >= 0) return wrong;
  const worth = (f) => Math.log2(2 + (frames[f].verification ?
    frames[f].verification.exactly_visible : frames[f].kept));
  if (!film.shots.length) return largest(frames.map((_, f) => worth(f)));
  const shots = film.shots.filter((shot) => shot.frame < frames.length);
  return shots[largest(shots.map((shot) => (shot.variety || 1) * worth(shot.frame)))].frame;
}
