// A plain z-buffer renderer: the slow, obvious reference for images, ids and depth complexity.
// SPDX-License-Identifier: MIT
#include "sightline/hidden/zbuffer.h"

#include <algorithm>
#include <cmath>

#include "sightline/hidden/clip.h"
#include "sightline/hidden/scan.h"

namespace sightline {
namespace {

/// A vertex as projected, and which planes it lies outside of.
struct Vertex {
    enum : uint8_t { kLeft = 1, kRight = 2, kBottom = 4, kTop = 8, kNear = 16, kFar = 32, kGuard = 64, kBroken = 128 };
    static constexpr uint8_t kReject = kLeft | kRight | kBottom | kTop | kNear | kFar | kBroken;
    static constexpr uint8_t kClip = kNear | kFar | kGuard;

    glm::dvec4 clip{0.0};   ///< x, y, the near plane's distance z + w, w
    glm::dvec2 point{0.0};  ///< on the grid of samples, unless kClip says that it has none yet
    double eye_z = 0;
    uint8_t outside = 0;
};

/// Nearness over the samples: row_0 + per_row * row + per_sample * sample, kept within [low, high].
struct DepthPlane {
    double origin = 0, per_row = 0, per_sample = 0, low = 0, high = 0;
};

/// Beyond this many half viewports polygons are clipped at the sides as well, so that screen positions stay small.
constexpr double kGuardBand = 4.0;
/// A valid projection has w >= near > 0 in front of the near plane; others are kept from dividing by zero.
constexpr double kSmallestW = 1e-30;

class Renderer {
public:
    Renderer(const View& view, const ZBufferSettings& settings, ZBufferImage& image)
        : settings_(settings),
          image_(image),
          orthographic_(isOrthographic(view)),
          eye_(eyePosition(view)),
          rotation_(glm::dmat3(view.view)),
          projection_(view.projection) {
        // z and w are summed as rows: a parallel projection to infinity has a z that double cannot tell from -w.
        for (int column = 0; column < 4; ++column) projection_[column][2] += projection_[column][3];
        // The usual projection turns a right-handed eye space into a left-handed clip space.
        mirrored_ = (glm::determinant(view.projection) > 0) != (glm::determinant(glm::dmat3(view.view)) < 0);
        const double samples = settings.samples;
        // Sample (i, j) lies at clip position x/w = scale * i + start.
        scale_ = glm::dvec2(2.0 / (view.width * samples), 2.0 / (view.height * samples));
        start_ = (glm::dvec2(0.5 / samples) + settings.offset) * glm::dvec2(2.0 / view.width, 2.0 / view.height) - 1.0;
        // Two samples of room, so that rounding here cannot reject what a sample would see.
        low_ = start_ + scale_ * glm::dvec2(-2.0, image.first_row - 2.0);
        high_ = start_ + scale_ * glm::dvec2(image.width + 2.0, double(image.first_row) + image.height + 2.0);
    }

    void draw(const DrawItem& item, bool writing) {
        const double determinant = glm::determinant(glm::dmat3(item.transform));
        flipped_ = (determinant < 0) != mirrored_;
        transformVertices(item);
        const std::span<const uint32_t> indices = item.mesh.indices;
        for (size_t triangle = 0; triangle < item.mesh.triangles(); ++triangle) {
            const bool writes = item.writes_depth.empty() || item.writes_depth[triangle] != 0;
            if (writes != writing) continue;
            const Vertex& a = vertices_[indices[3 * triangle]];
            const Vertex& b = vertices_[indices[3 * triangle + 1]];
            const Vertex& c = vertices_[indices[3 * triangle + 2]];
            if ((a.outside & b.outside & c.outside & Vertex::kReject) != 0) continue;
            if (((a.outside | b.outside | c.outside) & Vertex::kBroken) != 0) continue;
            const bool double_sided = !item.double_sided.empty() && item.double_sided[triangle] != 0;
            drawTriangle(a, b, c, double_sided, item.id, writing);
        }
    }

