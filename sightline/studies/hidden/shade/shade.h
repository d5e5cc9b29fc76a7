// Gives a hidden-surface image its colours: flat or smooth, under one sun, with or without its shadows.
// SPDX-License-Identifier: MIT
//
// Henri Gouraud. Continuous Shading of Curved Surfaces. 1971. (Normals are interpolated here, not colours: Bui Tuong
// Phong. Illumination for Computer Generated Pictures. 1975.)
// Grit Thürmer, Charles Wüthrich. Computing Vertex Normals from Polygonal Facets. 1998.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/shade/light.h"
#include "sightline/studies/hidden/shade/shadow_map.h"

namespace sightline::studies {

/// One normal a corner, object space, on the front's side: the mean of the faces around its position, each by the angle
/// of its corner there, that turn from its own face by no more than the crease. Positions are welded where they are equal
/// bit by bit, whatever their indices. Faces without area take part in nothing, and have normals of length 0; all
/// others' are of unit length.
///
/// @param crease_degrees  0 gives the faces' own normals  [0 to 180]
/// @return [size: 3 * triangles]
std::vector<glm::vec3> smoothNormals(const MeshView& mesh, double crease_degrees = 40);

enum class Shading : uint8_t {
    kFlat,    ///< by the triangle's normal
    kSmooth,  ///< by normals that faces share which meet at less than a crease
    kNone,    ///< the colours alone
};
inline constexpr std::string_view kShadingNames[] = {"flat", "smooth", "none"};

struct ShadeSettings {
    Shading shading = Shading::kFlat;
    glm::dvec3 sun = defaultSun();  ///< towards it, unit length
    double crease_degrees = 40;
    double diagonal = 0;  ///< of the world, for haze; 0: clear air
    double clear = 0;     ///< distance from the eye at which haze begins: where the world does  [world units]
    /// A triangle's linear colour. From any thread; empty: hashed from DrawItem::id.
    std::function<glm::dvec3(uint32_t item, uint32_t triangle)> colour;
    const ShadowMap* shadows = nullptr;  ///< of the same sun; none: it reaches everywhere
    ShareWork share;
};

/// One colour a sample (sRGB), rows as in HiddenImage; the sky where nothing is shown, or black without shading. The same
/// for any sharing of the work. Normals and positions are those of the surface that the image names, so that two
/// methods whose images agree give the same picture.
std::vector<glm::u8vec3> shade(const DrawList& list, const View& view, const HiddenImage& image,
                               const ShadeSettings& settings);

}  // namespace sightline::studies
