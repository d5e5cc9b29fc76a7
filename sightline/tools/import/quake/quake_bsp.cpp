// Compiled maps of the Quake family: their leaves and trees, and the order in which their lumps are read.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_bsp.h"

#include <algorithm>
#include <cmath>

#include "sightline/tools/import/quake/quake_lumps.h"

namespace sightline::tools::quake {
namespace {

constexpr size_t kSmallBox = 12, kWideBox = 24;  // [bytes]

/// Unknown contents are open: what is taken for open hides nothing.
LeafContents quakeContents(int32_t contents) {
    if (contents == -2) return LeafContents::kSolid;
    if (contents == -6) return LeafContents::kSky;
    if (contents <= -3 && contents >= -5) return LeafContents::kLiquid;
    if (contents <= -9 && contents >= -15) return LeafContents::kLiquid;  // Half-Life: currents, translucent
    return LeafContents::kEmpty;
}

LeafContents quake2Contents(uint32_t contents) {
    constexpr uint32_t kSolid = 1, kWindow = 2, kLava = 8, kSlime = 16, kWater = 32, kMist = 64;
    if (contents & kSolid) return LeafContents::kSolid;
    return contents & (kWindow | kLava | kSlime | kWater | kMist) ? LeafContents::kLiquid : LeafContents::kEmpty;
}

struct Leaf {
    LeafContents contents = LeafContents::kEmpty;
    int32_t row = -1;      ///< Quake, Half-Life
    int32_t cluster = -1;  ///< Quake 2 and 3
    QuakeLeafFaces faces;
};

Leaf takeLeaf(QuakeFormat format, ByteCursor cursor) {
    const auto skip = [&](size_t bytes) {
        for (; bytes > 0; bytes -= 4) cursor.take<uint32_t>();
    };
    Leaf out;
    if (format == QuakeFormat::kQuake3) {
        out.cluster = cursor.take<int32_t>();
        out.contents = out.cluster < 0 ? LeafContents::kSolid : LeafContents::kEmpty;
        skip(4 + kWideBox);
        out.faces.first = cursor.take<uint32_t>();
        out.faces.count = cursor.take<uint32_t>();
    } else if (format == QuakeFormat::kQuake2) {
        out.contents = quake2Contents(cursor.take<uint32_t>());
        out.cluster = cursor.take<int16_t>();
        cursor.take<int16_t>();  // its area
        skip(kSmallBox);
        out.faces.first = cursor.take<uint16_t>();
        out.faces.count = cursor.take<uint16_t>();
    } else {
        const bool wide = format == QuakeFormat::kBsp2 || format == QuakeFormat::kPsb2;
        out.contents = quakeContents(cursor.take<int32_t>());
        out.row = cursor.take<int32_t>();
        skip(format == QuakeFormat::kBsp2 ? kWideBox : kSmallBox);
        out.faces.first = wide ? cursor.take<uint32_t>() : cursor.take<uint16_t>();
        out.faces.count = wide ? cursor.take<uint32_t>() : cursor.take<uint16_t>();
    }
    return out;
}

/// How many leaves behind leaf 0 are the world's.
uint32_t worldLeaves(Bytes bytes, const Directory& directory, uint32_t leaves) {
    constexpr size_t kVisibleLeaves = 52;
    const Records models = lumpRecords(bytes, directory, Lump::kModels);
    const auto count = models.record(0, kVisibleLeaves).take<uint32_t>();
    if (count >= leaves) fail(at("models", 0), "{} leaves of the world of {}", count, leaves - 1);
    return count;
}

/// A child as LeafTreeNode has it, by what stands in the file.
uint32_t childOf(QuakeFormat format, ByteCursor& cursor, const Records& nodes, uint32_t leaves, uint32_t node) {
    int64_t child = 0;
    if (format == QuakeFormat::kQuake || format == QuakeFormat::kHalfLife) {
        child = cursor.take<uint16_t>();  // maps of more than 32767 nodes use the sign's bit
        if (child >= nodes.count()) child -= 65536;
    } else {
        child = cursor.take<int32_t>();
    }
    if (child >= 0) return nodes.checked(static_cast<uint64_t>(child), "nodes", node);
    const auto leaf = static_cast<uint64_t>(-1 - child);
    if (leaf >= leaves) fail(at("nodes", node), "leaf {} of {}", leaf, leaves);
    return LeafTreeNode::kLeaf | static_cast<uint32_t>(leaf);
}

glm::dvec4 planeOf(const Records& planes, uint64_t index, uint32_t node) {
    const uint32_t plane = planes.checked(index, "nodes", node);
    ByteCursor cursor = planes.record(plane);
    const glm::dvec3 normal = takePoint(cursor, "planes", plane);
    const double distance = cursor.take<float>(), length = glm::length(normal);
    if (!(std::abs(distance) <= 1e9)) fail(at("planes", plane), "a number that is not finite or beyond 1e9");
    if (!(length > 1e-3)) fail(at("planes", plane), "it has no direction");
    const glm::dvec4 out(normal, -distance);
    return std::abs(length - 1) < 1e-4 ? out : out / length;
}

uint32_t rootOf(Bytes bytes, const Directory& directory, const Records& nodes) {
    constexpr size_t kRoot = 36;
    if (directory.format == QuakeFormat::kQuake3) return nodes.checked(0, "models", 0);
    const Records models = lumpRecords(bytes, directory, Lump::kModels);
    return nodes.checked(models.record(0, kRoot).take<uint32_t>(), "models", 0);
}

/// Fills contents, cluster_of_leaf, faces_of_leaf, leaf_faces and, of Quake and Half-Life, row_offsets; needs faces.
void readLeaves(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    const Records leaves = lumpRecords(bytes, directory, Lump::kLeaves);
    const Records marks = lumpRecords(bytes, directory, Lump::kLeafFaces);
    const bool narrow = directory.format == QuakeFormat::kQuake || directory.format == QuakeFormat::kHalfLife ||
                        directory.format == QuakeFormat::kQuake2;
    for (uint32_t i = 0; i < marks.count(); ++i) {
        ByteCursor mark = marks.record(i);
        const uint32_t face = narrow ? mark.take<uint16_t>() : mark.take<uint32_t>();
        if (face >= map.faces.size()) fail(at("leaf faces", i), "face {} of {}", face, map.faces.size());
        map.leaf_faces.push_back(face);
    }

    if (leaves.count() == 0) fail("", "has no leaves");
    const bool by_leaf = directory.format != QuakeFormat::kQuake2 && directory.format != QuakeFormat::kQuake3;
    if (by_leaf) map.clusters = worldLeaves(bytes, directory, leaves.count());
    for (uint32_t i = 0; i < leaves.count(); ++i) {
        const Leaf leaf = takeLeaf(directory.format, leaves.record(i));
        if (uint64_t(leaf.faces.first) + leaf.faces.count > marks.count() && leaf.faces.count > 0)
            fail(at("leaves", i), "faces {} to {} of {}", leaf.faces.first,
                 uint64_t(leaf.faces.first) + leaf.faces.count, marks.count());
        map.tree.contents.push_back(leaf.contents);
        map.faces_of_leaf.push_back(leaf.faces.count > 0 ? leaf.faces : QuakeLeafFaces());
        uint32_t cluster = QuakeMapFile::kNoCluster;
        if (by_leaf && i >= 1 && i <= map.clusters) {
            cluster = i - 1;
            map.row_offsets.push_back(leaf.row);
        } else if (!by_leaf && leaf.cluster >= 0) {
            cluster = static_cast<uint32_t>(leaf.cluster);
            if (cluster >= leaves.count()) fail(at("leaves", i), "cluster {} of at most {}", cluster, leaves.count());
            map.clusters = std::max(map.clusters, cluster + 1);
        }
        map.cluster_of_leaf.push_back(cluster);
    }
}

/// Fills the tree's nodes: those below the world's root, parents before children; needs contents.
void readTree(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    const Records nodes = lumpRecords(bytes, directory, Lump::kNodes);
    const Records planes = lumpRecords(bytes, directory, Lump::kPlanes);
    const auto leaves = static_cast<uint32_t>(map.tree.contents.size());
    std::vector<bool> seen(nodes.count()), seen_leaf(leaves);
    struct Pending {
        uint32_t node, parent, side, depth;
    };
    std::vector<Pending> pending = {{rootOf(bytes, directory, nodes), 0, 0, 1}};
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        if (seen[next.node]) fail(at("nodes", next.node), "hangs in the tree twice");
        if (next.depth > QuakeMapFile::kDeepest)
            fail(at("nodes", next.node), "lies deeper than {}", QuakeMapFile::kDeepest);
        seen[next.node] = true;
        const auto number = static_cast<uint32_t>(map.tree.nodes.size());
        if (number > 0) map.tree.nodes[next.parent].child[next.side] = number;
        ByteCursor record = nodes.record(next.node);
        LeafTreeNode& node = map.tree.nodes.emplace_back();
        node.plane = planeOf(planes, record.take<uint32_t>(), next.node);
        for (const uint32_t side : {1u, 0u}) {  // the file has the front one first
            const uint32_t child = childOf(directory.format, record, nodes, leaves, next.node);
            node.child[side] = child;
            if (child < LeafTreeNode::kLeaf) {
                pending.push_back({child, number, side, next.depth + 1});
                continue;
            }
            const uint32_t leaf = child - LeafTreeNode::kLeaf;
            if (seen_leaf[leaf] && map.tree.contents[leaf] != LeafContents::kSolid)
                fail(at("leaves", leaf), "is open, and hangs in the tree twice");
            seen_leaf[leaf] = true;
        }
    }
}

}  // namespace
}  // namespace sightline::tools::quake

