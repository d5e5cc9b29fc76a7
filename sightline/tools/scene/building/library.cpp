// What a procedural building is furnished with: the table of its pieces, and those that code makes.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/building/library.h"

#include "sightline/base/assert.h"
#include "sightline/base/random.h"

namespace sightline::tools::building {
namespace {

using city::addBox;
using city::addTurned;
using city::MeshBuilder;

/// Boards between two sides and a back, and books on them.
/// @param boards  one more than the rows of books
MeshBuilder bookShelf(double half, double height, int boards, uint64_t seed) {
    MeshBuilder mesh;
    const double depth = 0.15625, thick = 0.0234375;
    addBox(mesh, kOak, {-half, 0, -depth}, {-half + thick, height, depth});
    addBox(mesh, kOak, {half - thick, 0, -depth}, {half, height, depth});
    addBox(mesh, kOak, {-half + thick, 0, -depth}, {half - thick, height, -depth + 0.0078125});
    Random random(seed);
    const double step = (height - 0.0625 - thick) / (boards - 1);
    for (int board = 0; board < boards; ++board) {
        const double y = 0.0625 + board * step;
        addBox(mesh, kOak, {-half + thick, y, -depth + 0.0078125}, {half - thick, y + thick, depth - 0.0078125});
        if (board + 1 == boards) break;
        for (double x = -half + thick + 0.01; x < half - thick - 0.07;) {
            if (random.below(9) == 0) {
                x += random.uniform(0.05, 0.2);
                continue;
            }
            const double wide = random.uniform(0.03, 0.1), tall = random.uniform(0.65, 0.9) * (step - thick);
            const double front = random.uniform(0.06, 0.12);
            addBox(mesh, static_cast<uint32_t>(kBookRed + random.below(4)), {x, y + thick, -depth + 0.015625},
                   {x + wide, y + thick + tall, front});
            x += wide + 0.002;
        }
    }
    return mesh;
}

/// A pot with a stem and crossed leaves.
MeshBuilder plant(double pot, double height, double spread, int leaves) {
    MeshBuilder mesh;
    const double rim = 1.75 * pot;
    addTurned(mesh, kTerracotta, {0, 0, 0}, 12,
              {{0.75 * pot, 0}, {pot, rim}, {1.0625 * pot, rim}, {1.0625 * pot, rim + 0.03125}});
    addTurned(mesh, kSoil, {0, 0, 0}, 8, {{0.8125 * pot, 0.03125}, {0.875 * pot, rim + 0.046875}});
    addTurned(mesh, kBark, {0, 0, 0}, 6, {{0.02, rim}, {0.012, 0.75 * height}});
    // Each leaf is folded along its middle.
    for (int i = 0; i < leaves; ++i) {
        const city::Frame frame = city::fifthFrame((2 * i) % 5);
        const double share = static_cast<double>(i) / leaves, foot = rim + 0.05 + share * 0.6 * (height - rim);
        const double reach = spread * (1 - 0.5 * share), rise = 0.3 * (height - rim) * (0.5 + share);
        const double turn = i % 3 * 0.25 - 0.25;  // so that leaves of one direction fan out
        const glm::dvec3 out = frame.u + frame.w * turn, wide = frame.w * (0.22 * reach);
        const glm::dvec3 root(0, foot, 0), tip = out * reach + glm::dvec3(0, foot + 0.6 * rise, 0);
        const glm::dvec3 middle = out * (0.5 * reach) + glm::dvec3(0, foot + rise, 0), sag(0, 0.05 * reach, 0);
        mesh.triangle(kLeaf, root, middle - wide + sag, middle);
        mesh.triangle(kLeaf, root, middle, middle + wide + sag);
        mesh.triangle(kLeaf, middle, middle - wide + sag, tip);
        mesh.triangle(kLeaf, middle, tip, middle + wide + sag);
    }
    return mesh;
}

}  // namespace

Pieces makeLibrary() {
    Pieces library = builtInPieces(kBuildingPieces);
    SIGHTLINE_ASSERT(library.materials.size() == kMaterialCount && library.meshes.size() == kItemCount);
    addFurniture(library.meshes);
    addFittings(library.meshes);
    return library;
}

void addFurniture(Shelf& meshes) {
    putShape(meshes[kBookShelf], bookShelf(0.5, 2.0625, 6, 11));
    putShape(meshes[kLowShelf], bookShelf(0.625, 0.859375, 3, 12));
    putShape(meshes[kPottedPlant], plant(0.0703125, 0.421875, 0.171875, 15));
    putShape(meshes[kTallPlant], plant(0.171875, 1.625, 0.46875, 40));
}

}  // namespace sightline::tools::building
