// Divides a scene into objects that lie near together: first by their size, then by their place.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/near_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightline::tools {
namespace {

constexpr double kWidest = 1024;  // groups, in widths of the median of their objects

double widthOf(const Box3d& box) {
    const glm::dvec3 size = box.size();
    return std::max({size.x, size.y, size.z});
}

/// Takes out of a list what is not near the others: objects that are far wider than half of them; if there are none, one
/// half of the list by its place. Empty: they are near together.
std::vector<uint32_t> takeApart(const SceneFacts& facts, std::vector<uint32_t>& objects) {
    Box3d box, centers;
    std::vector<double> widths;
    for (const uint32_t object : objects) {
        box.grow(facts.box(object));
        centers.grow(facts.box(object).center());
        widths.push_back(widthOf(facts.box(object)));
    }
    const auto median = widths.begin() + static_cast<std::ptrdiff_t>((widths.size() - 1) / 2);
    std::nth_element(widths.begin(), median, widths.end());
    if (widthOf(box) <= kWidest * *median) return {};
    const double vast = 0.5 * kWidest * *median;
    const bool has_vast = *std::max_element(widths.begin(), widths.end()) > vast;
    const glm::dvec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const double middle = centers.center()[axis];
    const auto rest = std::stable_partition(objects.begin(), objects.end(), [&](uint32_t object) {
        return has_vast ? widthOf(facts.box(object)) <= vast : facts.box(object).center()[axis] < middle;
    });
    if (rest == objects.begin()) return {};
    std::vector<uint32_t> apart(rest, objects.end());
    objects.erase(rest, objects.end());
    return apart;
}

/// The median of the objects' middles, axis by axis. An object weighs its triangles by its width: the middle is where most
/// detail is. A 1024th of the group's is added to widths, so that points weigh no more than small objects.
glm::dvec3 middleOf(const SceneFacts& facts, std::span<const glm::dvec3> middles, const NearGroup& group) {
    glm::dvec3 median(0.0);
    std::vector<std::pair<double, double>> places(group.objects.size());
    for (int axis = 0; axis < 3; ++axis) {
        double whole = 0, below = 0;
        for (size_t i = 0; i < places.size(); ++i) {
            const SceneObject& object = facts.scene().objects[group.objects[i]];
            const double width = widthOf(facts.box(group.objects[i])) + widthOf(group.box) / kWidest;
            const auto triangles = static_cast<double>(facts.mesh(group.objects[i]).triangles());
            const glm::dvec3 place(object.transform * glm::dvec4(middles[object.mesh], 1.0));
            places[i] = {place[axis], width > 0 ? triangles / width : triangles};
            whole += places[i].second;
        }
        std::sort(places.begin(), places.end());
        for (const auto& [place, weight] : places) {
            median[axis] = place;
            below += weight;
            if (below >= 0.5 * whole) break;
        }
    }
    return median;
}

}  // namespace

glm::dvec3 medianCorner(const Mesh& mesh) {
    constexpr size_t kMostCorners = size_t(1) << 16;
    const size_t step = (mesh.indices.size() + kMostCorners - 1) / kMostCorners;
    glm::dvec3 median(0.0);
    std::vector<float> places;
    for (int axis = 0; axis < 3; ++axis) {
        places.clear();
        for (size_t i = 0; i < mesh.indices.size(); i += step)
            if (const float place = mesh.positions[mesh.indices[i]][axis]; std::isfinite(place))
                places.push_back(place);
        if (places.empty()) continue;
        const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
        std::nth_element(places.begin(), middle, places.end());
        median[axis] = *middle;
    }
    return median;
}

std::vector<NearGroup> nearGroups(const SceneFacts& facts, std::span<const glm::dvec3> middles) {
    std::vector<std::vector<uint32_t>> lists(1);
    for (uint32_t i = 0; i < facts.scene().objects.size(); ++i)
        if (!facts.box(i).empty()) lists[0].push_back(i);
    if (lists[0].empty()) return {};
    // The widest lists come first, should there be too many groups in the end.
    std::vector<NearGroup> groups;
    for (size_t at = 0; at < lists.size(); ++at) {
        const size_t known = groups.size() + lists.size() - at;
        std::vector<uint32_t> objects = std::move(lists[at]);
        std::vector<uint32_t> apart;
        if (known < kMostNearGroups) apart = takeApart(facts, objects);
        if (!apart.empty()) {
            lists.push_back(std::move(objects));
            lists.push_back(std::move(apart));
            continue;
        }
        NearGroup& group = groups.emplace_back();
        group.objects = std::move(objects);
        for (const uint32_t object : group.objects) group.box.grow(facts.box(object));
        group.middle = middleOf(facts, middles, group);
    }
    return groups;
}

}  // namespace sightline::tools
