// What leaving objects out costs: the pixels of a frame that show another object without them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/changed_pixels.h"

#include <algorithm>
#include <map>

#include "sightline/base/assert.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/truth/id_buffer.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::tools {
using namespace studies;
namespace {

constexpr uint64_t kBandSamples = 1u << 24;  // drawn at once: 12 bytes each

/// One band of an image as the objects that it shows, with what hides nothing as it is, and as if it hid.
struct Band {
    std::vector<uint32_t> plain, solid;  ///< DrawItem::id; `solid` is empty where it is the same
};

Band drawBand(std::vector<DrawItem> items, const View& view, const ZBufferSettings& pass) {
    Band band;
    band.plain = renderZBuffer(items, view, pass).id;
    const auto see_through = [](const DrawItem& item) { return !item.writes_depth.empty(); };
    if (std::none_of(items.begin(), items.end(), see_through)) return band;
    for (DrawItem& item : items) item.writes_depth = {};
    band.solid = renderZBuffer(items, view, pass).id;
    return band;
}

uint64_t countChanges(const Band& a, const Band& b, std::span<uint64_t> shown) {
    uint64_t changed = 0;
    const std::vector<uint32_t>& solid_a = a.solid.empty() ? a.plain : a.solid;
    const std::vector<uint32_t>& solid_b = b.solid.empty() ? b.plain : b.solid;
    for (size_t i = 0; i < a.plain.size(); ++i) {
        const bool solid = solid_a[i] != solid_b[i];
        if (!solid && a.plain[i] == b.plain[i]) continue;
        ++changed;
        // As if all hid, a pixel shows what was left out itself; as they are, perhaps what lies behind it.
        if (const uint32_t object = solid ? solid_a[i] : a.plain[i]; object < shown.size()) ++shown[object];
    }
    return changed;
}

/// What DrawItem wants to know of the triangles of a level.
struct LodFacts {
    std::vector<uint8_t> double_sided, hides;
};

LodFacts factsOf(const Scene& scene, const Mesh& mesh, const MeshLod& lod) {
    LodFacts facts;
    facts.double_sided.assign(lod.indices.size() / 3, 0);
    facts.hides.assign(lod.indices.size() / 3, mesh.deforms ? 0 : 1);
    for (const Primitive& primitive : lod.primitives) {
        const Material& material = scene.materials[primitive.material];
        for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
            facts.double_sided[t] = material.double_sided;
            if (!material.hides()) facts.hides[t] = 0;
        }
    }
    return facts;
}

/// Draws items by coarser levels.
class CoarseItems {
public:
    CoarseItems(const SceneFacts& facts, std::span<const uint8_t> lods) : facts_(facts), lods_(lods) {}

    bool any() const {
        return std::any_of(lods_.begin(), lods_.end(), [](uint8_t level) { return level > 0; });
    }
    void apply(std::vector<DrawItem>& items) {
        for (DrawItem& item : items) {
            if (lods_.empty() || lods_[item.id] == 0) continue;
            const uint8_t level = lods_[item.id];
            const Mesh& mesh = facts_.mesh(item.id);
            const MeshLod& lod = mesh.lods[level - 1u];
            const auto [at, is_new] = known_.try_emplace(&lod);
            if (is_new) at->second = factsOf(facts_.scene(), mesh, lod);
            item.mesh.indices = lod.indices;
            item.double_sided = at->second.double_sided;
            if (!item.writes_depth.empty()) item.writes_depth = at->second.hides;
        }
    }

private:
    const SceneFacts& facts_;
    std::span<const uint8_t> lods_;
    std::map<const MeshLod*, LodFacts> known_;
};

}  // namespace

uint64_t countChangedPixels(const SceneFacts& facts, const View& view, std::span<const Drawn> drawn,
                            std::span<const uint8_t> lods, std::span<uint64_t> shown) {
    SIGHTLINE_ASSERT(drawn.size() == facts.scene().objects.size());
    SIGHTLINE_ASSERT(lods.empty() || lods.size() == drawn.size());
    SIGHTLINE_ASSERT(shown.empty() || shown.size() == drawn.size());
    std::fill(shown.begin(), shown.end(), uint64_t{0});
    CoarseItems coarse(facts, lods);
    const SightLines sight(view);
    std::vector<uint32_t> full, kept;
    for (uint32_t object = 0; object < drawn.size(); ++object) {
        // Boxes are of the finest levels; a coarser one may reach farther.
        const bool is_coarse = !lods.empty() && lods[object] > 0;
        if (drawn[object] == Drawn::kNever || !(is_coarse || sight.touches(facts.box(object)))) continue;
        full.push_back(object);
        if (drawn[object] == Drawn::kAlways) kept.push_back(object);
    }
    if (full.size() == kept.size() && !coarse.any()) return 0;
    std::vector<DrawItem> all = drawItems(facts, full), some = drawItems(facts, kept);
    for (size_t i = 0; i < all.size(); ++i) all[i].id = full[i];
    for (size_t i = 0; i < some.size(); ++i) some[i].id = kept[i];
    coarse.apply(some);
    ZBufferSettings pass;
    pass.want_generated = false;
    pass.row_count = static_cast<uint32_t>(std::clamp<uint64_t>(kBandSamples / view.width, 1, view.height));
    uint64_t changed = 0;
    for (uint64_t row = 0; row < view.height; row += pass.row_count) {
        pass.first_row = static_cast<uint32_t>(row);
        changed += countChanges(drawBand(all, view, pass), drawBand(some, view, pass), shown);
    }
    return changed;
}

}  // namespace sightline::tools
