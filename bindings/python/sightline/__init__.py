# Sightline for Python: what can be seen in a world, from a view, with NumPy's arrays in and out.
# SPDX-License-Identifier: MIT
"""What can be seen?

    import numpy, sightline

    world = sightline.World()
    wall = world.add_occluder(sightline.Occluder(positions, indices))
    world.add(bounds, keys=keys, occluder=wall)              # bounds: [objects, 2, 3]
    query = sightline.Query()
    view = sightline.View.look_at(eye, target, fov_y=1.0, size=(1280, 720))
    seen = query.visible(world.commit(), view)
    seen.keys                                                # of what may be seen, front to back

Matrices are NumPy's: m @ column vector, last row 0 0 0 1. What is seen is never missing from an answer; an answer's arrays are
the query's own memory, and hold until it is asked again: copy() what must last longer. A query is one thread's.

The library is libsightline: named by SIGHTLINE_LIBRARY in the environment, or of the same build or installation as this package,
or found by the system's loader.
"""
import ctypes.util
import os
import pathlib
import threading
import typing

import cffi
import numpy

from . import _cdef

__all__ = ["Buffer", "Error", "Explanation", "Occluder", "Query", "Sight", "Snapshot", "View", "Visible", "Way", "Ways", "World", "version"]

_ffi = cffi.FFI()
_ffi.cdef(_cdef.TEXT)


def _open():
    wish = os.environ.get("SIGHTLINE_LIBRARY")
    here = pathlib.Path(__file__).resolve().parent
    # Beside it; in a build, BUILD/python/sightline; in an installation, PREFIX/lib/python3/dist-packages/sightline.
    near = (place / "libsightline.so" for place in (here, *here.parents[1:3]))
    beside = next((str(library) for library in near if library.exists()), None)
    return _ffi.dlopen(wish or beside or ctypes.util.find_library("sightline") or "libsightline.so.0.1")


_lib = _open()

_VISIBLE = numpy.dtype([("key", "u8"), ("index", "u4"), ("generation", "u4")])
_ID = numpy.dtype([("index", "u4"), ("generation", "u4")])
_LOD = numpy.dtype([("level", "u1"), ("from", "u1"), ("fade", "f4"), ("morph", "f4")], align=True)
STAGES = ("pvs", "portals", "frustum", "distance", "contribution", "volumes", "occlusion", "lod", "clusters",
          "facing")
CLIP_SPACES = ("opengl", "direct3d", "vulkan", "direct3d-reversed", "vulkan-reversed", "direct3d-left-handed",
               "direct3d-left-handed-reversed")
_VERDICTS = ("no such object", "outside layers", "visible", "outside frustum", "occluded", "too far", "too small",
             "no cluster", "no time", "not in pvs", "no window", "faces away")


class Error(Exception):
    """A call that failed: one sentence, and .status, which is the name of the slStatus."""

    def __init__(self, status, sentence):
        super().__init__(sentence)
        self.status = status


_heard = threading.local()  # its sentence: what the log said last on this thread


@_ffi.callback("void(void*, slStatus, const char*)")
def _say(user, status, sentence):
    _heard.sentence = _ffi.string(sentence).decode()


def _log():
    return _ffi.new("slLog*", {"say": _say})[0]


def _hooks():
    return _ffi.new("slHooks*", {"log": _log()})


def _check(status):
    sentence = getattr(_heard, "sentence", None)
    _heard.sentence = None
    if status != _lib.SL_OK:
        name = _ffi.typeof("slStatus").elements.get(status, str(status))
        raise Error(name, sentence or _ffi.string(_lib.slStatusWords(status)).decode())


def _array(values, dtype, shape, name):
    """A contiguous array of that shape, in which None stands for any size."""
    array = numpy.ascontiguousarray(values, dtype=dtype)
    if array.ndim != len(shape) or any(want not in (None, have) for want, have in zip(shape, array.shape)):
        def words(sizes):
            return "[" + ", ".join("N" if size is None else str(size) for size in sizes) + "]"
        raise ValueError(f"{name} has shape {words(array.shape)}, not {words(shape)}")
    return array


