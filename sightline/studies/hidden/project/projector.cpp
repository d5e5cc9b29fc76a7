// From meshes to the screen: transforms vertices, drops back faces and what lies outside, clips the rest.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/projector.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::studies {
namespace {

/// A valid projection has w >= near > 0 in front of the near plane; others are kept from dividing by zero.
constexpr double kSmallestW = 1e-30;

/// True if a small triangle passes between two rows or two columns of samples without touching either.
bool betweenSamples(const glm::dvec2* points) {
    const glm::dvec2 low = glm::min(glm::min(points[0], points[1]), points[2]) - 0.5;
    const glm::dvec2 high = glm::max(glm::max(points[0], points[1]), points[2]) - 0.5;
    return std::ceil(low.x) > high.x || std::ceil(low.y) > high.y;
}

/// True if a projection shows the fronts of surfaces clockwise that are counter-clockwise around their normals.
bool turnsOver(const glm::dmat4& p, bool orthographic) {
    const glm::dmat2 across(p[0][0], p[0][1], p[1][0], p[1][1]);
    if (orthographic) return glm::determinant(across) < 0;
    const glm::dvec3 x(p[0][0], p[1][0], p[2][0]), y(p[0][1], p[1][1], p[2][1]), w(p[0][3], p[1][3], p[2][3]);
    return glm::dot(x, glm::cross(y, w)) > 0;
}

}  // namespace

Projector::Projector(const View& view, const SampleGrid& grid, const ProjectorSettings& settings)
    : orthographic_(isOrthographic(view)),
      settings_(settings),
      grid_(grid),
      eye_(eyePosition(view)),
      rotation_(glm::dmat3(view.view)),
      projection_(view.projection) {
    // z and w are summed as rows: a parallel projection to infinity has a z that double cannot tell from -w.
    for (int column = 0; column < 4; ++column) projection_[column][2] += projection_[column][3];
    // What is seen turned over is so by x, y and w, or x and y if w is one: z may as well run the other way. The usual
    // perspective turns a right-handed eye space into a left-handed space of these.
    const bool turned = settings.front_face == FrontFace::kClockwise;
    eye_mirrored_ = (glm::determinant(glm::dmat3(view.view)) < 0) != turned;
    mirrored_ = turnsOver(view.projection, orthographic_) != eye_mirrored_;
    const double samples = grid.samples;
    // Sample (i, j) lies at clip position x/w = scale * i + start.
    scale_ = glm::dvec2(2.0 / (view.width * samples), 2.0 / (view.height * samples));
    start_ = (glm::dvec2(0.5 / samples) + grid.offset) * glm::dvec2(2.0 / view.width, 2.0 / view.height) - 1.0;
    // Two samples of room, so that rounding here cannot reject what a sample would see.
    low_ = start_ + scale_ * glm::dvec2(-2.0, grid.first_row - 2.0);
    high_ = start_ + scale_ * glm::dvec2(grid.width + 2.0, double(grid.first_row) + grid.height + 2.0);
    const auto add = [this](const glm::dvec4& plane) { planes_[plane_count_++] = plane; };
    add({0, 0, 1, 0});
    add({0, 0, -1, 2});
    const bool at_sides = settings.clipping == Clipping::kFrustum;
    if (!at_sides) add({0, 0, 0, 1});
    // The sides are those of the samples with their room: an edge that clipping makes runs between no two samples.
    const glm::dvec2 low = at_sides ? low_ : glm::dvec2(-settings.guard_band);
    const glm::dvec2 high = at_sides ? high_ : glm::dvec2(settings.guard_band);
    add({1, 0, 0, -low.x});
    add({-1, 0, 0, high.x});
    add({0, 1, 0, -low.y});
    add({0, -1, 0, high.y});
    if (at_sides) clip_mask_ |= Vertex::kReject;
}

