// Writes and opens objects and their cells.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/object_section.h"

#include "sightline/base/bytes.h"

namespace sightline {
namespace {

constexpr uint64_t kObjectHeadBytes = 16;

}  // namespace

Result<Array<char>> objectSection(const ObjectPlaces& objects, uint32_t cells, Memory* memory) {
    const auto wrong = [](const char* what) { return Error{Error::Kind::kUsage, what}; };
    const size_t count = objects.size();
    if (objects.bounds.size() != count || objects.first_cell.size() != count + 1 ||
        objects.everywhere.size() != count || objects.wall.size() != count)
        return wrong("objects without bounds, cells or marks");
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    out.put(uint64_t{count});
    out.put(uint64_t{objects.cells.size()});
    for (const uint64_t key : objects.keys) out.put(key);
    for (const Box3d& box : objects.bounds)
        for (const glm::dvec3& corner : {box.min, box.max})
            for (int axis = 0; axis < 3; ++axis) out.put(corner[axis]);
    for (size_t i = 0; i < count; ++i) out.put(objects.first_cell[i + 1]);
    for (size_t i = 0; i < count; ++i) out.put(static_cast<uint8_t>(objects.everywhere[i] + 2 * objects.wall[i]));
    bytes.resize((bytes.size() + 3) / 4 * 4);
    for (const uint32_t cell : objects.cells) out.put(cell);
    if (const Result<PlacedObjects> opened = PlacedObjects::open(bytes, cells, "objects"); !opened)
        return wrong(opened.error().message.c_str());
    return bytes;
}

Result<PlacedObjects> PlacedObjects::open(std::span<const char> bytes, uint32_t cells, std::string_view file,
                                          uint64_t at) {
    if (bytes.size() < kObjectHeadBytes) return faultAt(file, "objects that end within their head", at + bytes.size());
    ByteCursor head(bytes);
    const uint64_t count = head.take<uint64_t>(), places = head.take<uint64_t>();
    PlacedParts parts(bytes.subspan(kObjectHeadBytes));
    PlacedObjects out;
    out.keys_ = parts.take<uint64_t>(count);
    const std::span<const char> boxes = parts.take(count, 6 * sizeof(double));
    out.bounds_ = PlacedNumbers<double>(boxes);
    out.ends_ = parts.take<uint64_t>(count);
    out.marks_ = parts.take<uint8_t>(count);
    const std::span<const char> gap = parts.take((4 - parts.at() % 4) % 4, 1);
    out.cells_ = parts.take(places, sizeof(uint32_t));
    if (!parts.fits()) return faultAt(file, "objects that are not as long as they say", at);
    for (const char zero : gap)
        if (zero != 0) return faultAt(file, "a mark that is not known", at);
    const PlacedNumbers<uint32_t> all(out.cells_);
    uint64_t begin = 0;
    for (size_t i = 0; i < count; ++i) {
        const uint64_t end = out.ends_[i];
        if (i > 0 && out.keys_[i] < out.keys_[i - 1])
            return faultAt(file, "keys that do not rise", at + kObjectHeadBytes + 8 * uint64_t{i});
        if (const Box3d box = out.bounds(i); box.empty() || !box.finite())
            return faultAt(file, "an object without bounds", at + kObjectHeadBytes + 8 * count + 48 * uint64_t{i});
        if (end < begin || end > places)
            return faultAt(file, "an object whose cells end before they begin", at + kObjectHeadBytes);
        if (out.marks_[i] > 3) return faultAt(file, "a mark that is not known", at + kObjectHeadBytes + 64 * count + i);
        if (begin == end && !out.seenFromEverywhere(i))
            return faultAt(file, "an object in no cell", at + kObjectHeadBytes);
        for (uint64_t k = begin; k < end; ++k)
            if (all[k] >= cells || (k > begin && all[k] <= all[k - 1]))
                return faultAt(file, "an object in a cell that there is not, or twice in one", at);
        begin = end;
    }
    if (begin != places) return faultAt(file, "cells of no object", at + 8);
    return out;
}

Box3d PlacedObjects::bounds(size_t i) const {
    const size_t at = 6 * i;
    return {{bounds_[at], bounds_[at + 1], bounds_[at + 2]}, {bounds_[at + 3], bounds_[at + 4], bounds_[at + 5]}};
}

PlacedNumbers<uint32_t> PlacedObjects::cells(size_t i) const {
    const uint64_t begin = i == 0 ? 0 : ends_[i - 1];
    return PlacedNumbers<uint32_t>(cells_.subspan(4 * begin, 4 * (ends_[i] - begin)));
}

std::pair<size_t, size_t> PlacedObjects::find(uint64_t key) const {
    const auto firstNot = [&](auto&& before) {
        size_t low = 0, high = size();
        while (low < high) {
            const size_t middle = low + (high - low) / 2;
            if (before(keys_[middle])) low = middle + 1;
            else high = middle;
        }
        return low;
    };
    return {firstNot([&](uint64_t k) { return k < key; }), firstNot([&](uint64_t k) { return k <= key; })};
}

}  // namespace sightline