def _ids(values):
    """Ids of World.add(), and nothing that could be taken for them."""
    ids = numpy.asarray(values)
    if ids.dtype != _ID:
        raise TypeError("ids are arrays of World.add(), with the fields index and generation")
    return _array(numpy.atleast_1d(ids), _ID, (None,), "ids")


def _whole(values, dtype, name):
    """Whole numbers that the type can hold."""
    array = numpy.asarray(values)
    if array.dtype.kind not in "iu" and not (array.dtype.kind == "O" and all(isinstance(v, int) for v in array.ravel())):
        raise TypeError(f"{name} are whole numbers, not {array.dtype}")
    limits = numpy.iinfo(dtype)
    if array.size and (int(array.min()) < limits.min or int(array.max()) > limits.max):
        raise ValueError(f"{name} are {limits.min} to {limits.max}")
    return array.astype(dtype)


def _at(array, kind):
    return _ffi.cast(kind, array.ctypes.data)


def _column_major(matrix, name):
    if numpy.iscomplexobj(matrix):
        raise TypeError(f"{name} is a matrix of real numbers")
    return _array(numpy.asarray(matrix, dtype="f8").T, "f8", (4, 4), name)


def _view_of(pointer, count, dtype, owner):
    """The library's memory as an array that keeps its owner alive."""
    if count == 0 or pointer == _ffi.NULL:
        return numpy.empty(0, dtype)
    held = _ffi.gc(_ffi.cast("char*", pointer), lambda _, owner=owner: None)
    array = numpy.frombuffer(_ffi.buffer(held, count * dtype.itemsize), dtype)
    array.flags.writeable = False
    return array


def version():
    """Of the library, as (major, minor, patch)."""
    number = _lib.slVersion()
    return number // 10000, number // 100 % 100, number % 100


class Occluder:
    """A mesh as something that hides. Only triangles that are surely drawn, opaque and unmoved, may be in it.

    positions: [vertices, 3] float32; indices: [triangles, 3], counter-clockwise in front; double_sided: all triangles are drawn from both sides."""

    def __init__(self, positions, indices, double_sided=False):
        positions = _array(positions, "f4", (None, 3), "positions")
        indices = _array(_whole(indices, "u4", "indices"), "u4", (None, 3), "indices")
        definition = _ffi.new("slOccluderDef*", _lib.slDefaultOccluderDef())
        definition.mesh.positions = _at(positions, "float*")
        definition.mesh.vertex_count = len(positions)
        definition.mesh.indices = _at(indices, "void*")
        definition.mesh.index_count = indices.size
        definition.both_sides = double_sided
        definition.log = _log()
        out = _ffi.new("slOccluder**")
        _check(_lib.slPrepareOccluder(definition, out))
        self._handle = _ffi.gc(out[0], _lib.slDestroyOccluder)

    @property
    def triangles(self):
        return _lib.slOccluderTriangles(self._handle)

    @property
    def bounds(self):
        box = _lib.slOccluderBounds(self._handle)
        return numpy.array([list(box.low), list(box.high)])


class Snapshot:
    """A state of a world that never changes; any number of threads may ask it. World.commit() makes it."""

    def __init__(self, handle, world):
        self._handle, self._world = _ffi.gc(handle, _lib.slReleaseSnapshot), world

    def __len__(self):
        return _lib.slSnapshotObjects(self._handle)


def _opened(file):
    """A visibility file, and what must live as long."""
    data = file if isinstance(file, bytes) else pathlib.Path(file).read_bytes()
    name = b"the visibility file" if isinstance(file, bytes) else str(file).encode()
    out = _ffi.new("slVisibility**")
    held = _ffi.from_buffer(data)
    _check(_lib.slOpenVisibility(held, len(data), name, _hooks(), out))
    return _ffi.gc(out[0], _lib.slCloseVisibility), held, data


