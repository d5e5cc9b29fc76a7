// What each occluder of a frame was worth: how many objects it hid, beside how many triangles it cost.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/credits.h"

#include <algorithm>

#include "sightline/base/assert.h"
#include "sightline/query/explain/asked_pixels.h"
#include "sightline/query/explain/attribution.h"

namespace sightline {

struct CreditBook::Impl {
    explicit Impl(Memory* from) : memory(from) {}

    Memory* const memory;
    Snapshot snapshot;
    detail::RecordedTraversal done{memory};
    detail::Attribution owners{memory};
    detail::AskedPixels asked{memory};
    Array<double> weight_before{memory};  ///< per place of the hierarchy: the sum over the places before it
    Array<Credit> of_instance{memory};
    Array<uint32_t> pixels{memory};  ///< per instance, of the rectangle at hand
    Array<uint32_t> met{memory};     ///< instances that have some
    Array<Credit> credits{memory};
    double unshared = 0;

    void weigh(std::span<const double> weights);
    double weightOf(const detail::TraversalRecord::Cull& cull) const;
    void share(const detail::TraversalRecord::Cull& cull);
    void shareVolume(const detail::TraversalRecord::Cull& cull);
    void gather();
};

void CreditBook::Impl::weigh(std::span<const double> weights) {
    if (!snapshot) return;
    const detail::SnapshotState& state = snapshot.state();
    SIGHTLINE_ASSERT(weights.empty() || weights.size() >= state.count);
    weight_before.assign(1, 0.0);
    weight_before.reserve(state.bvh.order.size() + 1);
    for (uint32_t place = 0; place < state.bvh.order.size(); ++place) {
        double weight = 0.0;
        if (state.bvh.order[place] != PlacedBvh::kNone) weight = weights.empty() ? 1.0 : weights[state.itemAt(place)];
        weight_before.push_back(weight_before.back() + weight);
    }
}

/// Of the objects within the view's layers.
double CreditBook::Impl::weightOf(const detail::TraversalRecord::Cull& cull) const {
    if (done.frame.every_layer)
        return weight_before[cull.places.first + cull.places.count] - weight_before[cull.places.first];
    double sum = 0;
    for (uint32_t place = cull.places.first; place < cull.places.first + cull.places.count; ++place)
        if (done.frame.countObjects({place})) sum += weight_before[place + 1] - weight_before[place];
    return sum;
}

/// Shares a culled range among the owners of its rectangle's pixels.
void CreditBook::Impl::share(const detail::TraversalRecord::Cull& cull) {
    uint32_t owned = 0;
    if (cull.look == detail::Look::kBox) asked.run(cull.rect);
    else asked.run(done, cull.places.first, cull.look, cull.boxed ? &cull.rect : nullptr);
    const PixelRect& rect = asked.rect;
    for (int32_t y = rect.y0; y <= rect.y1; ++y)
        for (int32_t x = rect.x0; x <= rect.x1; ++x) {
            if (asked.at(x, y) == detail::AskedPixels::kNotAsked) continue;
            const uint32_t instance = owners.at(x, y).hiderOf(asked.at(x, y));
            if (instance == detail::PixelOwner::kNone) continue;
            if (pixels[instance]++ == 0) met.push_back(instance);
            ++owned;
        }
    const double objects = static_cast<double>(done.frame.countObjects(cull.places)), weight = weightOf(cull);
    if (owned == 0) unshared += objects;
    for (const uint32_t instance : met) {
        const double part = static_cast<double>(pixels[instance]) / owned;
        of_instance[instance].hidden += part * objects;
        of_instance[instance].hidden_weight += part * weight;
        pixels[instance] = 0;
    }
    met.clear();
}

/// Gives a range that a volume culled to the volume's object, which need not have been drawn.
void CreditBook::Impl::shareVolume(const detail::TraversalRecord::Cull& cull) {
    const detail::SnapshotState& state = snapshot.state();
    const uint32_t item = state.itemAt(cull.hider);
    size_t at = 0;
    while (at < of_instance.size() && of_instance[at].item != item) ++at;
    if (at == of_instance.size()) {
        Credit& credit = of_instance.emplace_back();
        credit.item = item;
        credit.id = state.object(item).id;
    }
    of_instance[at].hidden += static_cast<double>(done.frame.countObjects(cull.places));
    of_instance[at].hidden_weight += weightOf(cull);
}

/// An instance that was not rasterized and hid nothing has no credit: it may have been offered and skipped.
void CreditBook::Impl::gather() {
    credits.clear();
    for (const Credit& credit : of_instance)
        if (credit.triangles > 0 || credit.hidden > 0) credits.push_back(credit);
    std::sort(credits.begin(), credits.end(), [](const Credit& a, const Credit& b) { return a.item < b.item; });
}

CreditBook::CreditBook(const Snapshot& now, std::span<const double> weights, Memory* memory)
    : impl_(makeOwned<Impl>(memory, memory)) {
    impl_->snapshot = now;
    impl_->weigh(weights);
}
CreditBook::~CreditBook() = default;
CreditBook::CreditBook(CreditBook&&) noexcept = default;
CreditBook& CreditBook::operator=(CreditBook&&) noexcept = default;

std::span<const Credit> CreditBook::credits(const View& view, const QuerySettings& settings) {
    Impl& impl = *impl_;
    impl.credits.clear();
    impl.unshared = 0;
    if (!impl.snapshot) return {};
    const detail::SnapshotState& state = impl.snapshot.state();
    impl.done.run(impl.snapshot, view, settings);
    const detail::TraversalRecord& record = impl.done.record;
    if (record.draws.empty() && impl.done.frame.volumes.empty()) return {};
    if (!record.draws.empty()) impl.owners.run(impl.done);
    impl.of_instance.assign(record.owners.size(), Credit());
    impl.pixels.assign(record.owners.size(), 0);
    for (size_t i = 0; i < record.owners.size(); ++i) {
        impl.of_instance[i].item = state.itemAt(record.owners[i]);
        impl.of_instance[i].id = state.object(impl.of_instance[i].item).id;
    }
    for (const detail::TraversalRecord::Draw& draw : record.draws)
        impl.of_instance[draw.instance].triangles += draw.triangles;
    for (const detail::TraversalRecord::Cull& cull : record.culls)
        if (cull.stage == Stage::kOcclusion) impl.share(cull);
        else if (cull.stage == Stage::kVolumes) impl.shareVolume(cull);
    impl.gather();
    return impl.credits;
}

double CreditBook::unshared() const { return impl_->unshared; }

}  // namespace sightline
