// Finds the gap between what is near together and what is far off.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/scene_core.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

constexpr double kFar = 16;                  // times as far as the one before
constexpr double kAround = 64;               // the same of what may be many, but is around all: not of a room
constexpr double kFew = 0.25;                // of the objects or of the triangles
constexpr size_t kFewObjects = 16;           // each is tried as the middle
constexpr size_t kMostTriangles = 1u << 22;  // of more, objects are not taken apart

/// An object, or a triangle of one that reaches far.
struct Part {
    Box3d box;
    uint32_t object;
    double objects, triangles;  // what it counts for
};

double reachOf(const Box3d& box, const glm::dvec3& middle) {
    const glm::dvec3 far = glm::max(glm::abs(box.min - middle), glm::abs(box.max - middle));
    return glm::length(far);
}

/// Of the middles of boxes, axis by axis, each of some weight.
template <class Weight>
glm::dvec3 medianOf(const std::vector<Part>& parts, Weight&& weight) {
    glm::dvec3 median(0.0);
    std::vector<std::pair<double, double>> places(parts.size());
    for (int axis = 0; axis < 3; ++axis) {
        double whole = 0;
        for (size_t i = 0; i < parts.size(); ++i) {
            places[i] = {parts[i].box.center()[axis], weight(parts[i])};
            whole += places[i].second;
        }
        // The half that holds the median is halved again.
        auto begin = places.begin(), end = places.end();
        for (double below = 0; end - begin > 1;) {
            const auto middle = begin + (end - begin) / 2;
            std::nth_element(begin, middle, end);
            double lower = below;
            for (auto place = begin; place != middle; ++place) lower += place->second;
            if (lower >= whole / 2) {
                end = middle;
            } else {
                begin = middle;
                below = lower;
            }
        }
        if (begin != end) median[axis] = begin->first;
    }
    return median;
}

/// The objects, as boxes; those that are not finite are left out.
std::vector<Part> partsOf(const Scene& scene) {
    std::vector<Part> parts;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.objects[i].mesh];
        const Box3d box = transformBox(mesh.bounds, scene.objects[i].transform);
        if (!box.empty() && box.finite()) parts.push_back({box, i, 1, static_cast<double>(mesh.triangles())});
    }
    return parts;
}

/// Takes objects apart that reach far: one mesh may hold a building and what strayed from it.
void takeApart(const Scene& scene, const glm::dvec3& middle, std::vector<Part>& parts) {
    std::vector<double> reach;
    for (const Part& part : parts) reach.push_back(reachOf(part.box, middle));
    std::vector<double> sorted = reach;
    const auto half = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), half, sorted.end());
    const double far = parts.size() > 2 ? kFar * *half : 0;
    std::vector<Part> out;
    size_t left = kMostTriangles;
    for (size_t i = 0; i < parts.size(); ++i) {
        const SceneObject& object = scene.objects[parts[i].object];
        const Mesh& mesh = scene.meshes[object.mesh];
        const size_t triangles = mesh.triangles();
        if (reach[i] < far || triangles < 2 || triangles > left || mesh.deforms) {
            out.push_back(parts[i]);
            continue;
        }
        left -= triangles;
        for (size_t t = 0; t < triangles; ++t) {
            Box3d box;
            for (size_t c = 0; c < 3; ++c)
                box.grow(glm::dvec3(object.transform *
                                    glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * t + c]]), 1.0)));
            if (box.finite()) out.push_back({box, parts[i].object, 1.0 / static_cast<double>(triangles), 1});
        }
    }
    parts.swap(out);
}

/// Whether one of several distances may be kFar times the one before it: by their binary exponents, of which three are free then.
bool mayLeap(const std::vector<std::pair<double, uint32_t>>& reaches) {
    constexpr int kLeast = -1100, kMost = 1100;
    std::bitset<kMost - kLeast> taken;
    for (const auto& [reach, part] : reaches)
        if (!std::isfinite(reach)) return true;
        else if (reach > 0) taken.set(static_cast<size_t>(std::ilogb(reach) - kLeast));
    int last = kMost;
    for (int i = 0; i < kMost - kLeast; ++i)
        if (taken[static_cast<size_t>(i)]) {
            if (i - last >= std::ilogb(kFar)) return true;
            last = i;
        }
    return false;
}

