#!/usr/bin/env python3
# The Python package: arrays in and out, the same answers every time, and errors that say what is wrong.
# SPDX-License-Identifier: MIT
import gc
import pathlib
import sys
import threading
import unittest

try:
    import numpy
    import cffi  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

import sightline

CUBE = numpy.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], "f4")
FACES = numpy.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3],
                     [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])


def placed(low, high):
    """The transform that carries the unit cube into boxes."""
    low, high = numpy.asarray(low, "f8"), numpy.asarray(high, "f8")
    transforms = numpy.zeros((len(low), 4, 4))
    for axis in range(3):
        transforms[:, axis, axis] = (high - low)[:, axis]
        transforms[:, axis, 3] = low[:, axis]
    transforms[:, 3, 3] = 1
    return transforms


class Made:
    """A wall, and boxes behind and before it."""

    def __init__(self, seed=1, count=200):
        random = numpy.random.default_rng(seed)
        low = random.uniform([-8, -3, -20], [8, 3, 4], (count, 3))
        high = low + random.uniform(0.1, 1, (count, 3))
        low[0], high[0] = (-6, -4, 0), (6, 4, 0.2)
        self.low, self.high, self.world = low, high, sightline.World()
        self.cube = self.world.add_occluder(sightline.Occluder(CUBE, FACES))
        bounds = numpy.broadcast_to(numpy.array([[0, 0, 0], [1, 1, 1]]), (count, 2, 3))
        self.ids = self.world.add(bounds, placed(low, high), keys=1000 + numpy.arange(count), occluder=self.cube)
        self.now = self.world.commit()


VIEW = sightline.View.look_at((0, 0, 10), (0, 0, 0), fov_y=1.2)


