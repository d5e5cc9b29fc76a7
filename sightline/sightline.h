// All that a program needs which asks what can be seen: each header that it may include, and what it is for.
// SPDX-License-Identifier: MIT
//
// These headers and what they include are what an installation holds of sightline::run. Names in a namespace `detail` are
// not for users.
#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) < 202002L
#error "Sightline needs C++20: compile with -std=c++20 or later"
#endif

#include "sightline/math/glm_types.h"

// Asking: a World, its Snapshots, a View, and a Query, which answers with a VisibleSet.
#include "sightline/geom/clip_space.h"     // a View from the matrices of Vulkan, Direct3D, reversed depth, either hand
#include "sightline/geom/mirror.h"         // a View of what a flat mirror shows
#include "sightline/geom/view.h"           // a View: camera, viewport, and what is declared of the frame
#include "sightline/geom/view_limits.h"    // sections and windows of a view, from boxes and rectangles
#include "sightline/query/connectivity.h"  // ConnectivityQuery: by which way one comes from place to place
#include "sightline/query/object_queries.h"  // ObjectQueries: a world drawn by a graphics interface's occlusion queries
#include "sightline/query/query.h"           // Query: what can be seen
#include "sightline/query/shadow_query.h"    // ShadowQuery: which objects can darken what a view shows
#include "sightline/query/sight_query.h"  // SightQuery: whether two points see each other, and what is seen from a region
#include "sightline/world/world.h"        // World: objects that change; Snapshot: one state of them

// Preparing: once a mesh, when it is made or loaded.
#include "sightline/prepare/facing/draw_clusters.h"  // clusters that a renderer draws one by one
#include "sightline/prepare/inner/inner.h"           // simpler occluders inside of dense solids
#include "sightline/prepare/occluder/occluder.h"     // occluders: what hides

// Levels of detail: which one to draw is what Query says of an object with levels, World::addLods().
#include "sightline/geom/dither.h"        // masks that fade one level into another
#include "sightline/lod/frame_control.h"  // quality that follows the time of frames, and a cost model that does
#include "sightline/lod/lod_budget.h"     // the choice under a budget by itself
#include "sightline/lod/lod_choice.h"     // the choice by errors by itself

// Indoors: cells and portals.
#include "sightline/cells/cell_space_build.h"   // from code
#include "sightline/visfile/visibility_file.h"  // from a file that was baked

// Understanding an answer.
#include "sightline/query/explain/credits.h"        // which occluder hides how much
#include "sightline/query/explain/explain.h"        // why one object is, or is not, in an answer
#include "sightline/query/explain/shadows.h"        // whose shadows hide an object
#include "sightline/query/record/frame_recorder.h"  // an answer as a file
#include "sightline/query/record/frame_replay.h"    // which is asked again

// The occlusion buffer alone: draw occluders and ask about boxes, without a world.
#include "sightline/cull/occlusion_buffer.h"

// What the program brings with it, if it likes.
#include "sightline/base/assert.h"       // who hears of a broken invariant
#include "sightline/base/jobs.h"         // threads that share out a query
#include "sightline/base/memory.h"       // where memory comes from
#include "sightline/base/thread_pool.h"  // threads for programs that have none of their own