    /// The opaque surfaces that the finished image shows.
    void noteOpaque() {
        longest_.assign(image_.seen.size(), 0);
        for (uint32_t row = 0; row < image_.height; ++row) {
            const size_t line = size_t(row) * image_.width;
            for (size_t at = line; at < line + image_.width;) {
                const uint32_t id = image_.id[at];
                size_t end = at + 1;
                while (end < line + image_.width && image_.id[end] == id) ++end;
                if (id != ZBufferImage::kNone) noteSeen(id, at, end);
                at = end;
            }
        }
    }

private:
    /// A run of samples [begin, end) that show an id.
    void noteSeen(uint32_t id, size_t begin, size_t end) {
        image_.seen[id] = 1;
        if (end - begin <= longest_[id]) return;
        longest_[id] = static_cast<uint32_t>(end - begin);
        image_.seen_at[id] = begin + (end - begin) / 2;
    }

    void transformVertices(const DrawItem& item) {
        // The difference of the large translations comes first: what follows is relative to the eye.
        const glm::dmat3 turn = rotation_ * glm::dmat3(item.transform);
        glm::dmat4 to_eye(turn);
        to_eye[3] = glm::dvec4(rotation_ * (glm::dvec3(item.transform[3]) - eye_), 1.0);
        const glm::dmat4 to_clip = projection_ * to_eye;
        const glm::dvec4 depth(to_eye[0].z, to_eye[1].z, to_eye[2].z, to_eye[3].z);
        vertices_.resize(item.mesh.positions.size());
        for (size_t i = 0; i < vertices_.size(); ++i) {
            Vertex& vertex = vertices_[i];
            const glm::dvec4 position(glm::dvec3(item.mesh.positions[i]), 1.0);
            const glm::dvec4 clip = to_clip * position;
            vertex.clip = clip;
            if (orthographic_) vertex.eye_z = glm::dot(depth, position);
            const double size = std::abs(clip.x) + std::abs(clip.y) + std::abs(clip.z) + std::abs(clip.w);
            uint8_t outside = std::isfinite(size) ? 0 : Vertex::kBroken;
            if (clip.x < low_.x * clip.w) outside |= Vertex::kLeft;
            if (clip.x > high_.x * clip.w) outside |= Vertex::kRight;
            if (clip.y < low_.y * clip.w) outside |= Vertex::kBottom;
            if (clip.y > high_.y * clip.w) outside |= Vertex::kTop;
            if (clip.z < 0) outside |= Vertex::kNear;
            if (2 * clip.w - clip.z < 0) outside |= Vertex::kFar;
            const double guard = kGuardBand * clip.w;
            if (!(std::abs(clip.x) <= guard && std::abs(clip.y) <= guard && clip.w >= kSmallestW))
                outside |= Vertex::kGuard;
            vertex.outside = outside;
            if ((outside & Vertex::kClip) == 0) vertex.point = pointOf(clip);
        }
    }

    /// Six times the signed volume of eye and triangle in (x, y, w): positive for a counter-clockwise image,
    /// whether or not the triangle crosses the near plane. Also its normal in that space.
    static double imageVolume(const Vertex& a, const Vertex& b, const Vertex& c, glm::dvec3& normal) {
        const glm::dvec3 p(a.clip.x, a.clip.y, a.clip.w);
        const glm::dvec3 q(b.clip.x, b.clip.y, b.clip.w);
        const glm::dvec3 r(c.clip.x, c.clip.y, c.clip.w);
        normal = glm::cross(q - p, r - p);
        return glm::dot(normal, p);
    }