class World:
    """Objects that come, move and go."""

    def __init__(self, objects=0, volumes=True):
        definition = _ffi.new("slWorldDef*", _lib.slDefaultWorldDef())
        definition.hooks = _hooks()[0]
        definition.objects, definition.volumes = objects, volumes
        out = _ffi.new("slWorld**")
        _check(_lib.slCreateWorld(definition, out))
        self._handle = _ffi.gc(out[0], _lib.slDestroyWorld)
        self._files = []

    def __len__(self):
        return _lib.slObjectCount(self._handle)

    def add_occluder(self, occluder):
        """A number that stands for it in add()."""
        out = _ffi.new("slOccluderId*")
        _check(_lib.slAddOccluder(self._handle, occluder._handle, out))
        return out.index

    def add(self, bounds, transforms=None, keys=None, occluder=0, shape=0, layers=1):
        """Adds objects, and gives their ids: an array with the fields index and generation.

        bounds: [objects, 2, 3], lowest and highest corner in object space, of all that may ever be drawn
        transforms: [objects, 4, 4], object to world; None: none
        keys: [objects], what answers say; None: 0, 1, 2 ...
        occluder, shape: what each hides with, and all its triangles: a number of add_occluder(), or one for each; 0: none
        layers: bit mask, or one for each"""
        bounds = _array(bounds, "f8", (None, 2, 3), "bounds")
        count = len(bounds)
        defs = _ffi.new("slObjectDef[]", count)
        size = _ffi.sizeof("slObjectDef")
        rows = numpy.frombuffer(_ffi.buffer(defs), "u1").reshape(count, size)
        rows[:] = numpy.frombuffer(_ffi.buffer(_ffi.new("slObjectDef*", _lib.slDefaultObjectDef())), "u1")

        def fill(field, values, dtype, shape):
            offset = _ffi.offsetof("slObjectDef", field)
            values = numpy.ascontiguousarray(numpy.broadcast_to(numpy.asarray(values, dtype), (count, *shape)))
            bytes_of = values.reshape(count, -1).view("u1") if count else values.view("u1").reshape(0, 0)
            rows[:, offset:offset + bytes_of.shape[1]] = bytes_of

        fill("bounds", bounds, "f8", (2, 3))
        if transforms is not None:
            transforms = _array(transforms, "f8", (count, 4, 4), "transforms")
            fill("transform", transforms.swapaxes(1, 2), "f8", (4, 4))
        fill("key", _whole(numpy.arange(count) if keys is None else keys, "u8", "keys"), "u8", ())
        for field, values in (("occluder", occluder), ("shape", shape), ("layers", layers)):
            fill(field, _whole(values, "u4", field), "u4", ())
        ids = numpy.zeros(count, _ID)
        _check(_lib.slAddObjects(self._handle, defs, count, _at(ids, "slObjectId*")))
        return ids

    def move(self, ids, transforms):
        """transforms: [ids, 4, 4]"""
        ids = _ids(ids)
        transforms = _array(transforms, "f8", (len(ids), 4, 4), "transforms")
        columns = numpy.ascontiguousarray(transforms.swapaxes(1, 2))
        _check(_lib.slMoveObjects(self._handle, _at(ids, "slObjectId*"), _at(columns, "double*"), len(ids)))

    def remove(self, ids):
        """One after the other: those before a stale one are gone when it is told."""
        for one in _ids(ids):
            _check(_lib.slRemoveObject(self._handle, _ffi.new("slObjectId*", [int(one["index"]), int(one["generation"])])[0]))

    def attach(self, file):
        """Takes up the cells of a visibility file, of `sightline bake`: a path, or its bytes."""
        opened = _opened(file)
        _check(_lib.slAttach(self._handle, opened[0]))
        self._files.append(opened)  # they must outlive snapshots, which hold the world

    def add_prepared(self, file, keys):
        """Adds what a visibility file holds of the meshes of objects, of `sightline bake --prepare`, each mesh once.

        file: a path, or its bytes; keys: [objects], as they were baked
        Two arrays for add(): what each hides with, and its shape; 0 where the file holds nothing, or several objects of the key."""
        opened = _opened(file)
        out = _ffi.new("slPrepared**")
        _check(_lib.slOpenPrepared(opened[0], out))
        prepared = _ffi.gc(out[0], _lib.slClosePrepared)
        keys = _array(_whole(keys, "u8", "keys"), "u8", (None,), "keys")
        meshes = numpy.array([_lib.slPreparedMeshOf(prepared, int(key)) for key in keys], "u4")
        found = numpy.zeros((2, len(keys)), "u4")
        ids = _ffi.new("slPreparedIds*")
        for mesh in numpy.unique(meshes[meshes != 0xffffffff]):
            _check(_lib.slAddPrepared(self._handle, prepared, int(mesh), ids))
            found[0, meshes == mesh], found[1, meshes == mesh] = ids.occluder.index, ids.shape.index
        return found[0], found[1]

    def set_door(self, name, open):
        """open: 0 shut, 1 open, and between."""
        door = _lib.slFindDoor(self._handle, name.encode())
        if door.index == 0:
            raise KeyError(name)
        _check(_lib.slSetDoor(self._handle, door, open))

    def commit(self):
        out = _ffi.new("slSnapshot**")
        _check(_lib.slCommit(self._handle, out))
        return Snapshot(out[0], self)


