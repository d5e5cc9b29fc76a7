// The table of objects in a report: what each is called, how often it was kept, and what culled it in each frame.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/page_table.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

/// A key of the scene: its objects are [first, last) in the order by key.
struct KeyRange {
    size_t first = 0, last = 0;
    uint64_t triangles = 0, kept = 0;
};

size_t roomFor(size_t keys, size_t frames, size_t most, size_t most_cells) {
    return std::min({keys, most, std::max<size_t>(most_cells / std::max<size_t>(frames, 1), 1)});
}

std::vector<KeyRange> keyRanges(const Scene& scene, const std::vector<uint32_t>& order) {
    std::vector<KeyRange> ranges;
    for (size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || scene.objects[order[i]].key != scene.objects[order[i - 1]].key) ranges.push_back({i, i, 0, 0});
        ranges.back().last = i + 1;
        ranges.back().triangles += scene.meshes[scene.objects[order[i]].mesh].triangles();
    }
    return ranges;
}

}  // namespace

NamedObjects objectTable(const Scene& scene, const CullRun& run, size_t most, size_t most_cells) {
    const std::vector<uint32_t> order = orderByKey(scene);
    std::vector<KeyRange> ranges = keyRanges(scene, order);
    for (const FrameResult& frame : run.frames) {
        size_t at = 0;
        for (const uint64_t key : frame.visible) {
            while (at < ranges.size() && scene.objects[order[ranges[at].first]].key < key) ++at;
            if (at < ranges.size()) ++ranges[at].kept;
        }
    }
    const size_t room = roomFor(ranges.size(), run.frames.size(), most, most_cells);
    const auto matters = [&](const KeyRange& a, const KeyRange& b) {
        return std::tuple(b.kept, b.triangles, a.first) < std::tuple(a.kept, a.triangles, b.first);
    };
    std::partial_sort(ranges.begin(), ranges.begin() + static_cast<ptrdiff_t>(room), ranges.end(), matters);
    NamedObjects table;
    table.left_out = ranges.size() - room;
    ranges.resize(room);
    for (const KeyRange& range : ranges) {
        const SceneObject& object = scene.objects[order[range.first]];
        table.rows.push_back({object.key, oneLine(object.name, kLongestPath),
                              oneLine(objectPath(scene, object), kLongestPath), range.triangles, range.kept});
    }
    for (const FrameResult& frame : run.frames) {
        std::string digits;
        for (const KeyRange& range : ranges) {
            uint8_t finest = 0;
            bool visible = false;
            for (size_t i = range.first; i < range.last; ++i) {
                const uint8_t reason = order[i] < frame.reasons.size() ? frame.reasons[order[i]] : 1;
                visible |= reason == 0;
                finest = std::max(finest, reason);
            }
            const int reason = visible ? 0 : std::min<int>(finest, kStageCount);
            digits += static_cast<char>(reason < 10 ? '0' + reason : 'a' + (reason - 10));
        }
        table.stages.push_back(std::move(digits));
    }
    return table;
}

NamedObjects objectTable(const std::vector<KeyName>& names, const CullRun& run, size_t most, size_t most_cells) {
    std::vector<uint64_t> kept(names.size());
    const auto placeOf = [&](uint64_t key) {
        const auto found = std::lower_bound(names.begin(), names.end(), key,
                                            [](const KeyName& name, uint64_t wanted) { return name.key < wanted; });
        return found != names.end() && found->key == key ? static_cast<size_t>(found - names.begin()) : names.size();
    };
    for (const FrameResult& frame : run.frames)
        for (const uint64_t key : frame.visible)
            if (const size_t place = placeOf(key); place < kept.size()) ++kept[place];
    std::vector<size_t> order(names.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return kept[a] > kept[b]; });
    NamedObjects table;
    const size_t room = roomFor(names.size(), run.frames.size(), most, most_cells);
    table.left_out = names.size() - room;
    order.resize(room);
    for (const size_t i : order)
        table.rows.push_back(
            {names[i].key, oneLine(names[i].name, kLongestPath), oneLine(names[i].path, kLongestPath), 0, kept[i]});
    for (const FrameResult& frame : run.frames) {
        std::string digits;
        for (const size_t i : order)
            digits += std::binary_search(frame.visible.begin(), frame.visible.end(), names[i].key) ? '0' : '1';
        table.stages.push_back(std::move(digits));
    }
    return table;
}

}  // namespace sightline::tools
