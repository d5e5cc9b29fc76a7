// Proves that culled objects are hidden: every point of them, by exact arithmetic on the triangles of the scene.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/cull_proof.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <list>
#include <unordered_map>
#include <utility>

#include "sightline/base/random.h"
#include "sightline/tools/truth/exact.h"
#include "sightline/tools/truth/shadow_pieces.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::tools {
namespace {

/// Triangles that hid something just now, which are tried on the next piece before a search.
constexpr size_t kRecent = 6;
/// What one box may cost: of a mesh, and of several objects. It is a try.
constexpr uint64_t kBoxWork = 300, kGroupWork = 40;
/// A mesh of so few triangles is not tried by boxes.
constexpr size_t kFewTriangles = 8;
/// So many places that are left end the proof of an object.
constexpr int kMostOpen = 64;

}  // namespace

/// The planes of a view, relative to the eye.
struct ProofView {
    SightOrigin origin;
    glm::dvec2 half_size{0.0};  ///< of the viewport  [pixels]
    double jitter = 0;          ///< [pixels]
    bool usable = true;         ///< false: nothing can be proved of such a view
    /// Left, right, bottom and top, widened by the jitter; far: no sight line from the eye comes back through one.
    std::vector<ViewPlane> sides;
    std::vector<ViewPlane> cuts;         ///< near plane and sections: what hides is cut by them, too
    std::vector<ViewPlane> of_question;  ///< these, and the window's

    ProofView(const View& view, const SightLines& sight)
        : half_size(0.5 * view.width, 0.5 * view.height), jitter(view.jitter) {
        const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
        const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
        const glm::dvec4 x = row(0), y = row(1), z = row(2), w = row(3);
        origin.eye = sight.eye();
        if (sight.orthographic()) {
            const glm::dvec3 along = glm::cross(glm::dvec3(x), glm::dvec3(y));
            origin.direction = glm::dot(along, glm::dvec3(z)) < 0 ? -along : along;
        }
        const glm::dvec4 wide = (1 + view.jitter / half_size.x) * w, high = (1 + view.jitter / half_size.y) * w;
        sides = {wide + x, wide - x, high + y, high - y};
        sides.push_back(w - z);
        cuts.push_back(w + z);
        const auto add = [&](const ViewPlanes& planes, std::vector<ViewPlane>& to) {
            for (const glm::dvec4& plane : planes.all())
                to.emplace_back(glm::dvec3(plane), plane.w + glm::dot(glm::dvec3(plane), origin.eye));
        };
        add(view.sections, cuts);
        of_question = cuts;
        add(view.window, of_question);
        usable = runsOutward(view) && isFinite() && seesFromEye(sight.orthographic(), x, y, w);
    }

    /// The sight line to a point: from where it is drawn, to there.
    SightRay rayTo(const glm::dvec3& point) const {
        SightRay ray;
        ray.direction = glm::normalize(origin.parallel() ? origin.direction : point);
        if (origin.parallel()) ray.origin = point - glm::dot(point, ray.direction) * ray.direction;
        ray.t_near = origin.parallel() ? -std::numeric_limits<double>::infinity() : 0;
        ray.t_far = glm::dot(point - ray.origin, ray.direction);
        for (const ViewPlane& plane : cuts) {
            const double slope = glm::dot(glm::dvec3(plane), ray.direction);
            if (slope > 0)
                ray.t_near = std::max(ray.t_near, -(glm::dot(glm::dvec3(plane), ray.origin) + plane.w) / slope);
        }
        return ray;
    }

    /// From the middle of the viewport, to the right and up.
    glm::dvec2 pixelOf(const glm::dvec3& point) const {
        const auto at = [&](const ViewPlane& plane) { return glm::dot(glm::dvec3(plane), point) + plane.w; };
        const double left = at(sides[0]), right = at(sides[1]), bottom = at(sides[2]), top = at(sides[3]);
        return (half_size + jitter) * glm::dvec2((left - right) / (left + right), (bottom - top) / (bottom + top));
    }

private:
    bool isFinite() const {
        std::vector<double> all = {origin.eye.x,       origin.eye.y,       origin.eye.z,
                                   origin.direction.x, origin.direction.y, origin.direction.z};
        for (const auto* list : {&sides, &of_question})
            for (const ViewPlane& plane : *list) all.insert(all.end(), {plane.x, plane.y, plane.z, plane.w});
        return std::all_of(all.begin(), all.end(), [](double value) { return std::isfinite(value); });
    }