class View:
    """An eye and its image. view, projection: matrices of the caller's own convention, which clip_space names (CLIP_SPACES)."""

    def __init__(self, view, projection, size=(1280, 720), clip_space="opengl", jitter=0.5, layers=0xffffffff, eye_radius=0.0):
        self._view = _ffi.new("slView*", _lib.slDefaultView())
        for field, matrix in (("view", view), ("projection", projection)):
            setattr(self._view, field, list(_column_major(matrix, field).ravel()))
        self._view.width, self._view.height = size
        self._view.clip_space = CLIP_SPACES.index(clip_space)
        self._view.jitter, self._view.layers, self._view.eye_radius = jitter, layers, eye_radius

    @classmethod
    def look_at(cls, eye, target, up=(0, 1, 0), fov_y=1.0, size=(1280, 720), near=0.1, far=float("inf"), **others):
        """fov_y: the full vertical angle [radians]"""
        matrices = _ffi.new("double[2][16]")
        vectors = [_ffi.new("double[3]", list(map(float, v))) for v in (eye, target, up)]
        _lib.slLookAt(matrices[0], *vectors)
        _lib.slPerspective(matrices[1], fov_y, size[0] / size[1], near, far)
        view, projection = numpy.frombuffer(_ffi.buffer(matrices), "f8").reshape(2, 4, 4)
        return cls(view.T, projection.T, size, **others)

    @property
    def problem(self):
        """Why it cannot be used, in words; None: it can."""
        words = _lib.slViewProblem(self._view)
        return None if words == _ffi.NULL else _ffi.string(words).decode()


class Visible:
    """An answer. Its arrays hold until the query is asked again."""

    def __init__(self, query, answer, stats):
        self.objects = _view_of(answer.objects, answer.count, _VISIBLE, query)  #: key, index, generation; front to back
        self.lods = None if answer.lods == _ffi.NULL else _view_of(answer.lods, answer.count, _LOD, query)
        self.problem = None if answer.problem == _ffi.NULL else _ffi.string(answer.problem).decode()
        self.stages = {name: (s.tested, s.culled) for name, s in zip(STAGES, stats.stages)}  #: (tested, culled) of each
        self.proved = stats.proved  #: nodes and objects culled by certificates
        self.off = [_ffi.string(_lib.slOffWords(bit)).decode() for bit in range(32) if stats.off >> bit & 1]  #: what another setting switched off, in sentences
        self.microseconds = stats.nanoseconds / 1000

    @property
    def keys(self):
        return self.objects["key"]

    def __len__(self):
        return len(self.objects)


class Explanation:
    """Why an object is in an answer or not: verdict, in words as str(), hiders as [(key, share)]."""

    def __init__(self, why):
        self.verdict = _VERDICTS[why.verdict]
        self.key = why.object.key
        self.hiders = [(h.object.key, h.share) for h in why.hiders[0:min(why.hider_count, 16)]]
        words = _ffi.new("char[]", _lib.slExplanationWords(why, _ffi.NULL, 0))
        _lib.slExplanationWords(why, words, len(words))
        self._words = _ffi.string(words).decode()

    def __str__(self):
        return self._words


