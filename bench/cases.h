// The benchmark cases, one function each.
// SPDX-License-Identifier: MIT
#pragma once

#include "bench/options.h"
#include "bench/table.h"

namespace sightline::bench {

/// Balls smooth, bumpy and rough, or a scene: back faces by planes, masks of normals, and clusters of several makes; what each
/// finds of them, and what it costs.
Table benchBackface(const Options& options);

/// Random triangles and a city eight surfaces deep: building BSP trees beside random choice, and drawing by them front to
/// back, with what is free looked up, in segments and in bits, beside back to front.
Table benchBsp(const Options& options);

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

/// A furnished building of a quarter of a million triangles from inside its rooms: the share that view volume, rows, portals and
/// occlusion remove, one after the other, and what the reference renderer then takes. A fault where an image changes.
Table benchIndoor(const Options& options);

/// A field of dense statues: simpler occluders inside of them beside their own polygons, by the error allowed.
Table benchInner(const Options& options);

/// The occlusion buffer by itself on scenes made for it; then the whole query while a city grows, beside flat
/// frustum culling, and how tight its answer is.
Table benchOcclusion(const Options& options);

/// Radix sort beside std::sort; Newell's algorithm beside the painter's, Warnock's beside a plain z-buffer, rays by our
/// hierarchy beside Embree's.
Table benchOrder(const Options& options);

/// Views in real maps, where ../shared/maps is there: what portals as windows cost, and the leaves that they keep beside those that
/// are truly seen, and those of the maps' own rows.
Table benchPortals(const Options& options);

/// The rows of visibility of real maps, where ../shared/maps is there, and of rooms in a grid: their bytes on disk and in memory, and
/// what a row and a pair cost, beside the run-length lump.
Table benchRows(const Options& options);

/// A city under a low sun, from its streets: the casters of a shadow map beside those in the light's frustum, and the pixels
/// that the reference renderer lights otherwise without the rest.
Table benchShadow(const Options& options);

/// The cells of real maps, where ../shared/maps is there, and of rooms in a grid: baking who sees whom beside classic portal flow,
/// which is given half a minute, and on two threads beside one.
Table benchVis(const Options& options);

/// City from its streets and from above, building and terrain: what 1 to 64 occluder volumes cull beside the tiles, alone
/// and before them, and what the query then costs.
Table benchVolumes(const Options& options);

}  // namespace sightline::bench
