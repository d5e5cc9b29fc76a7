// Meshes of many items in one array of the GL, and what draws from it into an image.
// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include <glm/glm.hpp>

#include "apps/gl/context.h"
#include "apps/gl/objects.h"
#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline {

struct GlRange {
    uint32_t first = 0, count = 0;  ///< indices
};

/// A mesh's triangles, in the array that is bound.
struct GlMesh {
    GlRange single, double_sided;
    uint32_t base_vertex = 0;
    glm::vec3 middle{0.0f};  ///< that its positions are relative to

    /// To the world, of positions as they are held.
    glm::dmat4 placed(const glm::dmat4& transform) const {
        glm::dmat4 from_middle = transform;
        from_middle[3] = transform * glm::dvec4(glm::dvec3(middle), 1.0);
        return from_middle;
    }
    /// @param clockwise  the winding of its front faces in the image
    void draw(bool clockwise) const;
};

/// Appends the triangles of an item that write depth. Positions become relative to the middle of all: so a mesh whose
/// coordinates are those of a whole country is as exact as one at its origin.
GlMesh appendGlMesh(const studies::DrawItem& item, std::vector<glm::vec3>& positions, std::vector<uint32_t>& indices);

/// Numbers for meshes: items that share one have the same number.
class GlMeshNumbers {
public:
    uint32_t of(const studies::DrawItem& item) {
        return known_
            .try_emplace({item.mesh.positions.data(), item.mesh.indices.data(), item.double_sided.data(),
                          item.writes_depth.data()},
                         static_cast<uint32_t>(known_.size()))
            .first->second;
    }

private:
    std::map<std::tuple<const void*, const void*, const void*, const void*>, uint32_t> known_;
};

/// One array of vertices with its indices, a program, the image that it draws into.
struct GlMeshes {
    explicit GlMeshes(const GlContext& in) : context(in) {}
    ~GlMeshes() { context.makeCurrent(); }

    const GlContext& context;
    GlName vertices, indices, array, program;
    GlTarget target;

    Status compile(const char* vertex_shader, const char* fragment_shader);
    /// Attributes 0 and on come from the vertices; their formats are the caller's matter, but for attribute 0: a position.
    template <class Vertex>
    void store(const std::vector<Vertex>& all_vertices, const std::vector<uint32_t>& all_indices, GLuint attributes) {
        store(std::as_bytes(std::span(all_vertices)), sizeof(Vertex), all_indices, attributes);
    }
    /// Makes all ready to draw into an image whose depth is cleared; its colour is not.
    Status begin(const View& view, GLenum colour_format);
    /// @param pixels  [size: width * height of the target]
    Status read(GLenum format, GLenum type, std::vector<uint32_t>& pixels, const char* during) const;

private:
    void store(std::span<const std::byte> bytes, size_t vertex_size, std::span<const uint32_t> all_indices,
               GLuint attributes);
};

}  // namespace sightline