class Query:
    """Scratch of one thread, to be kept from frame to frame."""

    def __init__(self):
        out = _ffi.new("slQuery**")
        _check(_lib.slCreateQuery(_hooks(), out))
        self._handle = _ffi.gc(out[0], _lib.slDestroyQuery)

    @staticmethod
    def _settings(settings):
        to = _ffi.new("slQuerySettings*", _lib.slDefaultQuerySettings())
        for name, value in settings.items():
            if not hasattr(to, name) or name == "cookie":
                raise TypeError(f"there is no setting {name}")
            if name == "stages" and not hasattr(value, "__index__"):
                value = sum(1 << STAGES.index(stage) for stage in value)
            setattr(to, name, value)
        return to

    def visible(self, snapshot, view, **settings):
        """What may be seen. settings: fields of slQuerySettings, as max_distance=50; stages may be names."""
        answer, stats = _ffi.new("slVisibleSet*"), _ffi.new("slQueryStats*")
        _check(_lib.slQueryVisible(self._handle, snapshot._handle, view._view, self._settings(settings), answer))
        _check(_lib.slQueryGetStats(self._handle, stats))
        return Visible(self, answer, stats)

    def propose(self, ids):
        """Objects, by their ids of World.add(), that somebody else takes to be hidden, as a simulator's depth camera does. Nothing of it is
        believed: answers cull those that they can prove to be hidden. They stand until the next call."""
        ids = _ids(ids)
        _check(_lib.slQueryPropose(self._handle, _at(ids, "slObjectId*"), len(ids)))

    def learn(self, teacher):
        """Takes over what another query found out for its last view: who hides whom. From then on the teacher draws and seeks, and this one
        rests on what it was taught. Ask the teacher for the same view on another thread meanwhile; not while this is called."""
        _check(_lib.slQueryLearn(self._handle, teacher._handle))

    def reasons(self):
        """For each object of the last answer's snapshot, as they were added: 0 visible, 1 + index into STAGES of what culled it,
        255 outside of the view's layers."""
        count = _ffi.new("size_t*")
        _lib.slQueryReasons(self._handle, _ffi.NULL, 0, count)
        reasons = numpy.zeros(count[0], "u1")
        _check(_lib.slQueryReasons(self._handle, _at(reasons, "uint8_t*"), len(reasons), count))
        return reasons

    def explain(self, snapshot, view, id, **settings):
        """Why an object, by its id of World.add(), is in the answer or not."""
        why = _ffi.new("slExplanation*")
        one = _ffi.new("slObjectId*", [int(id["index"]), int(id["generation"])])[0]
        _check(_lib.slQueryExplain(self._handle, snapshot._handle, view._view, self._settings(settings), one, why))
        return Explanation(why)

    def depth_image(self):
        """The occlusion buffer after the last answer: nearness and covered, [height, width], row 0 at the top."""
        image = _ffi.new("slDepthImage*")
        _check(_lib.slQueryDepthImage(self._handle, image))
        return _images(image, self)

    def record(self):
        """The last answer as the bytes of a file that `sightline replay` asks again, times and judges."""
        data, count = _ffi.new("void const**"), _ffi.new("size_t*")
        _check(_lib.slQueryRecord(self._handle, data, count))
        return bytes(_ffi.buffer(data[0], count[0]))


def _images(image, owner):
    shape = image.height, image.width
    count = shape[0] * shape[1]
    nearness = _view_of(image.nearness, count, numpy.dtype("f4"), owner).reshape(shape)
    return nearness[::-1], _view_of(image.covered, count, numpy.dtype("u1"), owner).reshape(shape)[::-1]