    /// False if sight lines do not come from where the view says: a projection may move the eye.
    bool seesFromEye(bool is_parallel, const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& w) const {
        if (is_parallel) return origin.parallel();
        for (const glm::dvec4& row : {x, y, w})
            if (!(std::abs(row.w) <= 1e-9 * glm::length(glm::dvec3(row)))) return false;
        return true;
    }
};

namespace {

/// How large a triangle looks, or nearly: who hides most is asked first.
double sizeInSight(const ExactTriangle& triangle, const SightOrigin& origin) {
    const glm::dvec3 a = triangle.corners[0].about(), b = triangle.corners[1].about(), c = triangle.corners[2].about();
    const double size = origin.parallel()
                            ? glm::dot(glm::cross(b - a, c - a), origin.direction)
                            : glm::dot(a, glm::cross(b, c)) / (glm::length(a) * glm::length(b) * glm::length(c));
    return std::isfinite(size) ? std::abs(size) : 0;
}

}  // namespace

/// Numbers the planes that triangles lie in, exactly: what lies in a triangle's plane is not behind it. A plane may have two
/// numbers.
class ExactPlanes {
public:
    const ExactTriangle& operator[](uint32_t number) const { return planes_[number]; }

    /// Forgets all where memory would grow without end.
    void limit() {
        constexpr size_t kMost = 1 << 16;
        if (numbers_.size() > kMost) *this = {};
    }

    /// @param make  gives the triangle with this key, which is not seen from its edge
    template <class Make>
    uint32_t of(uint64_t key, Make&& make) {
        const auto [known, is_new] = numbers_.try_emplace(key, 0u);
        if (is_new) known->second = find(make());
        return known->second;
    }

private:
    static constexpr int kMostTries = 4;

    uint32_t find(const ExactTriangle& triangle) {
        const glm::dvec3 a = triangle.corners[0].about();
        const glm::dvec3 normal = glm::cross(triangle.corners[1].about() - a, triangle.corners[2].about() - a);
        const glm::dvec3 size = glm::abs(normal);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        // Where the plane meets an axis, and how it leans: rounding may part equal planes, which then have two numbers.
        const auto coarse = [](double value) { return std::bit_cast<uint32_t>(static_cast<float>(value) + 0.0f); };
        uint64_t hash = static_cast<uint64_t>(axis);
        for (int i = 1; i < 3; ++i) hash = mixSeed(hash, coarse(normal[(axis + i) % 3] / normal[axis]));
        hash = mixSeed(hash, coarse(glm::dot(normal, a) / normal[axis]));
        const auto [begin, end] = known_.equal_range(hash);
        int tries = kMostTries;  // planes that all but coincide are many in a stack of sheets
        for (auto at = begin; at != end && tries-- > 0; ++at)
            if (std::all_of(std::begin(triangle.corners), std::end(triangle.corners),
                            [&](const ExactCorner& corner) { return sideOf(planes_[at->second], corner) == 0; }))
                return at->second;
        const auto number = static_cast<uint32_t>(planes_.size());
        planes_.push_back(triangle);  // its corners know transforms of the scene, which stay
        known_.emplace(hash, number);
        return number;
    }

    std::unordered_map<uint64_t, uint32_t> numbers_;
    std::unordered_multimap<uint64_t, uint32_t> known_;
    std::vector<ExactTriangle> planes_;
};

struct CullProver::Impl {
    Impl(const SceneFacts& scene_facts, const View& view, uint64_t work, std::function<bool()> stop)
        : facts(scene_facts),
          sight(view),
          exact(facts, sight),
          planes(view, sight),
          most_work(work),
          asks_to_stop(std::move(stop)),
          pieces(planes.origin) {}

