// Sightline for C, and for every language that speaks C: what can be seen in a world, from a view.
// SPDX-License-Identifier: MIT
//
//     slWorld* world;                                  // objects, and what they hide with
//     slWorldDef def = slDefaultWorldDef();
//     slCreateWorld(&def, &world);                     // slAddOccluder(), slAddObject(), slCommit()
//
//     slQuery* query;                                  // a thread's own, from frame to frame
//     slCreateQuery(NULL, &query);
//     slQueryVisible(query, snapshot, &view, NULL, &set);
//     for (uint32_t i = 0; i < set.count; ++i) draw(set.objects[i].key);
//
// C99, or C++. Link with libsightline.
#ifndef SIGHTLINE_C_SIGHTLINE_H
#define SIGHTLINE_C_SIGHTLINE_H

#include "sightline/c/base.h"        // status codes, hooks, threads
#include "sightline/c/buffer.h"      // the occlusion buffer alone
#include "sightline/c/debug_draw.h"  // answers as lines
#include "sightline/c/explain.h"     // why an object is, or is not, in an answer
#include "sightline/c/prepared.h"    // prepared meshes of a visibility file
#include "sightline/c/query.h"       // what can be seen
#include "sightline/c/shadows.h"     // shadow casters
#include "sightline/c/sight.h"       // lines of sight, and what a region sees
#include "sightline/c/view.h"        // the eye
#include "sightline/c/ways.h"        // ways from place to place, and how long they are
#include "sightline/c/world.h"       // objects, occluders, baked visibility, snapshots

#endif