    void drawTriangle(const Vertex& a, const Vertex& b, const Vertex& c, bool double_sided, uint32_t id, bool writing) {
        glm::dvec3 normal;
        const double volume = imageVolume(a, b, c, normal);
        if (volume == 0) return;
        if (!double_sided && (volume > 0) == flipped_) return;
        glm::dvec2 points[ClipPolygon::kMaxVertices] = {a.point, b.point, c.point};
        ClipPolygon polygon;
        polygon.count = 3;
        polygon.vertices[0] = a.clip;
        polygon.vertices[1] = b.clip;
        polygon.vertices[2] = c.clip;
        if (((a.outside | b.outside | c.outside) & Vertex::kClip) != 0) {
            if (!clipAll(polygon)) return;
            for (int i = 0; i < polygon.count; ++i) points[i] = pointOf(polygon.vertices[i]);
        } else if (betweenSamples(points)) {
            return;
        }
        const DepthPlane plane =
            orthographic_ ? parallelPlane(a, b, c, normal) : perspectivePlane(normal / volume, polygon);
        const int32_t first_row = static_cast<int32_t>(image_.first_row);
        const int32_t end_row = first_row + static_cast<int32_t>(image_.height);
        const std::span<const glm::dvec2> outline(points, static_cast<size_t>(polygon.count));
        scanPolygon(outline, first_row, end_row, static_cast<int32_t>(image_.width),
                    [&](int32_t row, int32_t begin, int32_t end) {
                        if (writing) writeSpan(plane, id, row, begin, end);
                        else showSpan(plane, id, row, begin, end);
                    });
    }

    glm::dvec2 pointOf(const glm::dvec4& clip) const {
        return (glm::dvec2(clip.x / clip.w, clip.y / clip.w) - start_) / scale_ + 0.5;
    }

    /// True if a small triangle passes between two rows or two columns of samples without touching either.
    static bool betweenSamples(const glm::dvec2* points) {
        const glm::dvec2 low = glm::min(glm::min(points[0], points[1]), points[2]) - 0.5;
        const glm::dvec2 high = glm::max(glm::max(points[0], points[1]), points[2]) - 0.5;
        return std::ceil(low.x) > high.x || std::ceil(low.y) > high.y;
    }

    static bool clipAll(ClipPolygon& polygon) {
        const glm::dvec4 planes[ClipPolygon::kMaxPlanes] = {
            {0, 0, 1, 0},           {0, 0, -1, 2},         {0, 0, 0, 1},          {1, 0, 0, kGuardBand},
            {-1, 0, 0, kGuardBand}, {0, 1, 0, kGuardBand}, {0, -1, 0, kGuardBand}};
        for (const glm::dvec4& plane : planes) {
            ClipPolygon rest;
            clipToPlane(polygon, plane, rest);
            polygon = rest;
        }
        for (int i = 0; i < polygon.count; ++i)
            if (!(polygon.vertices[i].w >= kSmallestW)) return false;
        return polygon.count >= 3;
    }

    /// On the triangle's plane, dot(gradient, (x, y, w)) = 1: divided by w, this is 1/w as a function of the place.
    DepthPlane perspectivePlane(const glm::dvec3& gradient, const ClipPolygon& polygon) const {
        DepthPlane plane;
        plane.per_sample = gradient.x * scale_.x;
        plane.per_row = gradient.y * scale_.y;
        plane.origin = gradient.x * start_.x + gradient.y * start_.y + gradient.z;
        plane.low = plane.high = 1.0 / polygon.vertices[0].w;
        for (int i = 1; i < polygon.count; ++i) {
            plane.low = std::min(plane.low, 1.0 / polygon.vertices[i].w);
            plane.high = std::max(plane.high, 1.0 / polygon.vertices[i].w);
        }
        return plane;
    }

    /// Parallel projection: eye-space z is linear over the image already.
    DepthPlane parallelPlane(const Vertex& a, const Vertex& b, const Vertex& c, const glm::dvec3& normal) const {
        const double w = a.clip.w;
        const glm::dvec2 ab = glm::dvec2(b.clip - a.clip), ac = glm::dvec2(c.clip - a.clip);
        const double ab_z = b.eye_z - a.eye_z, ac_z = c.eye_z - a.eye_z;
        const glm::dvec2 gradient = w / normal.z * glm::dvec2(ab_z * ac.y - ac_z * ab.y, ac_z * ab.x - ab_z * ac.x);
        DepthPlane plane;
        plane.per_sample = gradient.x * scale_.x;
        plane.per_row = gradient.y * scale_.y;
        plane.origin = a.eye_z + glm::dot(gradient, start_ - glm::dvec2(a.clip) / w);
        plane.low = std::min({a.eye_z, b.eye_z, c.eye_z});
        plane.high = std::max({a.eye_z, b.eye_z, c.eye_z});
        return plane;
    }