namespace sightline::tools {
namespace {

/// Quake 2 and 3: the lump begins with the number of clusters, and has room for what each must have there.
void countClusters(quake::Bytes lump, QuakeMapFile& map) {
    if (lump.empty()) return;
    const bool second = map.format == QuakeFormat::kQuake2;
    ByteCursor cursor({reinterpret_cast<const char*>(lump.data()), lump.size()});
    const auto count = cursor.take<uint32_t>();
    if (count < map.clusters) quake::fail("", "its visibility lump is of {} clusters, not {}", count, map.clusters);
    const uint64_t each = second ? 8 : cursor.take<uint32_t>();
    const bool whole = second ? cursor.left() / 8 >= count
                              : each * 8 >= count && (count == 0 || cursor.left() / count >= each) && lump.size() >= 8;
    if (!whole) quake::fail("", "its visibility lump has {} bytes, too few for {} clusters", lump.size(), count);
    map.clusters = count;
}

QuakeMapFile readMap(quake::Bytes bytes) {
    using namespace quake;
    const Directory directory = readDirectory(bytes);
    QuakeMapFile map;
    map.format = directory.format;
    readFaces(bytes, directory, map);
    quake::readLeaves(bytes, directory, map);
    readTree(bytes, directory, map);
    const Bytes text = lumpBytes(bytes, directory, Lump::kEntities);
    map.entities.assign(text.begin(), text.end());
    if (const size_t end = map.entities.find('\0'); end != std::string::npos) map.entities.resize(end);
    const Bytes visibility = lumpBytes(bytes, directory, Lump::kVisibility);
    map.visibility.assign(visibility.begin(), visibility.end());
    if (map.format == QuakeFormat::kQuake2 || map.format == QuakeFormat::kQuake3) countClusters(visibility, map);
    return map;
}

}  // namespace

uint32_t leafAt(const LeafTree& tree, const glm::dvec3& point) {
    uint32_t at = tree.nodes.empty() ? LeafTreeNode::kLeaf : 0;
    while (at < LeafTreeNode::kLeaf) {
        const LeafTreeNode& node = tree.nodes[at];
        at = node.child[glm::dot(glm::dvec3(node.plane), point) + node.plane.w >= 0];
    }
    return at - LeafTreeNode::kLeaf;
}

Result<QuakeMapFile> parseQuakeBsp(std::span<const unsigned char> bytes, const std::string& name) {
    try {
        return readMap(bytes);
    } catch (const quake::Fault& fault) { return Error{Error::Kind::kInput, name + ": " + fault.message}; }
}

}  // namespace sightline::tools
