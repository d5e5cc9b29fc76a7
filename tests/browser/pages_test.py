# Opens the pages that the tool writes in a real browser, and looks at them as a reader would.
# SPDX-License-Identifier: MIT
#
# pages_test.py TOOL [TEST ...]; exit code 77 where there is no Chromium. SIGHTLINE_SHOTS=DIR keeps screenshots.
import base64
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, find_chromium  # noqa: E402

TOOL = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else ""
TAB = ("Tab", "Tab", 9)
PAGES = ("a", "b", "single", "both", "again", "drawn", "coarse", "map", "baked")
# A corridor with two rooms on one side, and one on the other, as a file of portals.
ROOMS = """PRT1
4
3
4 0 1 (64 16 0) (64 16 16) (64 0 16) (64 0 0)
4 1 2 (64 112 0) (64 112 16) (64 128 16) (64 128 0)
4 1 3 (72 64 0) (72 64 16) (72 48 16) (72 48 0)
"""

# Every text that is shown, its colour, and the first opaque colour behind it. Texts over pictures are passed over.
CONTRASTS = """(() => {
  const parse = (text) => (text.match(/[\\d.]+/g) || []).map(Number);
  const light = (c) => { const f = (v) => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
    return 0.2126 * f(c[0]) + 0.7152 * f(c[1]) + 0.0722 * f(c[2]); };
  const poor = []; let count = 0;
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode()) {
    const at = node.parentElement, style = getComputedStyle(at);
    if (!node.textContent.trim() || at.closest('script, style, noscript, .unseen, .screen, .over') ||
        !at.getClientRects().length || style.visibility === 'hidden') continue;
    let back = null;
    for (let up = at; up && !back; up = up.parentElement) {
      const c = parse(getComputedStyle(up).backgroundColor);
      if (c.length === 3 || c[3] === 1) back = c;
    }
    back = back || [255, 255, 255];
    const a = light(parse(style.color)), b = light(back);
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), size = parseFloat(style.fontSize);
    ++count;
    if (ratio < (size >= 24 || (size >= 18.66 && +style.fontWeight >= 700) ? 3 : 4.5))
      poor.push(node.textContent.trim().slice(0, 40) + ': ' + ratio.toFixed(2));
  }
  return {count, poor};
})()"""

# Pictures without pixels, charts without ink.
UNDRAWN = """(() => {
  const bad = [];
  const images = [...document.images].filter((image) => !image.hidden);
  for (const image of document.images)
    if (!image.complete || image.naturalWidth === 0) bad.push('image ' + (image.id || image.alt));
  const drawings = [...document.querySelectorAll('canvas')];
  for (const canvas of drawings) {
    const blank = document.createElement('canvas');
    [blank.width, blank.height] = [canvas.width, canvas.height];
    if (canvas.toDataURL() === blank.toDataURL()) bad.push('canvas ' + canvas.getAttribute('aria-label'));
    if (canvas.getBoundingClientRect().height < 20) bad.push('flat canvas');
  }
  return {bad, images: images.length, drawings: drawings.length};
})()"""

WIDE = """(() => {
  const wide = [];
  for (const at of document.querySelectorAll('body *'))
    if (at.getBoundingClientRect().right > innerWidth + 1 && !at.closest('.scroll, .unseen'))
      wide.push(at.tagName + '.' + at.className + '#' + at.id);
  return {wide: wide.slice(0, 8), page: document.documentElement.scrollWidth, window: innerWidth};
})()"""

# Cells of tables whose text reaches over their border, into the next column.
COLLIDING = """(() => {
  const bad = [];
  for (const cell of document.querySelectorAll('th, td')) {
    if (!cell.getClientRects().length || !cell.textContent.trim()) continue;
    const range = document.createRange();
    range.selectNodeContents(cell);
    const text = range.getBoundingClientRect(), box = cell.getBoundingClientRect();
    if (text.right > box.right + 1 || text.left < box.left - 1) bad.push(cell.textContent.trim().slice(0, 40));
    if (box.height > 240) bad.push('tall: ' + cell.textContent.trim().slice(0, 40));
  }
  return bad;
})()"""

