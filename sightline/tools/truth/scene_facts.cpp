// What the witnesses know of a scene beyond its data: where objects lie, and which triangles show and hide.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/scene_facts.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "sightline/base/random.h"

namespace sightline::tools {
namespace {

constexpr uint32_t kLeafSize = 4;

void gather(const Scene& scene, const Mesh& mesh, MeshFacts& facts) {
    const size_t count = mesh.triangles();
    facts.double_sided.assign(count, 0);
    facts.hides.assign(count, mesh.deforms ? 0 : 1);
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.material >= scene.materials.size()) continue;
        const Material& material = scene.materials[primitive.material];
        const size_t end = std::min<size_t>(count, size_t(primitive.first_triangle) + primitive.triangle_count);
        for (size_t t = primitive.first_triangle; t < end; ++t) {
            facts.double_sided[t] = material.double_sided ? 1 : 0;
            if (!material.hides()) facts.hides[t] = 0;
        }
    }
    facts.area_sum.resize(count);
    double sum = 0;
    for (size_t t = 0; t < count; ++t) {
        glm::dvec3 p[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = mesh.positions[mesh.indices[3 * t + k]];
            facts.bounds.grow(p[k]);
        }
        sum += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        facts.area_sum[t] = sum;
        facts.all_hide = facts.all_hide && facts.hides[t] != 0;
        facts.all_plain = facts.all_plain && facts.hides[t] != 0 && facts.double_sided[t] != 0;
    }
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Equal for equal meshes that show and hide alike.
uint64_t hashOf(const Mesh& mesh, const MeshFacts& facts) {
    uint64_t hash = mixSeed(mesh.positions.size(), mesh.indices.size());
    for (size_t t = 0; t < mesh.triangles(); ++t) hash = mixSeed(hash, 2u * facts.double_sided[t] + facts.hides[t]);
    for (const glm::vec3& p : mesh.positions)
        for (int i = 0; i < 3; ++i) hash = mixSeed(hash, std::bit_cast<uint32_t>(p[i]));
    for (const uint32_t index : mesh.indices) hash = mixSeed(hash, index);
    return hash;
}

uint64_t hashOf(const glm::dmat4& transform, const Box3d& box) {
    uint64_t hash = 0;
    for (int i = 0; i < 3; ++i)
        hash = mixSeed(mixSeed(hash, std::bit_cast<uint64_t>(box.min[i])), std::bit_cast<uint64_t>(box.max[i]));
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) hash = mixSeed(hash, std::bit_cast<uint64_t>(transform[column][row]));
    return hash;
}

bool withinReach(const Box3d& box) {
    constexpr double kReach = 1e15;
    for (int axis = 0; axis < 3; ++axis)
        if (box.min[axis] < -kReach || box.max[axis] > kReach) return false;
    return true;
}

}  // namespace

void BoxTree::build(std::span<const Box3d> boxes) {
    nodes_.clear();
    order_.clear();
    for (uint32_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].finite()) order_.push_back(i);
    if (order_.empty()) return;
    nodes_.reserve(order_.size());
    split(boxes, 0, static_cast<uint32_t>(order_.size()));
}

void BoxTree::split(std::span<const Box3d> boxes, uint32_t begin, uint32_t end) {
    const size_t at = nodes_.size();
    nodes_.emplace_back();
    Box3d bounds, centers;
    for (uint32_t i = begin; i < end; ++i) {
        bounds.grow(boxes[order_[i]]);
        centers.grow(boxes[order_[i]].center());
    }
    nodes_[at].box = bounds;
    nodes_[at].begin = begin;
    nodes_[at].end = end;
    if (end - begin <= kLeafSize) return;
    const glm::dvec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                         const double ca = boxes[a].min[axis] + boxes[a].max[axis];
                         const double cb = boxes[b].min[axis] + boxes[b].max[axis];
                         return ca < cb || (ca == cb && a < b);
                     });
    split(boxes, begin, middle);
    nodes_[at].right = static_cast<uint32_t>(nodes_.size());
    split(boxes, middle, end);
}