class Sight:
    """Lines of sight, and what a region sees; scratch of one thread."""

    def __init__(self):
        out = _ffi.new("slSight**")
        _check(_lib.slCreateSight(_hooks(), out))
        self._handle = _ffi.gc(out[0], _lib.slDestroySight)

    def look(self, snapshot, start, end, layers=0xffffffff):
        """The key of an occluder that surely stands between two points; None: they may see each other."""
        settings, line = _ffi.new("slSightSettings*", _lib.slDefaultSightSettings()), _ffi.new("slSightLine*")
        settings.layers = layers
        points = [_ffi.new("double[3]", list(map(float, p))) for p in (start, end)]
        _check(_lib.slSightLook(self._handle, snapshot._handle, *points, settings, line))
        return line.by.key if line.blocked else None

    def seen_from(self, snapshot, low, high, layers=0xffffffff):
        """The keys of what may be seen from anywhere in a box; None: nothing is known of that."""
        region, seen = _ffi.new("slBox*", [list(map(float, low)), list(map(float, high))]), _ffi.new("slRegionSet*")
        _check(_lib.slSightFrom(self._handle, snapshot._handle, region, layers, seen))
        return _view_of(seen.objects, seen.count, _VISIBLE, self)["key"] if seen.known else None


class Way(typing.NamedTuple):
    """A way through open portals."""
    known: bool              # False: nothing is known of one of the places, and connected is True
    connected: bool
    distance: float
    narrowest: float         # the width of the narrowest hole on it; infinite: it passes none
    points: numpy.ndarray    # [n, 3]: both places, and the bends between them
    cells: numpy.ndarray


class Ways:
    """Ways from one place to others, for sound and for whoever walks; scratch of one thread."""

    def __init__(self):
        out = _ffi.new("slWays**")
        _check(_lib.slCreateWays(_hooks(), out))
        self._handle = _ffi.gc(out[0], _lib.slDestroyWays)

    def begin(self, snapshot, place, narrowest=0.0, farthest=float("inf")):
        """Says where ways begin; False: nothing is known of that place."""
        settings, known = _ffi.new("slWaySettings*", _lib.slDefaultWaySettings()), _ffi.new("bool*")
        settings.narrowest, settings.farthest = narrowest, farthest
        _check(_lib.slBeginWays(self._handle, snapshot._handle, _ffi.new("double[3]", list(map(float, place))), settings,
                                known))
        return bool(known[0])

    def to(self, place):
        """The way to a place, a Way."""
        way = _ffi.new("slWay*")
        _check(_lib.slWayTo(self._handle, _ffi.new("double[3]", list(map(float, place))), way))
        points = _view_of(way.points, 3 * way.point_count, numpy.dtype("f8"), self).reshape(-1, 3).copy()
        cells = _view_of(way.cells, way.cell_count, numpy.dtype("u4"), self).copy()
        return Way(bool(way.known), bool(way.connected), way.distance, way.narrowest, points, cells)


class Buffer:
    """The occlusion buffer alone: draw what hides, ask what is hidden."""

    def __init__(self, size=384):
        out = _ffi.new("slBuffer**")
        _check(_lib.slCreateBuffer(size, _hooks(), out))
        self._handle = _ffi.gc(out[0], _lib.slDestroyBuffer)
        self._drawn = []

    def begin(self, view):
        status = _lib.slBufferBegin(self._handle, view._view)
        self._drawn.clear()
        _check(status)

    def draw(self, occluder, transform=None):
        """Triangles that were drawn."""
        matrix = _ffi.NULL if transform is None else _ffi.new("double[16]", list(_column_major(transform, "transform").ravel()))
        drawn = _ffi.new("uint32_t*")
        _check(_lib.slBufferDraw(self._handle, occluder._handle, matrix, drawn))
        self._drawn.append(occluder)
        return drawn[0]

    def ask(self, boxes):
        """boxes: [boxes, 2, 3] in world space. For each: 0 it may be seen, 1 it is hidden, 2 it is outside."""
        boxes = _array(boxes, "f8", (None, 2, 3), "boxes")
        seen = numpy.zeros(len(boxes), "u1")
        _check(_lib.slBufferAsk(self._handle, _at(boxes, "slBox*"), len(boxes), _at(seen, "uint8_t*")))
        return seen

    def image(self):
        """Nearness and covered, [height, width], row 0 at the top."""
        image = _ffi.new("slDepthImage*")
        _check(_lib.slBufferImage(self._handle, image))
        return _images(image, self)