    CullProof prove(uint32_t which);
    CullProof proveBy(uint32_t which, const std::vector<uint32_t>& hiders_allowed);
    std::vector<uint8_t> hiddenTogether();

private:
    /// A triangle that hides, and the lines of its shadow in the part at hand.
    struct Hider {
        uint32_t object = 0, number = 0;
        ExactTriangle triangle;
        double size = 0;
        bool is_drawn = false, has_lines = false, hides = false;
        std::vector<uint32_t> lines;
        uint64_t key() const { return keyOf(object, number); }
    };

    static uint64_t keyOf(uint32_t of, uint32_t triangle) { return uint64_t{of} << 32 | triangle; }
    bool isFinite(uint32_t of, uint32_t triangle) const;
    ExactTriangle triangleOf(uint32_t of, uint32_t triangle) const;
    bool isDrawn(uint32_t of, uint32_t triangle, int facing) const;
    CullProof find(uint32_t which, const std::vector<uint32_t>* hiders_allowed);
    bool isStopped();
    void begin(uint32_t which, const std::vector<uint32_t>* hiders_allowed);
    double roundingOf(uint32_t of) const;
    bool isOutside() const;
    bool isBoxHidden(const glm::dmat4& transform, const Box3d& box, uint64_t most);
    void lookAtTriangle(uint32_t triangle);
    void beginPart(const ExactTriangle& frame);
    bool liesInPlaneOf(uint32_t hider, uint32_t triangle);
    bool clip(Piece& piece);
    template <class Open>
    bool cover(Piece whole, uint64_t end, Open&& open_at);
    bool take(Hider& hider, const Piece& piece);
    bool takeByRecent(const Piece& piece);
    bool takeBySearch(const Piece& piece, const glm::dvec3& at);
    void hasHidden(std::list<Hider>::iterator hider);
    double widthOf(const Piece& piece) const;

    const SceneFacts& facts;
    const SightLines sight;
    const ExactSight exact;
    const ProofView planes;
    const uint64_t most_work;
    const std::function<bool()> asks_to_stop;
    bool stopped = false;
    std::unordered_map<uint32_t, CullProof> of_equal;  ///< by the first of those that are equal

    uint32_t object = 0;                             ///< that is proved
    const std::vector<uint32_t>* allowed = nullptr;  ///< firstEqual() of each
    CullProof proof;
    int open = 0;
    std::list<Hider> hiders;  ///< that were met, the last that hid something first
    std::unordered_map<uint64_t, std::list<Hider>::iterator> known;

    ShadowPieces pieces;  ///< of the part at hand
    const ExactTriangle* part = nullptr;
    ExactPlanes exact_planes;
    std::unordered_map<uint32_t, bool> is_of_part;  ///< by plane: whether the part lies in it
    std::vector<Piece> left;
    std::vector<ExactSight::Met> met;
    std::vector<std::list<Hider>::iterator> asked;
};

/// One that is not is not drawn.
bool CullProver::Impl::isFinite(uint32_t of, uint32_t triangle) const {
    const Mesh& mesh = facts.mesh(of);
    for (size_t k = 0; k < 3; ++k) {
        const glm::vec3& p = mesh.positions[mesh.indices[3 * size_t{triangle} + k]];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
    }
    return true;
}

ExactTriangle CullProver::Impl::triangleOf(uint32_t of, uint32_t triangle) const {
    const Mesh& mesh = facts.mesh(of);
    ExactTriangle result;
    for (size_t k = 0; k < 3; ++k)
        result.corners[k] =
            ExactCorner(facts.scene().objects[of].transform,
                        glm::dvec3(mesh.positions[mesh.indices[3 * size_t{triangle} + k]]), planes.origin);
    result.findFacing(planes.origin);
    return result;
}

bool CullProver::Impl::isDrawn(uint32_t of, uint32_t triangle, int facing) const {
    if (facing == 0) return false;
    return facts.facts(of).double_sided[triangle] || (facing > 0) != mirrors(facts.scene().objects[of].transform);
}

// A part: a triangle, or a face of a box.

void CullProver::Impl::beginPart(const ExactTriangle& frame) {
    part = &frame;
    exact_planes.limit();
    is_of_part.clear();
    left.clear();
    known.clear();
    if (hiders.size() > kRecent) hiders.resize(kRecent);
    for (auto hider = hiders.begin(); hider != hiders.end(); ++hider) {
        hider->has_lines = false;
        known.emplace(hider->key(), hider);
    }
}