# A name as nobody means well with it: what ends lines, commands terminals or turns the direction of writing.
UNFIT = "".join(map(chr, [0, 7, 0x1b, 0x9b, 0x200e, 0x200f, 0x202a, 0x202b, 0x202c, 0x202d, 0x202e, 0x2066, 0x2067, 0x2068,
                          0x2069]))
HOSTILE = "first" + UNFIT + "<img src=x onerror=alert(1)>" + "n" * 100000 + "last"
UNFIT_SHOWN = """(() => {
  const unfit = /[\\u0000-\\u0008\\u000e-\\u001f\\u007f-\\u009f\\u200e\\u200f\\u202a-\\u202e\\u2066-\\u2069]/;
  const bad = [];
  for (const at of document.querySelectorAll('body *:not(script):not(style)')) {
    for (const node of at.childNodes) if (node.nodeType === 3 && unfit.test(node.data)) bad.push(at.tagName);
    for (const {name, value} of at.attributes) if (unfit.test(value)) bad.push(at.tagName + ' ' + name);
  }
  if (unfit.test(document.title)) bad.push('title');
  return bad;
})()"""

CONTROLS = """[...document.querySelectorAll('a[href], button, input, [tabindex="0"]')].filter((at) =>
  at.getClientRects().length && !at.disabled && !(at.type === 'radio' && !at.checked)).length"""