/// Of the parts within the first great gap around a middle.
/// @param boxes  the boxes of the objects  [Scene::objects]
std::optional<SceneCore> coreAround(const std::vector<Part>& parts, const std::vector<Box3d>& boxes,
                                    const glm::dvec3& middle) {
    std::vector<std::pair<double, uint32_t>> order;
    double objects = 0, triangles = 0;
    for (uint32_t i = 0; i < parts.size(); ++i) {
        order.emplace_back(reachOf(parts[i].box, middle), i);
        objects += parts[i].objects;
        triangles += parts[i].triangles;
    }
    if (!mayLeap(order)) return std::nullopt;
    std::sort(order.begin(), order.end());
    SceneCore core;
    double objects_left = objects, triangles_left = triangles;
    for (size_t kept = 0; kept < order.size(); ++kept) {
        const Part& part = parts[order[kept].second];
        if (kept > 0 && order[kept].first > kFar * order[kept - 1].first && order[kept - 1].first > 0) {
            const bool few = objects_left <= kFew * objects || triangles_left <= kFew * triangles;
            const bool around =
                order[kept].first > kAround * order[kept - 1].first &&
                std::all_of(order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(),
                            [&](const auto& at) { return boxes[parts[at.second].object].holds(core.bounds); });
            if (few || around) {
                for (size_t i = kept; i < order.size(); ++i) core.aside.push_back(parts[order[i].second].object);
                std::sort(core.aside.begin(), core.aside.end());
                core.aside.erase(std::unique(core.aside.begin(), core.aside.end()), core.aside.end());
                return core;
            }
        }
        core.bounds.grow(part.box);
        objects_left -= part.objects;
        triangles_left -= part.triangles;
    }
    return std::nullopt;
}

}  // namespace

double SceneCore::diagonal() const {
    const double size = bounds.empty() ? 0 : glm::length(bounds.size());
    return std::isfinite(size) ? size : 0;
}

SceneCore coreOf(const Scene& scene) {
    SceneCore whole;
    std::vector<Part> parts = partsOf(scene);
    std::vector<Box3d> boxes(scene.objects.size());
    for (const Part& part : parts) whole.bounds.grow(boxes[part.object] = part.box);
    if (parts.empty()) return whole;
    const auto byObject = [](const Part& part) { return part.objects; };
    const auto byTriangle = [](const Part& part) { return part.triangles; };
    std::vector<glm::dvec3> middles{medianOf(parts, byObject), medianOf(parts, byTriangle)};
    if (parts.size() <= kFewObjects)
        for (const Part& part : parts) middles.push_back(part.box.center());
    takeApart(scene, middles[0], parts);
    middles.push_back(medianOf(parts, byTriangle));
    SceneCore best = whole;
    for (const glm::dvec3& middle : middles)
        if (std::optional<SceneCore> core = coreAround(parts, boxes, middle);
            core && core->diagonal() > 0 && (best.isWhole() || core->diagonal() < best.diagonal()))
            best = std::move(*core);
    return best;
}

std::string namesOf(const Scene& scene, std::span<const uint32_t> objects) {
    constexpr size_t kNamed = 3;
    std::vector<std::string> names;
    for (const uint32_t i : objects.first(std::min(objects.size(), kNamed))) {
        const SceneObject& object = scene.objects[i];
        const std::string path = oneLine(objectPath(scene, object), 60);
        names.push_back(path.empty() ? fmt::format("object {}", object.key) : "'" + path + "'");
    }
    return joined(names, ", ") + (objects.size() > kNamed ? ", ..." : "");
}

std::string asideText(const Scene& scene, std::span<const uint32_t> aside) {
    if (aside.empty()) return {};
    return fmt::format("{} of {} objects {} far beyond all others ({})", aside.size(), scene.objects.size(),
                       aside.size() == 1 ? "reaches" : "reach", namesOf(scene, aside));
}

}  // namespace sightline::tools