bool CullProver::Impl::clip(Piece& piece) {
    for (const auto* list : {&planes.sides, &planes.of_question})
        for (const ViewPlane& plane : *list)
            if (!pieces.clip(plane, piece)) return false;
    return true;
}

bool CullProver::Impl::take(Hider& hider, const Piece& piece) {
    ++proof.cuts;
    if (!hider.has_lines) {
        hider.has_lines = true;
        hider.hides = pieces.shadow(hider.triangle, planes.cuts, hider.lines);
    }
    return hider.hides && pieces.subtract(piece, hider.lines, left);
}

void CullProver::Impl::hasHidden(std::list<Hider>::iterator hider) {
    const auto place = std::lower_bound(proof.hiders.begin(), proof.hiders.end(), hider->object);
    if (place == proof.hiders.end() || *place != hider->object) proof.hiders.insert(place, hider->object);
    hiders.splice(hiders.begin(), hiders, hider);
}

bool CullProver::Impl::takeByRecent(const Piece& piece) {
    size_t tried = 0;
    for (auto hider = hiders.begin(); hider != hiders.end() && tried < kRecent; ++hider, ++tried)
        if (hider->is_drawn && take(*hider, piece)) {
            hasHidden(hider);
            return true;
        }
    return false;
}

/// Whether the part lies in the plane of a triangle, which then hides nothing of it: where many things coincide most do.
bool CullProver::Impl::liesInPlaneOf(uint32_t hider, uint32_t triangle) {
    const uint32_t plane = exact_planes.of(keyOf(hider, triangle), [&] { return triangleOf(hider, triangle); });
    const auto [known_of, is_new] = is_of_part.try_emplace(plane, false);
    if (is_new)
        known_of->second =
            std::all_of(std::begin(part->corners), std::end(part->corners),
                        [&](const ExactCorner& corner) { return sideOf(exact_planes[plane], corner) == 0; });
    return known_of->second;
}

/// By triangles that hide a place of the piece. All that were asked are kept: lines of the part name them.
bool CullProver::Impl::takeBySearch(const Piece& piece, const glm::dvec3& at) {
    exact.hidersOn(planes.rayTo(at), met);
    asked.clear();
    for (const ExactSight::Met& hit : met) {
        if (allowed && !std::binary_search(allowed->begin(), allowed->end(), hit.object)) continue;
        if (!isFinite(hit.object, hit.triangle)) continue;
        const uint64_t key = keyOf(hit.object, hit.triangle);
        if (liesInPlaneOf(hit.object, hit.triangle)) continue;
        const auto [place, is_new] = known.try_emplace(key, hiders.end());
        if (is_new) {
            Hider& hider = hiders.emplace_back();
            hider.object = hit.object;
            hider.number = hit.triangle;
            hider.triangle = triangleOf(hit.object, hit.triangle);
            hider.size = sizeInSight(hider.triangle, planes.origin);
            hider.is_drawn = isDrawn(hit.object, hit.triangle, hider.triangle.facing);
            place->second = std::prev(hiders.end());
        }
        if (place->second->is_drawn) asked.push_back(place->second);
    }
    std::sort(asked.begin(), asked.end(), [](const auto& a, const auto& b) { return a->size > b->size; });
    for (const auto& hider : asked) {
        if (isStopped()) return false;
        if (!take(*hider, piece)) continue;
        hasHidden(hider);
        return true;
    }
    return false;
}

double CullProver::Impl::widthOf(const Piece& piece) const {
    double area = 0, around = 0;
    const size_t count = piece.corners.size();
    const glm::dvec2 first = planes.pixelOf(pieces.cornerOf(piece, 0));
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec2 a = planes.pixelOf(pieces.cornerOf(piece, i)) - first;
        const glm::dvec2 b = planes.pixelOf(pieces.cornerOf(piece, (i + 1) % count)) - first;
        area += 0.5 * (a.x * b.y - a.y * b.x);
        around += glm::length(b - a);
    }
    return around > 0 ? 4 * std::abs(area) / around : 0;
}

