// The scenes on which occlusion is measured: the same geometry on every machine, as occluder batches and boxes to test.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sightline/geom/mesh_view.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"

namespace sightline::bench {

/// Triangles that are drawn or skipped together, in world space; opaque and single-sided.
struct OccluderBatch {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    Box3f bounds;

    MeshView mesh() const { return {positions, indices}; }
};

struct OcclusionCamera {
    glm::vec3 eye{0.0f};
    glm::vec3 direction{0.0f, 0.0f, 1.0f};  ///< not of unit length
};

/// What a culler may know of a scene's batches before the first frame.
enum class BatchesAre {
    kApart,       ///< nothing: each is prepared by itself
    kOneSurface,  ///< pieces of one surface that never move: prepared together, one occluder each
    kPanels,      ///< small parts of one thing that never moves: prepared as one occluder
};

struct OcclusionScene {
    std::string name;
    double fov_y = 0;  ///< [radians]
    std::vector<OcclusionCamera> cameras;
    std::vector<OccluderBatch> batches;
    std::vector<Box3f> boxes;  ///< occludees, in no particular order
    BatchesAre batches_are = BatchesAre::kApart;

    size_t triangles() const;
};

/// 4096 buildings, four to a batch; 200,000 boxes in the streets and on roofs; eight cameras, one of them above.
OcclusionScene makeOcclusionCity();

/// A height field of 512x512 cells in batches of 16x16; 100,000 boxes on the ground; eight cameras.
OcclusionScene makeOcclusionTerrain();

/// 32x32 rooms with doorways, floors, ceilings and three cupboards each; 50,000 boxes; eight cameras.
OcclusionScene makeOcclusionIndoor();

/// How large the triangles of a soup are, in pixels of 1280x720.
enum class SoupSize {
    kArea,  ///< areas of 10 to 50
    kSide,  ///< sides of 10 to 50
};

/// 100,000 triangles in no order, turned to the camera within their plane; 50,000 boxes; two cameras.
OcclusionScene makeOcclusionSoup(SoupSize size);

/// How the panels of a wall lie.
enum class WallBond {
    kGrid,    ///< each panel's edges are its neighbours'
    kBrick,   ///< every other course shifted by half a panel
    kTilted,  ///< bricks, turned within the wall, so that no edge follows a row of pixels
};

/// A wall of panels, each a batch of two triangles, 20,000 boxes behind and 1,000 before it; four cameras.
/// @param gap  between neighbours, seen by the first camera in 1280x720  [pixels]; 0: neighbours touch
OcclusionScene makeOcclusionWall(WallBond bond, double gap);

/// What makeOcclusionScene() knows, in the order in which it is measured.
std::vector<std::string> occlusionSceneNames();

/// A scene by its name; without batches if there is no such name.
OcclusionScene makeOcclusionScene(std::string_view name);

/// A camera's view. The image may not shift, so that an occlusion buffer of full size has the viewport's own pixels.
View occlusionView(const OcclusionScene& scene, size_t camera, uint32_t width, uint32_t height);

/// A number that tells two scenes apart: of all vertices, indices, boxes and cameras, bit for bit.
uint64_t hashOcclusionScene(const OcclusionScene& scene);

}  // namespace sightline::bench
