// Records what a query was asked and what it answered.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/frame_recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "sightline/geom/setting_rows.h"
#include "sightline/query/record/frame_replay.h"
#include "sightline/world/world_state.h"

namespace sightline {
namespace {

/// Whether an object is no part of a recording, by what became of it.
bool isLeftOut(uint8_t reason) {
    const auto by = [&](Stage stage) { return reason == 1 + static_cast<uint8_t>(stage); };
    return reason == 255 || by(Stage::kFrustum) || by(Stage::kFacing) || by(Stage::kPvs) || by(Stage::kPortals);
}

/// Settings within their limits; what is not a number is as it is by default.
QuerySettings limited(QuerySettings settings) {
    forEachSetting([&](const auto& row) {
        auto& value = settings.*row.member;
        using Value = std::remove_reference_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, double>) {
            if (std::isnan(value)) value = row.standard();
            const bool endless = row.most >= 1e300 && value > row.most;
            value = endless ? std::numeric_limits<double>::infinity() : std::clamp(value, row.least, row.most);
        } else {
            value = static_cast<Value>(std::clamp(static_cast<double>(value), row.least, row.most));
        }
    });
    return settings;
}

/// Gives what objects share new numbers, in the order of meeting.
class Numbers {
public:
    explicit Numbers(Memory* memory) : of_(memory) {}

    /// @returns the number from 1 on; 0 for null
    /// @param meet  called for one that has not been met
    template <class Meet>
    uint32_t of(uint32_t index, Meet meet) {
        if (index == 0) return 0;
        if (index >= of_.size()) of_.resize(index + size_t{1}, 0);
        if (of_[index] == 0) {
            of_[index] = ++count_;
            meet();
        }
        return of_[index];
    }

private:
    Array<uint32_t> of_;
    uint32_t count_ = 0;
};

class Recorder {
public:
    Recorder(const detail::SnapshotState& state, FrameRecording& out, Memory* memory)
        : state_(state), out_(out), memory_(memory), forms_(memory), chains_(memory), index_(memory) {}

    /// @param reasons  per item of the snapshot
    void run(std::span<const uint8_t> reasons, const Query& answered) {
        index_.assign(reasons.size(), kNone);
        for (uint32_t item = 0; item < reasons.size(); ++item)
            if (!isLeftOut(reasons[item])) index_[item] = kWanted;
        findCertificates(reasons, answered);
        for (uint32_t item = 0; item < reasons.size(); ++item)
            if (index_[item] == kWanted) add(item, reasons[item]);
        for (FrameRecording::Certificate& certificate : out_.certificates)
            certificate.hidden = index_[certificate.hidden];
        for (uint32_t& named : out_.named) named = index_[named];
    }

private:
    static constexpr uint32_t kNone = ~0u, kWanted = ~1u;

    /// By items, and the objects that they name are wanted, too.
    void findCertificates(std::span<const uint8_t> reasons, const Query& answered) {
        Array<Visible> named(memory_);
        for (uint32_t item = 0; item < reasons.size(); ++item) {
            if (isLeftOut(reasons[item]) || reasons[item] == 0) continue;
            if (!answered.certificateOf(state_.object(item).id, named)) continue;
            const auto first = static_cast<uint32_t>(out_.named.size());
            for (const Visible& hider : named) out_.named.push_back(state_.itemOf(state_.find(hider.id)));
            std::sort(out_.named.begin() + first, out_.named.end());
            for (const uint32_t hider : std::span(out_.named).subspan(first)) index_[hider] = kWanted;
            out_.certificates.push_back({item, first, static_cast<uint32_t>(named.size())});
        }
    }

    void add(uint32_t item, uint8_t reason) {
        const detail::ObjectRecord& from = state_.object(item);
        index_[item] = static_cast<uint32_t>(out_.objects.size());
        ObjectDef& to = out_.objects.emplace_back();
        to.bounds = from.bounds;
        to.transform = from.transform;
        to.key = from.key;
        to.layers = from.layers;
        to.occluder = form(from.occluder);
        to.shape = form(from.shape);
        to.limits = from.limits;
        to.lods = chain(from.lods);
        to.hides_in_lods = from.hides_in_lods;
        out_.reasons.push_back(reason);
    }
    OccluderId form(OccluderId id) {
        return {forms_.of(id.index, [&] {
            const detail::HeldOccluder& held = *state_.occluders[id.index];
            FrameRecording::Form& to = out_.forms.emplace_back(memory_);
            to.occluder = held;
            to.inner.reserve(held.inner.size());
            for (const InnerOccluder& inner : held.inner) {
                InnerOccluder& copy = to.inner.emplace_back(memory_);
                copy.occluder = inner.occluder;
                copy.outside = inner.outside;
                copy.error = inner.error;
            }
        })};
    }
    LodsId chain(LodsId id) {
        if (id.index == 0 || state_.lods[id.index]->levels.empty()) return {};  // it has one level
        return {chains_.of(id.index, [&] { out_.chains.push_back(state_.lods[id.index]->levels); })};
    }

    const detail::SnapshotState& state_;
    FrameRecording& out_;
    Memory* memory_;
    Numbers forms_, chains_;
    Array<uint32_t> index_;  ///< per item: of the recorded object
};

}  // namespace

Result<FrameRecording> recordFrame(const Query& answered, Memory* memory) {
    const auto [now, view, settings] = answered.asked();
    if (!isUsable(view)) return Error{Error::Kind::kUsage, "the view cannot be used, so nothing was asked"};
    FrameRecording out(memory);
    out.view = view;
    out.settings = limited(settings);
    if (!now) return out;
    out.volumes = now.state().volumes;
    Array<uint8_t> reasons(now.objectCount(), 0, memory);
    answered.reasons(reasons, kLeftEye);
    Recorder(now.state(), out, memory).run(reasons, answered);
    FrameReplay replay(out, memory);
    replay.run();
    out.again.assign(replay.reasons().begin(), replay.reasons().end());
    return out;
}

Result<FrameRecording> recordFrame(const Snapshot& now, const View& view, const QuerySettings& settings,
                                   Memory* memory) {
    Query query(memory);
    query.visible(now, view, settings);
    return recordFrame(query, memory);
}

}  // namespace sightline
