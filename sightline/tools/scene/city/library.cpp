// The city's stock: materials, and the meshes that its objects are instances of. It depends on the seed alone.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/city/library.h"

#include "sightline/base/assert.h"

namespace sightline::tools::city {
namespace {

/// The asphalt under a block, a little past the middle of the streets so that it overlaps its neighbours', and the
/// pavements on it.
/// @param lane  gap along z through the middle of the pavement; 0: none
MeshBuilder ground(double size, double lane) {
    MeshBuilder mesh;
    const double half = 0.5 * size, kerb = half - kKerb;
    const double edge = half + 0.1875;
    mesh.quad(kAsphalt, {-edge, 0, edge}, {edge, 0, edge}, {edge, 0, -edge}, {-edge, 0, -edge});
    if (lane == 0) {
        addBox(mesh, kPaving, {-kerb, -0.25, -kerb}, {kerb, kPavement, kerb});
    } else {
        addBox(mesh, kPaving, {-kerb, -0.25, -kerb}, {-0.5 * lane, kPavement, kerb});
        addBox(mesh, kPaving, {0.5 * lane, -0.25, -kerb}, {kerb, kPavement, kerb});
    }
    return mesh;
}

}  // namespace

Library makeLibrary(uint64_t seed) {
    Library library{builtInPieces(kCityPieces), {}};
    SIGHTLINE_ASSERT(library.materials.size() == kMaterialCount && library.meshes.size() == kItemCount);
    putShape(library.meshes[kGroundLarge], ground(kLargeBlock, 0));
    putShape(library.meshes[kGroundSplit], ground(kLargeBlock, kAlley - 2));
    putShape(library.meshes[kGroundSmall], ground(kSmallBlock, 0));
    addBuildings(library, Random(mixSeed(seed, 0x6c696272617279ull)));
    return library;
}

}  // namespace sightline::tools::city