/// Takes shadows from a part until nothing is left. Calls open_at(piece, place) where none hides; ends if that returns false,
/// or when `end` cuts have been made for the object.
/// @returns true if all was hidden
template <class Open>
bool CullProver::Impl::cover(Piece whole, uint64_t end, Open&& open_at) {
    bool all = true;
    left.push_back(std::move(whole));
    while (!left.empty()) {
        if (proof.cuts >= end || isStopped()) return false;
        const Piece piece = std::move(left.back());
        left.pop_back();
        if (takeByRecent(piece)) continue;
        const glm::dvec3 at = pieces.middle(piece);
        if (takeBySearch(piece, at)) continue;
        if (stopped) return false;
        all = false;
        if (!open_at(piece, at)) return false;
    }
    return all;
}

/// How far the box of an object in the world may be off, and what is computed of it here.
double CullProver::Impl::roundingOf(uint32_t of) const {
    const Box3d& box = facts.box(of);
    const glm::dvec3 far = glm::abs(planes.origin.eye) + glm::max(glm::abs(box.min), glm::abs(box.max));
    return exact.roundingOf(of) + 0x1p-48 * (far.x + far.y + far.z);
}

/// True if the object's box lies outside of the view: most objects do.
bool CullProver::Impl::isOutside() const {
    const Box3d& box = facts.box(object);
    const glm::dvec3 middle = box.center() - planes.origin.eye;
    const glm::dvec3 reach = 0.5 * box.size() + roundingOf(object);
    const Triple<Rounded> all{{middle.x, reach.x}, {middle.y, reach.y}, {middle.z, reach.z}};
    for (const auto* list : {&planes.sides, &planes.of_question})
        for (const ViewPlane& plane : *list)
            if ((dot(Triple<Rounded>{plane.x, plane.y, plane.z}, all) + plane.w).sign() == -1) return true;
    return false;
}

bool CullProver::Impl::isBoxHidden(const glm::dmat4& transform, const Box3d& box, uint64_t most) {
    ExactCorner corners[8];
    for (int i = 0; i < 8; ++i)
        corners[i] = ExactCorner(
            transform, {(i & 1 ? box.max : box.min).x, (i & 2 ? box.max : box.min).y, (i & 4 ? box.max : box.min).z},
            planes.origin);
    const auto beyond = [&](const ViewPlane& plane, int side) {
        return std::all_of(std::begin(corners), std::end(corners),
                           [&](const ExactCorner& corner) { return sideOf(plane, corner) * side > 0; });
    };
    for (const auto* list : {&planes.sides, &planes.of_question})
        for (const ViewPlane& plane : *list)
            if (beyond(plane, -1)) return true;
    // A sight line into the box passes its front in the view only if no plane cuts the front off.
    for (const ViewPlane& plane : planes.of_question)
        if (!beyond(plane, 1)) return false;

    bool has_front = false;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int at = side << axis, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, other = 1 << axis;
            ExactTriangle face{{corners[at], corners[at | u], corners[at | v]}};
            face.findFacing(planes.origin);
            if (face.facing == 0) continue;
            if (sideOf(face, corners[at ^ other]) == face.facing) continue;  // the eye is on the side of the rest
            has_front = true;
            beginPart(face);
            Piece whole = pieces.beginParallelogram(face);
            // Sight lines of a parallel view run along its sides but for rounding: there the whole face has to be hidden.
            if (!planes.origin.parallel() && !clip(whole)) continue;
            if (!cover(std::move(whole), std::min(most_work, proof.cuts + most),
                       [](const Piece&, const glm::dvec3&) { return false; }))
                return false;
        }
    return has_front;
}

void CullProver::Impl::lookAtTriangle(uint32_t triangle) {
    if (!isFinite(object, triangle)) return;
    const ExactTriangle face = triangleOf(object, triangle);
    if (!isDrawn(object, triangle, face.facing)) return;
    beginPart(face);
    Piece whole = pieces.begin(face);
    if (!clip(whole)) return;
    cover(std::move(whole), most_work, [&](const Piece& piece, const glm::dvec3& at) {
        ++open;
        const bool seen = exact.seesPointOn(planes.rayTo(at), object, triangle, at);
        const double width = widthOf(piece);
        if (seen || proof.result == ProofResult::kProved || width > proof.width) {
            proof.result = seen ? ProofResult::kSeen : ProofResult::kOpen;
            const glm::dvec2 pixel = planes.pixelOf(at);
            proof.x = planes.half_size.x + pixel.x;
            proof.y = planes.half_size.y - pixel.y;
            proof.width = width;
        }
        return !seen && open < kMostOpen;
    });
}