void Projector::begin(const DrawItem& item) {
    item_ = &item;
    const bool turned = glm::determinant(glm::dmat3(item.transform)) < 0;
    flipped_ = turned != mirrored_;
    eye_flipped_ = turned != eye_mirrored_;
    // The difference of the large translations comes first: what follows is relative to the eye.
    const glm::dmat3 turn = rotation_ * glm::dmat3(item.transform);
    glm::dmat4 to_eye(turn);
    to_eye[3] = glm::dvec4(rotation_ * (glm::dvec3(item.transform[3]) - eye_), 1.0);
    const glm::dmat4 to_clip = projection_ * to_eye;
    const glm::dvec4 depth(to_eye[0].z, to_eye[1].z, to_eye[2].z, to_eye[3].z);
    const double band = settings_.guard_band;
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
        const double guard = band * clip.w;
        if (!(std::abs(clip.x) <= guard && std::abs(clip.y) <= guard && clip.w >= kSmallestW))
            outside |= Vertex::kGuard;
        vertex.outside = outside;
        if ((outside & Vertex::kClip) == 0) vertex.point = pointOf(clip);
    }
    in_eye_space_.clear();
    if (settings_.facing_test == FacingTest::kEyePlane)
        for (const glm::vec3& position : item.mesh.positions)
            in_eye_space_.push_back(to_eye * glm::dvec4(glm::dvec3(position), 1.0));
}

/// Facing in eye space, the eye being its origin and -z the direction of view.
bool Projector::isBackByPlane(size_t triangle) const {
    const uint32_t* index = item_->mesh.indices.data() + 3 * triangle;
    const glm::dvec3 &a = in_eye_space_[index[0]], &b = in_eye_space_[index[1]], &c = in_eye_space_[index[2]];
    const double side =
        orthographic_ ? parallelFacing(faceNormal(a, b, c), {0, 0, -1}) : eyeFacing(a, b, c, glm::dvec3(0.0));
    return side == 0 || isBack(triangle, side, eye_flipped_);
}

bool Projector::clip(ClipPolygon& polygon) const {
    glm::dvec4 buffers[2][ClipPolygon::kMaxVertices + 1];
    std::span<const glm::dvec4> rest(polygon.vertices, static_cast<size_t>(polygon.count));
    for (int i = 0; i < plane_count_; ++i) {
        glm::dvec4* out = buffers[i & 1];
        const int count = clipToPlane(rest, planes_[i], {out, rest.size() + 1});
        if (count == 0) return false;
        rest = {out, static_cast<size_t>(count)};
    }
    polygon.count = static_cast<int>(rest.size());
    std::copy(rest.begin(), rest.end(), polygon.vertices);
    for (const glm::dvec4& vertex : rest)
        if (!(vertex.w >= kSmallestW)) return false;
    return true;
}

bool Projector::project(size_t triangle, ScreenPolygon& out) {
    ++counters_.triangles;
    const std::span<const uint32_t> indices = item_->mesh.indices;
    const Vertex& a = vertices_[indices[3 * triangle]];
    const Vertex& b = vertices_[indices[3 * triangle + 1]];
    const Vertex& c = vertices_[indices[3 * triangle + 2]];
    if ((a.outside & b.outside & c.outside & Vertex::kReject) != 0 ||
        ((a.outside | b.outside | c.outside) & Vertex::kBroken) != 0) {
        ++counters_.rejected;
        return false;
    }
    glm::dvec3 normal;
    const double volume = homogeneousFacing(a.clip, b.clip, c.clip, normal);
    if (volume == 0 || (settings_.facing_test == FacingTest::kHomogeneous && isBack(triangle, volume, flipped_)) ||
        (settings_.facing_test == FacingTest::kEyePlane && isBackByPlane(triangle))) {
        ++counters_.back_facing;
        return false;
    }
    ClipPolygon polygon;
    polygon.count = 3;
    polygon.vertices[0] = a.clip;
    polygon.vertices[1] = b.clip;
    polygon.vertices[2] = c.clip;
    out.points[0] = a.point;
    out.points[1] = b.point;
    out.points[2] = c.point;
    const uint8_t outside = a.outside | b.outside | c.outside;
    const bool cut = (outside & clip_mask_) != 0;
    const bool left = !cut || clip(polygon);
    if (cut && left)
        for (int i = 0; i < polygon.count; ++i) out.points[i] = pointOf(polygon.vertices[i]);
    out.count = polygon.count;
    if (settings_.facing_test == FacingTest::kScreenArea && left) {
        const double area = screenFacing(out.outline());
        if (area == 0 || isBack(triangle, area, flipped_)) {
            ++counters_.back_facing;
            return false;
        }
    }
    if (cut) {
        ++counters_.clipped;
        if (!left) return false;
    } else if (betweenSamples(out.points)) {
        ++counters_.rejected;
        return false;
    } else {
        ++counters_.accepted;
        counters_.spared += outside != 0;
    }
    ++counters_.produced;
    out.depth = orthographic_ ? parallelPlane(a, b, c, normal) : perspectivePlane(normal / volume, polygon);
    return true;
}

