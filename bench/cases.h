// The benchmark cases, one function each.
// SPDX-License-Identifier: MIT
#pragma once

#include "bench/options.h"
#include "bench/table.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tree/world_bvh.h"

namespace sightline::bench {

/// Balls smooth, bumpy and rough, or a scene: back faces by planes, masks of normals, and clusters of several makes; what each
/// finds of them, and what it costs.
Table benchBackface(const Options& options);

/// Frames of real work with a known limit, and halves of two, told by the classifier, a fault where it is wrong; and a frame of
/// the reference renderer that is measured beside one that is not. By the wall's clock: on idle cores only.
Table benchBottleneck(const Options& options);

/// Random triangles and a city eight surfaces deep: building BSP trees beside random choice, and drawing by them front to
/// back, with what is free looked up, in segments and in bits, beside back to front.
Table benchBsp(const Options& options);

/// Worlds of one to ten thousand boxes: the same questions through C and through C++.
Table benchC(const Options& options);

/// A walk through a city: guard band and outcodes beside naive clipping at six planes, and scanning without clipping.
Table benchClipping(const Options& options);

/// A city and made scenes: the tiled z-buffer beside the plain one, with and without what it saves, in all formats.
Table benchDepth(const Options& options);

/// Buildings, and real maps where ../shared/maps is there: what each level of eye-to-cell culling keeps and costs, beside the
/// windows of portals.
Table benchEye(const Options& options);

/// A million boxes, 7 % of them in view: corner by corner, p-vertex, flat SIMD, and the hierarchy.
Table benchFrustum(const Options& options);

#ifdef SIGHTLINE_GL
/// Flat-shaded pictures and id-buffers of 1920x1080: the z-buffer beside Mesa's software GL, on as many threads.
Table benchGl(const Options& options);
#endif

/// Every hidden-surface method on one view, and then all of benchClipping, benchOrder, benchBsp, benchDepth and benchGl.
Table benchHidden(const Options& options);

/// Swarms: a hierarchy that lives beside building it anew, grids beside both, and what a query of each costs beside the
/// flat list.
Table benchHierarchy(const Options& options);

/// Doorways of a building, or of a scene: the far side as an image beside drawing it. Triangles, how like the picture is, bake time,
/// memory, time to show, and the predicted beside the measured error.
Table benchImages(const Options& options);

/// A furnished building of a quarter of a million triangles from inside its rooms: the share that view volume, rows, portals and
/// occlusion remove, one after the other, and what the reference renderer then takes. A fault where an image changes.
Table benchIndoor(const Options& options);

/// A field of dense statues: simpler occluders inside of them beside their own polygons, by the error allowed.
Table benchInner(const Options& options);

/// Levels of detail: what choosing them costs an object; the greedy choice beside the best of all; and a walk with jumps through
/// a field of statues, drawn by the z-buffer under a budget, by levels chosen ahead and by knobs that react.
Table benchLod(const Options& options);

/// The occlusion buffer by itself on scenes made for it; then the whole query while a city grows, beside flat
/// frustum culling, and how tight its answer is.
Table benchOcclusion(const Options& options);

/// Radix sort beside std::sort; Newell's algorithm beside the painter's, Warnock's beside a plain z-buffer, rays by our
/// hierarchy beside Embree's.
Table benchOrder(const Options& options);

/// Scattered cameras and a walk, answered by the query in several settings and, if CMake was given SIGHTLINE_PEER, by
/// MaskedOcclusionCulling: times of a frame and objects kept, beside those of the first contestant.
Table benchPeers(const Options& options);

/// Views in real maps, where ../shared/maps is there: what portals as windows cost, and the leaves that they keep beside those that
/// are truly seen, and those of the maps' own rows.
Table benchPortals(const Options& options);

/// Walls behind walls, and a walk through a city or a scene: what stop-and-wait, CHC and CHC++ ask and what a frame takes beside
/// the frustum alone, by a simulated GPU whose answers come up to three frames late, and by Mesa's software GL.
Table benchQueries(const Options& options);

/// The rows of visibility of real maps, where ../shared/maps is there, and of rooms in a grid: their bytes on disk and in memory, and
/// what a row and a pair cost, beside the run-length lump.
Table benchRows(const Options& options);

/// A city under a low sun, from its streets: the casters of a shadow map beside those in the light's frustum, and the pixels
/// that the reference renderer lights otherwise without the rest.
Table benchShadow(const Options& options);

/// View cells of a building or of a scene, 512 and 2,048, with cells of its walls: the objects of their rows, by shadows alone and
/// by portals too, beside those that rays see from the same cells, all around and aimed at each object of the row. What rays see is
/// a lower bound of what is visible.
Table benchViewCells(const Options& options);

#ifdef SIGHTLINE_VIEWER
/// A frame of the viewer, picture and all, along a walk through a city or a scene: by all stages and by the frustum alone, beside
/// one without culling.
Table benchViewer(const Options& options);
#endif

/// The cells of real maps, where ../shared/maps is there, and of rooms in a grid: baking who sees whom beside classic portal flow,
/// which is given half a minute, and on two threads beside one.
Table benchVis(const Options& options);

/// City from its streets and from above, building and terrain: what 1 to 64 occluder volumes cull beside the tiles, alone
/// and before them, and what the query then costs.
Table benchVolumes(const Options& options);

/// Walks through a city, a building and a terrain, 60 frames a second, each frame once and in order: what the query costs a frame, and
/// keeps, beside the frustum alone and a query without a memory.
Table benchWalks(const Options& options);

/// Buildings by their marks and by their own walls, or a scene by its walls: ways from place to place, beside a search of all cells
/// by the middles of portals, which are longer.
Table benchWays(const Options& options);

// Parts of these cases that have a file of their own.

/// Two eyes, four cascades, the six faces of a cube, from the middle of a world, in one walk of its tree and in a walk for each.
/// @param world  half side of the world  [world units]
void measureManyFrusta(Table& table, const PlacedBvh& tree, const std::string& where, double world, int repeat);

/// Queries of a scene's own hierarchy from its seeded cameras; then a part of the scene moves as one.
void addSceneTree(Table& table, const std::string& where, const Scene& scene, int repeat);

/// What a world's commits cost while its objects come, move and go, and what queries of it cost then.
void addWorld(Table& table, const std::string& world, uint32_t count, int repeat);

/// All of occlusionSceneNames() at 1280x720 and 1920x1080 on one thread: the thread's own times, each the median of
/// Options::repeat in a view (24 if it is 0), and counts, both as means over the views.
void measureOcclusionCore(const Options& options, Table& table);

/// Objects kept along a path, beside what the same box test keeps on an exact z-buffer and what a 4x4 id-buffer shows.
void measureTightness(const Scene& scene, const CameraPath& path, uint32_t occlusion_size, const std::string& where,
                      Table& table);

/// The views of a path in one bin and in two, by one worker and by two; times of the clock on the wall, so that the
/// ratios mean something on idle cores only. Adds its rows to the table.
void measureQueryThreads(const Scene& scene, const CameraPath& path, const std::string& where, int repeat,
                         Table& table);

}  // namespace sightline::bench