FOCUSED = """(() => {
  const at = document.activeElement;
  if (!at || at === document.body) return null;
  const shown = at.type === 'radio' ? at.nextElementSibling : at, style = getComputedStyle(shown);
  return {name: at.id || at.className || at.textContent.trim().slice(0, 20) || at.tagName,
          order: [...document.querySelectorAll('*')].indexOf(at),
          ring: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2,
          label: !!(at.getAttribute('aria-label') || at.textContent.trim() || at.querySelector('img[alt]') ||
            (at.labels && at.labels.length))};
})()"""


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.mkdtemp(prefix="sightline-browser-")
        cls.addClassCleanup(shutil.rmtree, cls.directory, ignore_errors=True)
        cls.browser = Browser(find_chromium(), os.path.join(cls.directory, "profile"))
        cls.addClassCleanup(cls.browser.close)
        common = ["--frames", "5", "--size", "320x180", "--repeat", "1"]
        cls.run_tool("cull", "city:1:400", *common, "--verify", "--rays", "20000", "--report", "a")
        cls.run_tool("cull", "city:1:400", *common, "--skip", "occlusion", "--report", "b")
        cls.run_tool("cull", "city:1:400", "--frames", "1", "--size", "90x160", "--repeat", "1", "--report", "single")
        cls.run_tool("report", "--compare", "a", "b", "-o", "both")
        cls.run_tool("report", "a", "-o", "again")
        cls.run_tool("render", "made:cycle", "--size", "160x90", "--method", "all", "--report", "drawn")
        cls.run_tool("render", "city:1:2000", "--frames", "6", "--frame", "4", "--size", "320x180", "--method", "all",
                     "--depth-format", "unorm16", "--report", "coarse")
        with open(os.path.join(cls.directory, "rooms.prt"), "w", encoding="utf-8") as file:
            file.write(ROOMS)
        cls.run_tool("vis", "rooms.prt", "--report", "map")
        cls.run_tool("bake", "building:1:1", "--cells", "walls", "--view-cells", "256", "--rays", "2000",
                     "--report", "baked")

    @classmethod
    def run_tool(cls, *words):
        done = subprocess.run([TOOL, *words], cwd=cls.directory, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            raise RuntimeError(" ".join(words) + ": " + done.stderr)

    def open(self, name, width=1280, height=900, at="", **features):
        self.browser.size(width, height)
        self.browser.emulate(prefers_color_scheme="light", **features)
        self.browser.open("/")  # a page that differs in its hash alone would not be loaded again
        self.browser.open(os.path.join(self.directory, name, "index.html") + at)
        self.browser.evaluate("Promise.all([...document.images].map((image) => image.decode().catch(() => 0)))"
                              ".then(() => 1)")

    def shot(self, name):
        folder = os.environ.get("SIGHTLINE_SHOTS")
        if not folder:
            return
        width, height = self.browser.evaluate("[innerWidth, document.documentElement.scrollHeight]")
        self.browser.size(width, height)  # charts beyond the window are not drawn into the picture
        self.browser.evaluate("new Promise((done) => setTimeout(() => done(1), 100))")
        picture = self.browser.call("Page.captureScreenshot", captureBeyondViewport=True, clip={
            "x": 0, "y": 0, "width": width, "height": height, "scale": 1})
        with open(os.path.join(folder, name + ".png"), "wb") as file:
            file.write(base64.b64decode(picture["data"]))

    def test_opens_without_a_complaint_or_a_request(self):
        for name in PAGES:
            with self.subTest(page=name):
                self.open(name)
                self.browser.evaluate("new Promise((done) => setTimeout(() => done(1), 50))")
                self.assertEqual(self.browser.complaints(), [])

    def test_draws_every_picture_and_chart(self):
        least = {"a": (5, 4), "b": (5, 3), "single": (5, 3), "both": (6, 4), "again": (5, 4), "drawn": (8, 2),
                 "coarse": (8, 2), "map": (6, 0), "baked": (3, 0)}
        for name in PAGES:
            with self.subTest(page=name):
                self.open(name)
                found = self.browser.evaluate(UNDRAWN)
                self.assertEqual(found["bad"], [])
                self.assertGreaterEqual(found["images"], least[name][0])
                self.assertGreaterEqual(found["drawings"], least[name][1])
                self.shot(name)

    def test_tab_reaches_every_control_in_order_and_shows_where_it_is(self):
        for name in PAGES:
            with self.subTest(page=name):
                self.open(name)
                wanted, reached, last = self.browser.evaluate(CONTROLS), [], -1
                for _ in range(wanted + 5):
                    self.browser.press(*TAB)
                    here = self.browser.evaluate(FOCUSED)
                    if here is None or here["order"] <= last:
                        break
                    self.assertTrue(here["ring"], here["name"] + " shows no focus")
                    self.assertTrue(here["label"], here["name"] + " has no name")
                    last = here["order"]
                    reached.append(here["name"])
                self.assertEqual(len(reached), wanted, reached)

    def test_arrow_keys_and_charts_move_the_film(self):
        self.open("a", at="#frame-0")
        film = """({frame: +document.getElementById('frame').value,
                    source: document.getElementById('shaded').src.length})"""
        first = self.browser.evaluate(film)
        self.assertEqual(first["frame"], 0)
        self.browser.press("ArrowRight", number=39)
        self.assertEqual(self.browser.evaluate(film)["frame"], 1)
        self.browser.evaluate("document.getElementById('frame').focus()")
        self.browser.press("ArrowRight", number=39)
        self.assertEqual(self.browser.evaluate(film)["frame"], 2)
        self.browser.evaluate("document.getElementById('time-chart').focus()")
        self.browser.press("ArrowLeft", number=37)
        self.assertEqual(self.browser.evaluate(film)["frame"], 1)
        self.assertNotEqual(self.browser.evaluate(film)["source"], first["source"])
        self.assertIn("frame 1:", self.browser.evaluate("document.getElementById('time-chart-values').textContent"))
        # The chart takes up its size, and later a click, in the next frame that the browser draws.
        drawn = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(0))))"
        self.browser.evaluate("document.querySelector('#kept-chart canvas').scrollIntoView({behavior: 'instant'})")
        self.browser.evaluate(drawn)
        box = self.browser.evaluate("""(() => { const at = document.querySelector('#kept-chart canvas');
            const b = at.getBoundingClientRect();
            return [b.left + Chart.getChart(at).chartArea.right - 2, b.top + b.height / 2]; })()""")
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)
        self.browser.evaluate(drawn)
        self.assertEqual(self.browser.evaluate(film)["frame"], 4)
        self.assertEqual(self.browser.complaints(), [])

    def test_play_runs_and_stops(self):
        self.open("a", at="#frame-0")
        frame = "document.getElementById('frame').value"
        self.browser.evaluate("document.getElementById('play').click()")
        moved = self.browser.evaluate("new Promise((done) => setTimeout(() => done(+" + frame + "), 1600))")
        self.assertGreater(moved, 0)
        self.browser.evaluate("document.getElementById('play').click()")
        stood = self.browser.evaluate("[+" + frame + ", new Promise((done) => setTimeout(() => done(0), 900))][0]")
        self.assertEqual(self.browser.evaluate("+" + frame), stood)

    def test_shows_first_the_whole_scene_with_the_path_in_it(self):
        self.open("a", at="#frame-1")
        first = """(() => { const at = document.querySelector('main > *'), image = at.querySelector('img');
            return [at.id, image.naturalWidth, at.getBoundingClientRect().top < innerHeight]; })()"""
        self.assertEqual(self.browser.evaluate(first), ["overview", 960, True])
        mark = "(({hidden, style}) => [hidden, style.left, style.top])(document.querySelector('.eye'))"
        there = self.browser.evaluate(mark)
        self.assertFalse(there[0])
        self.browser.evaluate("goTo(2)")
        self.assertNotEqual(self.browser.evaluate(mark), there)
        self.open("again")  # of the files alone the eyes are not known
        self.assertEqual(self.browser.evaluate(first)[:2], ["overview", 960])
        self.assertTrue(self.browser.evaluate("document.querySelector('.eye').hidden"))

    def test_tells_what_is_left_to_draw(self):
        self.open("a", at="#frame-3")
        with open(os.path.join(self.directory, "a", "cull.json"), encoding="utf-8") as file:
            run = json.load(file)
        frame, words = run["frames"][3], self.text("#overview")
        for row, objects, triangles in (("everything", run["scene"]["objects"], run["scene"]["triangles"]),
                                        ("frustum alone, by boxes", frame["frustum_alone"]["objects"],
                                         frame["frustum_alone"]["triangles"]),
                                        ("all stages", len(frame["visible"]), frame["triangles"])):
            told = self.browser.evaluate("[...document.querySelectorAll('#overview tbody:last-child tr')].map((row) => "
                                         "row.textContent).find((text) => text.startsWith('" + row + "'))")
            self.assertTrue(told.startswith(f"{row}{objects:,} "), told)
            self.assertIn(f"%{triangles:,} ", told)
        self.assertIn("mean over the frames", words)
        self.assertIn("frame 3", words)
        self.assertLess(len(frame["visible"]), frame["frustum_alone"]["objects"])

        def old(data):  # a run of an earlier version
            for one in data["run"]["frames"]:
                del one["frustum_alone"]
        self.change("a", old)
        self.assertNotIn("frustum alone", self.text("#overview"))
        self.assertIn("all stages", self.text("#overview"))

    def test_columns_do_not_collide(self):
        for name in PAGES:
            for width in (390, 1400):
                with self.subTest(page=name, width=width):
                    self.open(name, width, 844)
                    self.assertEqual(self.browser.evaluate(COLLIDING), [])

    def test_no_name_does_harm(self):
        def rename(data):
            data["run"]["scene"]["file"] = HOSTILE
            for row in data["table"]["rows"][:3]:
                row[1] = row[2] = HOSTILE
            data["table"]["rows"][0][2] = "a/" + HOSTILE
            for rows in (data["occluders"]["most"], data["occluders"]["paying"], data["never"]["rows"]):
                for row in rows[:2]:
                    row["name"] = HOSTILE
            if data["loosest"]:
                data["loosest"]["unseen"], data["loosest"]["names"] = 1, [HOSTILE]
            data["run"]["frames"][0]["notes"] = data["run"]["frames"][1]["notes"] = [HOSTILE]
        self.change("a", rename)
        for width in (390, 1400):
            with self.subTest(width=width):
                self.browser.size(width, 844)
                self.assertEqual(self.browser.evaluate(UNFIT_SHOWN), [])
                found = self.browser.evaluate(WIDE)
                self.assertLessEqual(found["page"], found["window"], found["wide"])
                self.assertEqual(self.browser.evaluate(COLLIDING), [])
                self.assertLess(len(self.text("#rows")), 20000)
                self.shot(f"hostile-{width}")
        whole = self.browser.evaluate("document.querySelector('#rows td span').title")
        self.assertEqual(len(whole), len(HOSTILE))
        self.assertTrue(whole.startswith("first ") and whole.endswith("nlast"))
        self.assertEqual(self.browser.evaluate("document.querySelectorAll('img[onerror]').length"), 0)
        self.assertEqual(self.browser.complaints(), [])

    def test_a_file_of_such_a_name_is_harmless_too(self):
        corner = base64.b64encode(b"".join(struct.pack("<3f", *p) for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0)))).decode()
        scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
                 "nodes": [{"mesh": 0, "name": HOSTILE}, {"mesh": 0, "name": "plain", "translation": [2, 0, 0]}],
                 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                                "max": [1, 1, 0]}],
                 "bufferViews": [{"buffer": 0, "byteLength": 36}],
                 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + corner}]}
        with open(os.path.join(self.directory, "hostile.gltf"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        self.run_tool("cull", "hostile.gltf", "--frames", "2", "--size", "160x90", "--repeat", "1", "--report", "hostile")
        self.run_tool("report", "hostile", "-o", "hostile-again")
        for name in ("hostile", "hostile-again"):
            with self.subTest(page=name):
                self.open(name, 390, 844)
                self.assertEqual(self.browser.complaints(), [])
                self.assertEqual(self.browser.evaluate(UNFIT_SHOWN), [])
                self.assertIn("last", self.text("#rows"))
                self.assertEqual(self.browser.evaluate(COLLIDING), [])

    def test_switch_shows_what_was_culled_and_one_colour_an_object(self):
        self.open("a")
        shown = "['objects', 'culled', 'outside'].filter((id) => !document.getElementById(id).hidden).join()"
        self.assertEqual(self.browser.evaluate(shown), "")
        for look in ("culled", "objects", "outside"):
            self.browser.evaluate("document.querySelector('input[value=" + look + "]').click()")
            self.assertEqual(self.browser.evaluate(shown), look)
        self.assertIn("What was drawn is solid", self.text("#look-text"))

    def test_search_finds_objects(self):
        self.open("a")
        count = "document.querySelectorAll('#rows tr').length"
        self.assertGreater(self.browser.evaluate(count), 5)
        search = "(() => {{ const at = document.getElementById('search'); at.value = {}; " \
                 "at.dispatchEvent(new Event('input')); return {}; }})()"
        self.assertEqual(self.browser.evaluate(search.format("'no such thing'", count)), 0)
        self.assertEqual(self.browser.evaluate(search.format("String(data.table.rows[3][0])", count)), 1)
        self.assertGreater(self.browser.evaluate(search.format("''", count)), 5)

    def text(self, selector="body"):
        return self.browser.evaluate("document.querySelector('" + selector + "').innerText")

    def change(self, name, change):
        """Opens a page whose data were changed by a line of script."""
        with open(os.path.join(self.directory, name, "index.html"), encoding="utf-8") as file:
            before, opened, rest = file.read().partition('<script type="application/json" id="data">')
        data, closed, after = rest.partition("</script>")
        data = json.loads(data)
        change(data)
        os.makedirs(os.path.join(self.directory, "changed"), exist_ok=True)
        with open(os.path.join(self.directory, "changed", "index.html"), "w", encoding="utf-8") as file:
            file.write(before + opened + json.dumps(data).replace("<", "\\u003c") + closed + after)
        self.open("changed")
        self.assertEqual(self.browser.complaints(), [])

    def test_tells_the_verdict_and_the_facts_of_a_cull(self):
        self.open("a")
        for words in ("city:1:400", "cut at the height of the eye", "culls of 400 objects over 5 frames were visible", "First witness", "Repeat it", "Who hides most",
                      "Which occluders pay", "Never kept on this path",
                      "The slowest: frame", "the median", "Over-estimate",
                      "Without culling", "a pixel on average", "the same, sample by sample", "5 frames of 320 × 180"):
            self.assertIn(words, self.text())
        self.assertTrue(self.browser.evaluate("document.querySelector('.verdict').classList.contains('good')"))
        self.open("b")
        self.assertIn("Not verified", self.text(".verdict"))
        self.open("again")
        self.assertNotIn("Who hides most", self.text())  # a run's file holds no scene

    def test_tells_of_false_culls_interruption_and_odd_names(self):
        def wrong(data):
            data["run"]["verification"].update(false_culls=3, false_instances=3)
            data["run"]["frames"][3]["verification"]["false_culls"] = 3
            data["run"].update(interrupted=True, frames_wanted=64)
            data["run"]["scene"]["file"] = "dir/<img src=x onerror=alert(1)>.glb"
            data["table"]["rows"][0][1] = "<b>bold</b>"
        self.change("a", wrong)
        self.assertIn("3 of ", self.text(".verdict.bad"))
        self.assertIn("5 of 64 frames", self.text("header"))
        self.assertEqual(self.text("h1"), "<img src=x onerror=alert(1)>.glb")
        self.assertIn("<b>bold</b>", self.text("#rows"))
        self.assertEqual(self.browser.evaluate("player.frame"), 3)  # where something is wrong

    def test_opens_at_a_frame_worth_a_look(self):
        def walls(data):
            for shot in data["film"]["shots"]:
                shot["variety"] = 1
            data["film"]["shots"][2]["variety"] = 30
        self.change("b", walls)
        self.assertEqual(self.browser.evaluate("player.frame"), 2)
        self.open("a", at="#frame-4")
        self.assertEqual(self.browser.evaluate("player.frame"), 4)

    def test_compares_two_runs(self):
        self.open("both")
        for words in ("Two runs of city:1:400", "B passes", "B keeps", "Both runs", "Objects that differ"):
            self.assertIn(words, self.text())
        self.change("both", lambda data: data["compare"].update(ok=False, paired=0, frames=[]))
        self.assertIn("B fails", self.text(".verdict.bad"))

    def test_tells_what_methods_cost_and_where_they_are_wrong(self):
        self.open("drawn")
        for words in ("All 6 exact methods agree", "Where an image is wrong", "Depth complexity", "fragments generated",
                      "Z-fighting", "this run", " : 1.", "The same for all methods that count it"):
            self.assertIn(words, self.text())
        self.assertEqual(self.browser.evaluate("document.querySelectorAll('a[href=\"zbuffer.png\"]').length"), 1)
        self.open("coarse")
        for words in ("All 5 exact methods agree", "unorm16 is too coarse for them, so that it is not counted",
                      "hierarchy spared", "counts them as generated", "… in the counting run", " of preparation"):
            self.assertIn(words, self.text())
        self.assertNotIn("zbuffer, the fastest exact method", self.text())

        def wrong(data):
            data["run"]["methods"][4]["agreement"]["wrong"] = 3
            data["run"]["left_out"] = [{"name": "newell", "why": "21,000 polygons in view"}]
        self.change("coarse", wrong)
        self.assertIn("3 samples of exact methods", self.text(".verdict.bad"))
        self.assertIn("newell was left out: 21,000 polygons in view.", self.text())

    def test_tells_what_a_bake_came_to(self):
        self.open("map")
        for words in ("Visibility of rooms.prt", "4 cells, with 3 portals", "of all pairs of leaves are visible",
                      "A sight line through", "Who sees whom", "portals clipped"):
            self.assertIn(words, self.text())

    def test_a_cell_of_the_plan_can_be_asked(self):
        self.open("map")
        kinds = "[...document.querySelectorAll('.cells polygon')].sort((a, b) => a.dataset.cell - b.dataset.cell)" \
                ".map((at) => at.getAttribute('class'))"
        number = "document.querySelector('#plan input')"
        asked = int(self.browser.evaluate(number + ".value"))
        self.assertEqual(self.browser.evaluate(kinds)[asked], "asked")
        # The third room is seen from all; the first and the last do not see one another.
        for cell in (0, 3):
            self.browser.evaluate(f"{number}.value = {cell}; {number}.dispatchEvent(new Event('change'))")
            found = self.browser.evaluate(kinds)
            self.assertEqual(found[cell], "asked")
            self.assertIn(found[1], ("witnessed", "unresolved"))
            self.assertIn("of 3 other cells", self.text("#plan output"))
        place = self.browser.evaluate("(() => { const box = document.querySelector('[data-cell=\"1\"]')"
                                      ".getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()")
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", clickCount=1)
        self.assertEqual(self.browser.evaluate(kinds)[1], "asked")
        self.assertEqual(self.browser.complaints(), [])

    def test_a_view_cell_of_a_bake_can_be_asked(self):
        self.open("baked")
        number = "document.querySelector('#plan input')"
        held, witnessed = self.browser.evaluate(
            "[data.plan.cells.map((cell) => cell.held), data.plan.cells.map((cell) => cell.witnessed)]")
        self.assertGreater(len(held), 4)
        self.assertGreater(sum(witnessed), len(held))
        for cell in (0, len(held) - 1):
            self.browser.evaluate(f"{number}.value = {cell}; {number}.dispatchEvent(new Event('change'))")
            words = self.text("#plan output").replace(",", "")
            self.assertIn(f"from it {held[cell]} of ", words)
            self.assertIn(f"rays have seen {witnessed[cell]} {held[cell] - witnessed[cell]} are unresolved", words)
            boxes = self.browser.evaluate("[...document.querySelectorAll('#plan path')].map((path) => "
                                          "path.getAttribute('d').split('M').length - 1).reduce((a, b) => a + b)")
            self.assertIn(f"; {boxes} are on this storey", words)
            self.assertLessEqual(boxes, held[cell])
            self.assertGreater(boxes, 0)
        self.assertIn("gaps between walls", self.text("main"))
        self.assertEqual(self.browser.complaints(), [])

    def test_both_schemes_can_be_read(self):
        for name in PAGES:
            with self.subTest(page=name):
                self.open(name)
                back = "getComputedStyle(document.body).backgroundColor"
                light = self.browser.evaluate(back)
                for scheme in ("light", "dark"):
                    self.browser.emulate(prefers_color_scheme=scheme)
                    found = self.browser.evaluate(CONTRASTS)
                    self.assertGreater(found["count"], 20)
                    self.assertEqual(found["poor"], [], scheme)
                self.assertNotEqual(self.browser.evaluate(back), light)
                self.shot(name + "-dark")

    def test_fits_a_phone(self):
        for name in PAGES:
            with self.subTest(page=name):
                self.open(name, 390, 844)
                found = self.browser.evaluate(WIDE)
                self.assertLessEqual(found["page"], found["window"], found["wide"])
                self.assertEqual(found["wide"], [])
                self.assertEqual(self.browser.evaluate(UNDRAWN)["bad"], [])
                self.shot(name + "-phone")

    @unittest.skipUnless(shutil.which("node"), "there is no node")
    def test_scripts_are_sound(self):
        folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../sightline/tools/report/page")
        scripts = [os.path.join(folder, name) for name in sorted(os.listdir(folder)) if name.endswith(".js")]
        self.assertGreater(len(scripts), 5)
        for script in scripts:
            with self.subTest(script=os.path.basename(script)):
                done = subprocess.run(["node", "--check", script], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_less_motion_moves_less(self):
        self.open("a", prefers_reduced_motion="reduce")
        style = "getComputedStyle(document.getElementById('shaded')).transitionDuration"
        self.assertEqual(self.browser.evaluate(style), "0s")


if __name__ == "__main__":
    if not find_chromium():
        print("skipped: there is no Chromium on this machine (tools/setup --tests installs it)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