bool Projector::projectHomogeneous(size_t triangle, HomogeneousTriangle& out) {
    ++counters_.triangles;
    const uint32_t* index = item_->mesh.indices.data() + 3 * triangle;
    const Vertex &a = vertices_[index[0]], &b = vertices_[index[1]], &c = vertices_[index[2]];
    const uint8_t outside = a.outside | b.outside | c.outside;
    if ((a.outside & b.outside & c.outside & Vertex::kReject) != 0 || (outside & Vertex::kBroken) != 0) {
        ++counters_.rejected;
        return false;
    }
    glm::dvec3 normal;
    const double volume = homogeneousFacing(a.clip, b.clip, c.clip, normal);
    const bool by_plane = settings_.facing_test == FacingTest::kEyePlane;
    if (volume == 0 || (by_plane ? isBackByPlane(triangle) : isBack(triangle, volume, flipped_)) ||
        !makeHomogeneous({a.clip, b.clip, c.clip}, {scale_, start_}, grid_, out)) {
        ++counters_.back_facing;
        return false;
    }
    ++counters_.accepted;
    counters_.spared += outside != 0;
    ++counters_.produced;
    if (orthographic_) {
        out.depth = parallelPlane(a, b, c, normal);
        return true;
    }
    ClipPolygon seen;  // nothing is nearer than the near plane, but where that is the projection alone knows
    for (const Vertex* vertex : {&a, &b, &c})
        if (vertex->clip.w >= kSmallestW) seen.vertices[seen.count++] = vertex->clip;
    if (seen.count == 0) return false;
    out.depth = perspectivePlane(normal / volume, seen);
    if ((outside & Vertex::kNear) != 0) out.depth.high = std::numeric_limits<double>::infinity();
    return true;
}

/// On the triangle's plane, dot(gradient, (x, y, w)) = 1: divided by w, this is 1/w as a function of the place.
DepthPlane Projector::perspectivePlane(const glm::dvec3& gradient, const ClipPolygon& polygon) const {
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
DepthPlane Projector::parallelPlane(const Vertex& a, const Vertex& b, const Vertex& c, const glm::dvec3& normal) const {
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

glm::dvec4 Projector::overSamples(const glm::dvec4& plane) const {
    // Relative to the eye and turned: dot(n, e) + d, e a point in eye space.
    const glm::dvec3 n = rotation_ * glm::dvec3(plane);
    const double d = glm::dot(glm::dvec3(plane), eye_) + plane.w;
    double x, y, depth, rest;  // the same over x / w, y / w, nearness and 1
    if (orthographic_) {
        const double w = projection_[3][3];
        const glm::dmat2 across(projection_[0][0], projection_[0][1], projection_[1][0], projection_[1][1]);
        const glm::dvec2 q = glm::transpose(glm::inverse(across)) * glm::dvec2(n);
        x = q.x * w;
        y = q.y * w;
        depth = n.z - glm::dot(q, glm::dvec2(projection_[2]));
        rest = d - glm::dot(q, glm::dvec2(projection_[3]));
    } else {
        const glm::dvec3 columns[3] = {{projection_[0][0], projection_[0][1], projection_[0][3]},
                                       {projection_[1][0], projection_[1][1], projection_[1][3]},
                                       {projection_[2][0], projection_[2][1], projection_[2][3]}};
        const glm::dvec3 q = glm::transpose(glm::inverse(glm::dmat3(columns[0], columns[1], columns[2]))) * n;
        x = q.x;
        y = q.y;
        rest = q.z;
        depth = d;
    }
    return {x * scale_.x, y * scale_.y, depth, rest + x * start_.x + y * start_.y};
}

std::vector<ScreenPolygon> projectAll(const DrawList& list, Projector& projector) {
    std::vector<ScreenPolygon> polygons;
    ScreenPolygon polygon;
    for (size_t i = 0; i < list.items().size(); ++i) {
        const DrawItem& item = list.items()[i];
        projector.begin(item);
        for (size_t triangle = 0; triangle < item.mesh.triangles(); ++triangle) {
            if (!item.writes_depth.empty() && item.writes_depth[triangle] == 0) continue;
            if (!projector.project(triangle, polygon)) continue;
            polygon.surface = list.firstSurface(i) + static_cast<uint32_t>(triangle);
            polygons.push_back(polygon);
        }
    }
    return polygons;
}

}  // namespace sightline::studies