class Answers(unittest.TestCase):
    def test_the_wall_hides_what_is_behind_it(self):
        made = Made()
        query = sightline.Query()
        seen = query.visible(made.now, VIEW)
        self.assertIn(1000, seen.keys)
        behind = (made.high[:, 2] < 0) & (abs(made.low[:, :2]).max(1) < 2) & (abs(made.high[:, :2]).max(1) < 2)
        self.assertGreater(behind.sum(), 2)
        self.assertFalse(numpy.isin(1000 + numpy.flatnonzero(behind), seen.keys).any())
        before = (made.low[:, 2] > 1) & (abs(made.low[:, :2]).max(1) < 1.5)
        self.assertGreater(before.sum(), 0)
        self.assertEqual(len(seen.objects), len(seen))
        self.assertEqual(sum(culled for _, culled in seen.stages.values()) + len(seen), len(made.now))
        reasons = query.reasons()
        self.assertEqual((reasons == 0).sum(), len(seen))
        self.assertTrue((reasons[behind] > 0).all())

    def test_an_answer_is_the_librarys_own_memory(self):
        made = Made()
        query = sightline.Query()
        seen = query.visible(made.now, VIEW)
        self.assertFalse(seen.objects.flags.owndata)
        self.assertFalse(seen.objects.flags.writeable)
        copy = seen.keys.copy()
        del query
        gc.collect()
        self.assertTrue((seen.keys == copy).all())

    def test_objects_move_and_go(self):
        made = Made()
        query = sightline.Query()
        hidden = int(numpy.setdiff1d(1000 + numpy.arange(len(made.ids)), query.visible(made.now, VIEW).keys)[0]) - 1000
        made.world.move(made.ids[hidden:hidden + 1], placed([[-0.2, -0.2, 6]], [[0.2, 0.2, 6.4]]))
        later = made.world.commit()
        self.assertNotIn(1000 + hidden, query.visible(made.now, VIEW).keys)
        self.assertIn(1000 + hidden, query.visible(later, VIEW).keys)
        made.world.remove(made.ids[hidden:hidden + 1])
        self.assertEqual(len(made.world), len(made.ids) - 1)
        with self.assertRaises(sightline.Error) as raised:
            made.world.remove(made.ids[hidden:hidden + 1])
        self.assertEqual(raised.exception.status, "SL_STALE_ID")

    def test_records(self):
        made, query = Made(), sightline.Query()
        query.visible(made.now, VIEW)
        recorded = query.record()
        self.assertEqual(recorded[:16], b"sightline frame\n")
        self.assertEqual(query.record(), recorded)
        query.visible(made.now, VIEW, stages=["frustum"])
        self.assertNotEqual(query.record(), recorded)

    def test_explains(self):
        made = Made()
        query = sightline.Query()
        reasons = (query.visible(made.now, VIEW), query.reasons())[1]
        occluded = numpy.flatnonzero(reasons == 1 + sightline.STAGES.index("occlusion"))[0]
        why = query.explain(made.now, VIEW, made.ids[occluded])
        self.assertEqual(why.verdict, "occluded")
        self.assertGreater(len(why.hiders), 0)
        self.assertIn("culled by occlusion: it lies behind object", str(why))
        self.assertIn("kept: ", str(query.explain(made.now, VIEW, made.ids[0])))

    def test_proposals_are_proved_or_kept(self):
        made = Made()
        proved = 0
        for x in range(-8, 9, 2):
            view = sightline.View.look_at((x, 0, 10), (x, 0, 0), fov_y=1.2)
            plain, query = sightline.Query(), sightline.Query()
            seen = plain.visible(made.now, view)
            self.assertEqual(seen.proved, 0)  # a first answer draws
            query.propose(made.ids)
            proposed = query.visible(made.now, view)
            proved += proposed.proved
            self.assertTrue(numpy.isin(proposed.keys, seen.keys).all())
            self.assertIn(1000, proposed.keys)
        self.assertGreater(proved, 0)
        query.propose(made.ids[:0])
        with self.assertRaises(TypeError):
            query.propose([1, 2])

    def test_another_query_teaches(self):
        made = Made()
        query, teacher = sightline.Query(), sightline.Query()
        proved = 0
        for step in range(12):
            view = sightline.View.look_at((0.01 * step, 0, 10), (0, 0, 0), fov_y=1.2)
            query.learn(teacher)
            seen = query.visible(made.now, view)
            proved += seen.proved
            self.assertIn(1000, seen.keys)
            teacher.visible(made.now, view)
        self.assertGreater(proved, 0)

    def test_settings_and_conventions(self):
        made = Made()
        query = sightline.Query()
        all_in_view = query.visible(made.now, VIEW, stages=["frustum"])
        count = len(all_in_view)
        self.assertGreater(count, len(query.visible(made.now, VIEW)))
        self.assertLess(len(query.visible(made.now, VIEW, max_distance=12.0)), count)
        with self.assertRaises(TypeError):
            query.visible(made.now, VIEW, no_such_setting=1)
        with self.assertRaisesRegex(sightline.Error, "contribution is outside of its limits"):
            query.visible(made.now, VIEW, contribution=-1.0)
        projection = numpy.array([[1, 0, 0, 0], [0, -16 / 9, 0, 0], [0, 0, 0, 0.1], [0, 0, -1, 0]])
        eye = numpy.eye(4)
        eye[2, 3] = -10
        vulkan = sightline.View(eye, projection, clip_space="vulkan-reversed")
        self.assertIsNone(vulkan.problem)
        self.assertIn(1000, query.visible(made.now, vulkan).keys)
        self.assertIsNotNone(sightline.View(eye.T, projection).problem)

    def test_threads_ask_one_snapshot(self):
        made, answers = Made(), []

        def ask():
            query = sightline.Query()
            answers.append([query.visible(made.now, VIEW).keys.copy().tolist() for _ in range(5)])

        threads = [threading.Thread(target=ask) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(answers), 4)
        self.assertTrue(all(answer == answers[0] for answer in answers))

    def test_sight_and_buffer(self):
        made = Made(count=1)
        sight = sightline.Sight()
        self.assertEqual(sight.look(made.now, (0, 0, 5), (0, 0, -5)), 1000)
        self.assertIsNone(sight.look(made.now, (0, 0, 5), (0, 0, 4)))
        self.assertIsNone(sight.seen_from(made.now, (0, 0, 0), (1, 1, 1)))
        buffer = sightline.Buffer(256)
        buffer.begin(VIEW)
        self.assertGreater(buffer.draw(sightline.Occluder(CUBE, FACES), placed(made.low, made.high)[0]), 0)
        boxes = [[[-1, -1, -3], [1, 1, -2]], [[-1, -1, 2], [1, 1, 3]], [[90, 0, 0], [91, 1, 1]]]
        self.assertEqual(buffer.ask(boxes).tolist(), [1, 0, 2])
        nearness, covered = buffer.image()
        self.assertEqual(nearness.shape, covered.shape)
        self.assertEqual(covered[covered.shape[0] // 2, covered.shape[1] // 2], 1)

    def test_bad_input_is_told(self):
        with self.assertRaisesRegex(ValueError, r"positions has shape \[[0-9, ]+\], not \[N, 3\]"):
            sightline.Occluder([1, 2, 3], FACES)
        with self.assertRaisesRegex(sightline.Error, "index 0 of the mesh is 9"):
            sightline.Occluder(CUBE, [[9, 0, 1]])
        world = sightline.World()
        with self.assertRaisesRegex(sightline.Error, "none of this world's"):
            world.add([[[0, 0, 0], [1, 1, 1]]], occluder=5)
        with self.assertRaisesRegex(sightline.Error, "is it transposed"):
            world.add([[[0, 0, 0], [1, 1, 1]]], placed([[1, 2, 3]], [[2, 3, 4]]).swapaxes(1, 2))
        with self.assertRaises(sightline.Error) as raised:
            world.attach(b"no visibility file")
        self.assertEqual(raised.exception.status, "SL_BAD_FILE")
        with self.assertRaises(TypeError):
            world.remove([1])
        with self.assertRaises(TypeError):
            world.add([[[0, 0, 0], [1, 1, 1]]], keys=[1.5])
        with self.assertRaises(ValueError):
            world.add([[[0, 0, 0], [1, 1, 1]]], keys=[-1])
        with self.assertRaises(ValueError):
            sightline.Occluder(CUBE, FACES + 2**32)
        with self.assertRaises(TypeError):
            sightline.View(numpy.eye(4) * 1j, numpy.eye(4))
        with self.assertRaises(KeyError):
            world.set_door("no such door", 1)
        self.assertEqual(len(sightline.version()), 3)

    def test_baked_rows(self):
        """A file of the tool's bake, whose objects are those of its report: where there is one."""
        baked = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else None
        if not baked or not baked.exists():
            self.skipTest("no baked file")
        world = sightline.World()
        world.attach(baked)
        world.add([[[0, 0, 0], [1, 1, 1]]])
        self.assertEqual(len(world.commit()), 1)
        world.attach(baked.read_bytes())
        hiders, shapes = world.add_prepared(baked, [*range(40), 10**12])
        self.assertGreater(len(set(hiders[hiders > 0])), 3)
        self.assertEqual((hiders[-1], shapes[-1]), (0, 0))
        self.assertTrue(((shapes > 0) >= (hiders > 0)).all())
        world.add([[[-1, -1, -1], [1, 1, 1]]] * 41, keys=range(100, 141), occluder=hiders, shape=shapes)
        ways = sightline.Ways()
        self.assertFalse(ways.begin(world.commit(), (1e9, 0, 0)))
        way = ways.to((0, 0, 0))
        self.assertEqual((way.known, way.connected), (False, True))
        self.assertEqual(way.points.shape, (0, 3))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