const BoxTree& MeshFacts::triangles(const Mesh& mesh) const {
    std::call_once(built_, [&] {
        std::vector<Box3d> boxes(mesh.triangles());
        for (size_t i = 0; i < mesh.indices.size(); ++i) boxes[i / 3].grow(glm::dvec3(mesh.positions[mesh.indices[i]]));
        tree_.build(boxes);
    });
    return tree_;
}

SceneFacts::SceneFacts(const Scene& scene) : scene_(scene) {
    for (const Mesh& mesh : scene.meshes) {
        meshes_.push_back(std::make_unique<MeshFacts>());
        gather(scene, mesh, *meshes_.back());
    }
    boxes_.resize(scene.objects.size());
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        const Box3d box = transformBox(meshes_[object.mesh]->bounds, object.transform);
        if (!box.finite() || !withinReach(box)) continue;
        boxes_[i] = box;
    }
    tree_.build(boxes_);
    findEqual();
}

bool SceneFacts::areEqual(uint32_t a, uint32_t b) const {
    if (std::memcmp(&scene_.objects[a].transform, &scene_.objects[b].transform, sizeof(glm::dmat4)) != 0) return false;
    if (scene_.objects[a].mesh == scene_.objects[b].mesh) return true;
    return sameBytes(mesh(a).positions, mesh(b).positions) && sameBytes(mesh(a).indices, mesh(b).indices) &&
           facts(a).double_sided == facts(b).double_sided && facts(a).hides == facts(b).hides;
}

/// Meshes are compared only of objects that lie in the same place.
void SceneFacts::findEqual() {
    struct Place {
        uint64_t hash = 0;
        uint32_t object = 0;
        bool operator<(const Place& o) const { return hash != o.hash ? hash < o.hash : object < o.object; }
    };
    std::vector<Place> places;
    for (uint32_t i = 0; i < boxes_.size(); ++i)
        if (!boxes_[i].empty()) places.push_back({hashOf(scene_.objects[i].transform, boxes_[i]), i});
    const auto forEachRun = [&](auto&& visit) {
        std::sort(places.begin(), places.end());
        for (size_t begin = 0, end = 0; begin < places.size(); begin = end) {
            while (end < places.size() && places[end].hash == places[begin].hash) ++end;
            if (end - begin > 1) visit(std::span(places).subspan(begin, end - begin));
        }
    };
    std::vector<Place> close;
    std::vector<uint64_t> mesh_hash(meshes_.size(), 0);
    forEachRun([&](std::span<const Place> run) {
        const uint32_t first_mesh = scene_.objects[run[0].object].mesh;
        const bool one_mesh = std::all_of(run.begin(), run.end(), [&](const Place& place) {
            return scene_.objects[place.object].mesh == first_mesh;
        });
        for (const Place& place : run) {
            uint64_t& hash = mesh_hash[scene_.objects[place.object].mesh];
            if (!one_mesh && hash == 0) hash = hashOf(mesh(place.object), facts(place.object));
            close.push_back({mixSeed(place.hash, one_mesh ? 0 : hash), place.object});
        }
    });
    if (close.empty()) return;
    places = std::move(close);
    first_equal_.resize(boxes_.size());
    std::iota(first_equal_.begin(), first_equal_.end(), 0u);
    has_equal_.assign(boxes_.size(), 0);
    forEachRun([&](std::span<const Place> run) {
        for (const Place& place : run.subspan(1)) {
            const uint32_t first = run[0].object;  // one hash, and yet another object: rare, and then it stays alone
            if (!areEqual(first, place.object)) continue;
            first_equal_[place.object] = first;
            has_equal_[first] = has_equal_[place.object] = 1;
            ++twins_;
        }
    });
    if (twins_ == 0) return;
    std::vector<Box3d> distinct = boxes_;
    for (uint32_t i = 0; i < distinct.size(); ++i)
        if (first_equal_[i] != i) distinct[i] = Box3d();
    distinct_.build(distinct);
}

}  // namespace sightline::tools