void CullProver::Impl::begin(uint32_t which, const std::vector<uint32_t>* hiders_allowed) {
    object = which;
    allowed = hiders_allowed;
    proof = {};
    open = 0;
    hiders.clear();
}

bool CullProver::Impl::isStopped() {
    stopped = stopped || (asks_to_stop && asks_to_stop());
    return stopped;
}

CullProof CullProver::Impl::prove(uint32_t which) {
    if (!facts.hasEqual(which)) return find(which, nullptr);
    const uint32_t first = facts.firstEqual(which);
    if (const auto known_proof = of_equal.find(first); known_proof != of_equal.end()) return known_proof->second;
    CullProof found = find(first, nullptr);
    if (!stopped) of_equal.emplace(first, found);
    return found;
}

CullProof CullProver::Impl::proveBy(uint32_t which, const std::vector<uint32_t>& hiders_allowed) {
    std::vector<uint32_t> first;
    for (const uint32_t hider : hiders_allowed) first.push_back(facts.firstEqual(hider));
    std::sort(first.begin(), first.end());
    return find(which, &first);
}

CullProof CullProver::Impl::find(uint32_t which, const std::vector<uint32_t>* hiders_allowed) {
    begin(which, hiders_allowed);
    const Mesh& mesh = facts.mesh(object);
    const bool nowhere = facts.box(object).empty() && mesh.triangles() > 0;  // its place is not known
    if (!planes.usable || nowhere) {
        proof.result = ProofResult::kUndecided;
        return proof;
    }
    const auto isDone = [&] {
        return isStopped() || proof.cuts >= most_work || proof.result == ProofResult::kSeen || open >= kMostOpen;
    };
    if (!facts.box(object).empty() && !isOutside()) {
        const glm::dmat4& transform = facts.scene().objects[object].transform;
        const bool many = mesh.triangles() > kFewTriangles;
        facts.facts(object).triangles(mesh).walk(
            [&](const Box3d& box) { return !isDone() && !(many && isBoxHidden(transform, box, kBoxWork)); },
            [&](uint32_t triangle) {
                if (!isDone()) lookAtTriangle(triangle);
            });
    }
    if (proof.result == ProofResult::kProved && (stopped || proof.cuts >= most_work))
        proof.result = ProofResult::kUndecided;
    if (proof.result != ProofResult::kProved) proof.hiders.clear();
    return std::move(proof);
}

std::vector<uint8_t> CullProver::Impl::hiddenTogether() {
    const size_t count = facts.scene().objects.size();
    std::vector<uint8_t> hidden(count, 0);
    if (!planes.usable) return hidden;
    double rounding = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (facts.box(i).empty()) continue;
        hidden[i] = 1;
        rounding = std::max(rounding, roundingOf(i));
    }
    const glm::dmat4 as_it_stands(1.0);
    begin(0, nullptr);
    facts.distinct().walk(
        [&](const Box3d& box) {
            proof.cuts = 0;
            return isStopped() || !isBoxHidden(as_it_stands, {box.min - rounding, box.max + rounding}, kGroupWork);
        },
        [&](uint32_t found) { hidden[found] = 0; });
    for (uint32_t i = 0; i < count; ++i) hidden[i] = hidden[facts.firstEqual(i)];
    return hidden;
}

CullProver::CullProver(const SceneFacts& facts, const View& view, uint64_t work, std::function<bool()> stop)
    : impl_(std::make_unique<Impl>(facts, view, work, std::move(stop))) {}
CullProver::~CullProver() = default;

CullProof CullProver::prove(uint32_t object) { return impl_->prove(object); }

std::vector<uint8_t> CullProver::hiddenTogether() { return impl_->hiddenTogether(); }

CullProof CullProver::proveBy(uint32_t object, const std::vector<uint32_t>& hiders) {
    return impl_->proveBy(object, hiders);
}

}  // namespace sightline::tools
