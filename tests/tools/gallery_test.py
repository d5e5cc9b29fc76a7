#!/usr/bin/env python3
# Holds tools/gallery and its PNGs to their promises: round trips, broken files, the frame that is chosen, the page.
# SPDX-License-Identifier: MIT
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import random
import shutil
import stat
import struct
import sys
import tempfile
import unittest
import zlib

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]


def script(name):
    loader = importlib.machinery.SourceFileLoader(name, str(ROOT / "tools" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


gallery, film = script("gallery"), script("film")
png = gallery.png_picture


def noise(width, height, channels, seed, colours=256):
    """A picture of seeded noise over a slope, so that every filter is the best for some row."""
    chance, rows = random.Random(seed), []
    for y in range(height):
        rows.append(bytearray((x * (y % 3) + y * (y % 5) + chance.randrange(1 + y % 7)) % colours
                              for x in range(width * channels)))
    return png.Picture(width, height, channels, rows)


def file_of(width, height, kind, raw, extra=b""):
    head = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    return (png.SIGNATURE + png.chunk(b"IHDR", head) + extra + png.chunk(b"IDAT", zlib.compress(raw)) +
            png.chunk(b"IEND", b""))


def frame(visible, frustum, occlusion):
    return {"visible": list(range(visible)), "triangles": 10 * visible,
            "stages": [{"name": "frustum", "culled": frustum}, {"name": "occlusion", "culled": occlusion}]}


class Png(unittest.TestCase):
    def test_round_trip(self):
        sizes = [(1, 1, 3), (37, 23, 3), (64, 40, 4), (3, 50, 4), (300, 2, 3)]
        for seed, (width, height, channels) in enumerate(sizes):
            picture = noise(width, height, channels, seed)
            self.assertEqual(png.decode(png.encode(picture)), picture, f"seed {seed}")

    def test_few_colours_take_a_palette(self):
        picture = noise(90, 60, 3, 1, colours=4)
        data = png.encode(picture)
        self.assertEqual(data[25], 3)  # the colour type
        self.assertEqual(png.decode(data), picture)

    def test_every_filter_is_undone(self):
        chance = random.Random(7)
        width, height, step = 19, 10, 3
        rows = [bytes(chance.randrange(256) for _ in range(width * step)) for _ in range(height)]
        raw, above = b"", bytes(width * step)
        for y, row in enumerate(rows):
            line = bytearray()
            for i, value in enumerate(row):
                a, b, c = (row[i - step], above[i], above[i - step]) if i >= step else (0, above[i], 0)
                guess = a + b - c  # the standard's own words: the nearest of a, b, c, ties in this order
                nearest = min((abs(guess - v), n, v) for n, v in enumerate((a, b, c)))[2]
                line.append((value - (0, a, b, (a + b) // 2, nearest)[y % 5]) & 255)
            raw += bytes([y % 5]) + line
            above = row
        self.assertEqual([bytes(row) for row in png.decode(file_of(width, height, 2, raw)).rows], rows)

    def test_palette_with_alpha_and_grey(self):
        extra = png.chunk(b"PLTE", bytes([1, 2, 3, 4, 5, 6])) + png.chunk(b"tRNS", bytes([9]))
        picture = png.decode(file_of(2, 1, 3, bytes([0, 0, 1]), extra))
        self.assertEqual([picture.pixel(0, 0), picture.pixel(1, 0)], [(1, 2, 3, 9), (4, 5, 6, 255)])
        self.assertEqual(png.decode(file_of(1, 1, 0, bytes([0, 77]))).pixel(0, 0), (77, 77, 77))
        self.assertEqual(png.decode(file_of(1, 1, 4, bytes([0, 77, 5]))).pixel(0, 0), (77, 77, 77, 5))

    def test_refuses_what_is_not_as_it_should_be(self):
        good = png.encode(noise(20, 20, 3, 3))
        for cut in range(0, len(good), 7):
            with self.assertRaises(png.PngError):
                png.decode(good[:cut])
        for at in range(0, len(good), 11):
            broken = bytearray(good)
            broken[at] ^= 0x55
            with self.assertRaises(png.PngError):
                png.decode(bytes(broken))
        with self.assertRaises(png.PngError):
            png.decode(file_of(1, 1, 2, bytes([9, 0, 0, 0])))  # no such filter
        with self.assertRaises(png.PngError):
            png.decode(file_of(2, 1, 3, bytes([0, 0, 5]), png.chunk(b"PLTE", bytes(6))))  # beyond the palette
        with self.assertRaises(png.PngError):
            png.decode(file_of(2, 2, 2, bytes(5)))  # too few pixels
        with self.assertRaises(png.PngError):
            png.decode(file_of(1 << 20, 1 << 20, 2, b""))

    def test_downscaling_keeps_means(self):
        picture = noise(61, 37, 3, 5)
        small = png.downscaled(picture, 13)
        self.assertEqual((small.width, small.height), (13, 8))
        for c in range(3):
            whole = sum(sum(row[c::3]) for row in picture.rows) / (61 * 37)
            self.assertAlmostEqual(sum(sum(row[c::3]) for row in small.rows) / (13 * 8), whole, delta=0.6)
        self.assertEqual(png.downscaled(picture, 61), picture)
        board = png.Picture(4, 2, 3, [bytearray([0, 0, 0, 200, 100, 50] * 2)] * 2)
        self.assertEqual(png.downscaled(board, 2).rows, [bytearray([100, 50, 25] * 2)])

    def test_overlay(self):
        below = png.plain(2, 1, (100, 100, 100))
        above = png.Picture(2, 1, 4, [bytearray([200, 0, 50, 0, 200, 0, 50, 255])])
        self.assertEqual(png.over(above, below).rows, [bytearray([100, 100, 100, 200, 0, 50])])
        with self.assertRaises(ValueError):
            png.over(above, png.plain(1, 1, (0, 0, 0)))


class Choice(unittest.TestCase):
    def test_a_wall_in_the_face_is_not_chosen(self):
        frames = [frame(2, 10, 88), frame(20, 10, 70), frame(60, 30, 10)]
        self.assertEqual(gallery.choose_frame(frames, lambda i: (0.0, 0.8, 0.9)[i]), 1)

    def test_among_equal_pictures_the_most_hidden_is(self):
        frames = [frame(50, 0, 50), frame(10, 0, 90), frame(10, 80, 10)]
        self.assertEqual(gallery.choose_frame(frames, lambda i: 0.5), 1)

    def test_looks_at_few(self):
        asked = []
        gallery.choose_frame([frame(1, 1, i) for i in range(100)], lambda i: asked.append(i) or 1.0)
        self.assertLessEqual(len(asked), gallery.MOST_TRIED)
        self.assertEqual(gallery.choose_frame([frame(1, 0, 0)], lambda i: 0.0), 0)

    def test_liveliness(self):
        wall = png.plain(320, 180, (90, 90, 90))
        self.assertEqual(gallery.liveliness(wall), 0)
        self.assertGreater(gallery.liveliness(noise(320, 180, 3, 2)), 0.01)
        self.assertLessEqual(gallery.liveliness(noise(320, 180, 3, 2)), 1)


class WithEncoder(unittest.TestCase):
    def fake_encoder(self, root):
        """An img2webp of our own, first in the path, that copies the last frame and tells its arguments."""
        folder = root / "encoder"
        folder.mkdir()
        (folder / "img2webp").write_text(f'#!/bin/sh\necho "$@" > {root}/words\nfor last; do before=$frame; frame=$middle; '
                                         'middle=$last; done\ncp "$before" "$last"\n')
        (folder / "img2webp").chmod(0o755)
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = f"{folder}:{path}"


class Film(WithEncoder):
    def report(self, root, frames):
        (root / "frames").mkdir()
        for i in range(frames):
            (root / "frames" / f"frame-{i:04}.png").write_bytes(png.encode(noise(64, 36, 3, i)))
            (root / "frames" / f"outside-{i:04}.png").write_bytes(png.encode(png.plain(64, 36, (i, 99, 7))))
        return root

    def test_spreads_its_frames(self):
        self.assertEqual(film.spread([5, 6, 7], 3), [5, 6, 7])
        self.assertEqual(film.spread(list(range(100)), 4), [0, 33, 66, 99])

    def test_shows_what_is_seen_beside_what_is_culled(self):
        with tempfile.TemporaryDirectory() as place:
            root = self.report(pathlib.Path(place), 60)
            self.fake_encoder(root)
            self.assertEqual(film.main([str(root), "-o", str(root / "new" / "a.webp")]), 0)
            last = png.decode((root / "new" / "a.webp").read_bytes())
            self.assertEqual((last.width, last.height), (128 + film.GAP, 36))
            self.assertEqual(last.pixel(3, 2), noise(64, 36, 3, 59).pixel(3, 2))
            self.assertEqual(last.pixel(127 + film.GAP, 35), (59, 99, 7))
            words = (root / "words").read_text().split()
            self.assertEqual(sum(word.endswith(".png") for word in words), film.MOST_FRAMES)
            (root / "frames" / "outside-0000.png").unlink()
            self.assertEqual(film.main([str(root), "-o", str(root / "b.webp")]), 3)
            self.assertEqual(film.main([str(root / "none"), "-o", str(root / "b.webp")]), 3)
            self.assertFalse((root / "b.webp").exists())

    @unittest.skipUnless(shutil.which("img2webp"), "there is no img2webp (Debian: webp)")
    def test_is_an_animation(self):
        with tempfile.TemporaryDirectory() as place:
            root = self.report(pathlib.Path(place), 3)
            self.assertEqual(film.main([str(root), "-o", str(root / "a.webp")]), 0)
            data = (root / "a.webp").read_bytes()
            self.assertEqual((data[:4], data[8:12], data[12:16]), (b"RIFF", b"WEBP", b"VP8X"))
            self.assertEqual(data.count(b"ANMF"), 3)


class Page(WithEncoder):
    def test_escapes_markdown(self):
        self.assertEqual(gallery.escape("a|b *c* _d_ [e](f) <g>\nh & `i`"),
                         "a\\|b \\*c\\* \\_d\\_ \\[e\\](f) \\<g\\> h &amp; \\`i\\`")
        self.assertEqual(gallery.link("https://a.b/c_d"), "<https://a.b/c_d>")
        self.assertNotIn("<", gallery.link("javascript:x").replace("\\<", ""))

    def test_reads_attributions(self):
        read = gallery.attributions("## a.glb\nTitle of A\nAuthor: x: y\nLicence: MIT\nSource: https://a.b (c)\n\n"
                                    "## b.glb\n")
        self.assertEqual(read["a.glb"], {"title": "Title of A", "Author": "x: y", "Licence": "MIT",
                                         "Source": "https://a.b (c)"})
        self.assertEqual(read["b.glb"]["title"], "b.glb")

    def test_every_shared_scene_has_a_section_and_a_credit(self):
        path = ROOT.parent / "shared" / "scenes" / "ATTRIBUTION.md"
        if not path.exists():
            self.skipTest(f"{path} is not there")
        files = {file.stem for file in path.parent.glob("*.glb")}
        self.assertEqual(files, {name for name, row in gallery.SCENES.items() if "specification" not in row})
        for name, entry in gallery.attributions(path.read_text(encoding="utf-8")).items():
            self.assertTrue(entry["Author"] and entry["Licence"] and entry["Source"], name)

    def test_runs_the_tool_and_writes_all(self):
        """A tool of our own that writes a report of two frames; the second hides more and shows more."""
        with tempfile.TemporaryDirectory() as place:
            root = pathlib.Path(place)
            sums = {"samples": 2000, "id_samples": 5000, "false_culls": 0, "culled": 140, "over_estimate": 2.5,
                    "exactly_visible": 8, "reported": 20}
            run = {"scene": {"objects": 100, "triangles": 4000}, "verification": sums,
                   "frames": [frame(80, 10, 10), frame(20, 10, 70)]}
            (root / "run.json").write_text(json.dumps(run))
            for i, picture in enumerate((png.plain(64, 36, (9, 9, 9)), noise(64, 36, 3, 4))):
                (root / f"frame-{i:04}.png").write_bytes(png.encode(picture))
                (root / f"culled-{i:04}.png").write_bytes(png.encode(noise(64, 36, 4, i)))
                (root / f"outside-{i:04}.png").write_bytes(png.encode(noise(48, 27, 3, i)))
            tool = root / "tool"
            tool.write_text(f'#!/bin/sh\nfor last; do :; done\nmkdir -p "$last/frames"\n'
                            f'cp {root}/*.png "$last/frames"; cp {root}/run.json "$last/cull.json"\n')
            tool.chmod(tool.stat().st_mode | stat.S_IXUSR)
            options = ["--tool", str(tool), "--shared", str(root / "none"), "--out", str(root / "out"), "--docs",
                       str(root / "docs"), "--frames", "2"]
            self.fake_encoder(root)
            self.assertEqual(gallery.main(options), 0)
            self.assertTrue((root / "docs" / "gallery" / "film.webp").exists())
            page = (root / "docs" / "gallery.md").read_text()
            for words in ("## building:1:10", "keeps 20 of 100 objects", "occlusion 70", "frame 1", "| **all** | | 8 |",
                          "| building:1:10 | seeded | 2 | 140 |", "gallery/terrain-culled.png"):
                self.assertIn(words, page)
            self.assertNotIn("clinic", page)  # its file is not there
            self.assertEqual(png.decode((root / "docs/gallery/terrain-seen.png").read_bytes()), noise(64, 36, 3, 4))
            (root / "out" / "terrain" / "cull.json").write_text("{")
            self.assertEqual(gallery.main(options + ["--no-run"]), 3)
            sums["false_culls"] = 1
            (root / "run.json").write_text(json.dumps(run))
            self.assertEqual(gallery.main(options), 1)
            tool.write_text("#!/bin/sh\nexit 3\n")
            self.assertEqual(gallery.main(options), 3)


if __name__ == "__main__":
    unittest.main()