    /// Where a row of the whole image begins in this band.
    size_t lineOf(int32_t row) const { return (size_t(row) - image_.first_row) * image_.width; }

    void countFragment(size_t at) {
        if (image_.generated[at] != UINT16_MAX) ++image_.generated[at];
    }

    void writeSpan(const DepthPlane& plane, uint32_t id, int32_t row, int32_t begin, int32_t end) {
        const size_t line = lineOf(row);
        double* depth = image_.depth.data() + line;
        uint32_t* ids = image_.id.data() + line;
        const double start = plane.origin + plane.per_row * row;
        for (int32_t i = begin; i < end; ++i) {
            double nearness = start + plane.per_sample * i;
            nearness = nearness > plane.low ? nearness : plane.low;
            nearness = nearness < plane.high ? nearness : plane.high;
            const bool nearer = nearness > depth[i];
            depth[i] = nearer ? nearness : depth[i];
            ids[i] = nearer ? id : ids[i];
        }
        if (settings_.want_generated)
            for (int32_t i = begin; i < end; ++i) countFragment(line + i);
    }

    void showSpan(const DepthPlane& plane, uint32_t id, int32_t row, int32_t begin, int32_t end) {
        const size_t line = lineOf(row);
        const double start = plane.origin + plane.per_row * row;
        int32_t run = begin;
        for (int32_t i = begin; i <= end; ++i) {
            if (i < end) {
                const double nearness = std::clamp(start + plane.per_sample * i, plane.low, plane.high);
                if (nearness >= image_.depth[line + i]) continue;
            }
            if (i > run) noteSeen(id, line + run, line + i);
            run = i + 1;
        }
        if (settings_.want_generated)
            for (int32_t i = begin; i < end; ++i) countFragment(line + i);
    }

    const ZBufferSettings& settings_;
    ZBufferImage& image_;
    bool orthographic_, mirrored_ = false, flipped_ = false;
    glm::dvec3 eye_;
    glm::dmat3 rotation_;
    glm::dmat4 projection_;
    glm::dvec2 scale_, start_, low_, high_;
    std::vector<Vertex> vertices_;
    std::vector<uint32_t> longest_;  ///< per id: its longest run so far
};

bool hasUnwritten(const DrawItem& item) {
    return std::find(item.writes_depth.begin(), item.writes_depth.end(), 0) != item.writes_depth.end();
}

}  // namespace

ZBufferImage renderZBuffer(std::span<const DrawItem> items, const View& view, const ZBufferSettings& settings) {
    ZBufferImage image;
    image.width = view.width * settings.samples;
    const uint32_t rows = view.height * settings.samples;
    image.first_row = std::min(settings.first_row, rows);
    image.height = std::min(settings.row_count, rows - image.first_row);
    const size_t samples = size_t(image.width) * image.height;
    image.id.assign(samples, ZBufferImage::kNone);
    image.depth.assign(samples, -std::numeric_limits<double>::infinity());
    if (settings.want_generated) image.generated.assign(samples, 0);
    size_t ids = 0;
    for (const DrawItem& item : items) ids = std::max<size_t>(ids, size_t(item.id) + 1);
    image.seen.assign(ids, 0);
    image.seen_at.assign(ids, ZBufferImage::kNowhere);

    Renderer renderer(view, settings, image);
    for (const DrawItem& item : items) renderer.draw(item, true);
    renderer.noteOpaque();
    for (const DrawItem& item : items)
        if (hasUnwritten(item)) renderer.draw(item, false);
    return image;
}

}  // namespace sightline
