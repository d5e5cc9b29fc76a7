// Writes and opens a tree of planes.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/tree_section.h"

#include <cmath>

#include "sightline/base/bytes.h"

namespace sightline {
namespace {

constexpr uint64_t kNodeBytes = 40, kBoundsAt = 8, kNodesAt = 56;

bool hasDirection(const glm::dvec4& plane) {
    const double length = glm::length(glm::dvec3(plane));
    return std::isfinite(plane.w) && std::isfinite(length) && length > 0;
}

}  // namespace

Result<Array<char>> treeSection(const LeafTree& tree, Memory* memory) {
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    out.put(static_cast<uint32_t>(tree.nodes.size()));
    out.put(static_cast<uint32_t>(tree.contents.size()));
    for (const glm::dvec3& corner : {tree.bounds.min, tree.bounds.max})
        for (int axis = 0; axis < 3; ++axis) out.put(corner[axis]);
    for (const LeafTreeNode& node : tree.nodes) {
        for (int k = 0; k < 4; ++k) out.put(node.plane[k]);
        for (const uint32_t child : node.child) out.put(child);
    }
    for (const LeafContents contents : tree.contents) out.put(static_cast<uint8_t>(contents));
    if (const Result<PlacedTree> opened = PlacedTree::open(bytes, "tree", 0, memory); !opened)
        return Error{Error::Kind::kUsage, opened.error().message};
    return bytes;
}

LeafTreeNode PlacedTree::node(uint32_t i) const {
    ByteCursor from(node_bytes_.subspan(kNodeBytes * i, kNodeBytes));
    LeafTreeNode out;
    for (int k = 0; k < 4; ++k) out.plane[k] = from.take<double>();
    for (uint32_t& child : out.child) child = from.take<uint32_t>();
    return out;
}

Result<PlacedTree> PlacedTree::open(std::span<const char> bytes, std::string_view file, uint64_t at, Memory* memory) {
    if (bytes.size() < kNodesAt) return faultAt(file, "a tree that ends within its head", at + bytes.size());
    PlacedTree out;
    ByteCursor head(bytes);
    out.nodes_ = head.take<uint32_t>();
    out.leaves_ = head.take<uint32_t>();
    PlacedParts parts(bytes.subspan(kBoundsAt));
    out.bounds_ = parts.take<double>(6);
    out.node_bytes_ = parts.take(out.nodes_, kNodeBytes);
    out.contents_ = parts.take<uint8_t>(out.leaves_);
    if (!parts.fits()) return faultAt(file, "a tree that is not as long as it says", at);
    if (out.leaves_ == 0 || out.leaves_ >= LeafTreeNode::kLeaf || out.nodes_ >= LeafTreeNode::kLeaf)
        return faultAt(file, "a tree without leaves, or with more than there may be", at);
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(out.bounds_[axis]) || !std::isfinite(out.bounds_[axis + 3]) ||
            out.bounds_[axis] > out.bounds_[axis + 3])
            return faultAt(file, "a tree without bounds", at + kBoundsAt);
    for (uint32_t i = 0; i < out.leaves_; ++i)
        if (out.contents_[i] > static_cast<uint8_t>(LeafContents::kSolid))
            return faultAt(file, "a leaf of contents that are not known", at + kNodesAt + kNodeBytes * out.nodes_ + i);
    Array<uint16_t> above(out.nodes_, 0, memory);  // nodes above each, and one; 0: none names it as a child
    if (!above.empty()) above[0] = 1;
    for (uint32_t i = 0; i < out.nodes_; ++i) {
        const uint64_t where = at + kNodesAt + kNodeBytes * i;
        const LeafTreeNode node = out.node(i);
        if (above[i] == 0) return faultAt(file, "a node that is no child", where);
        if (above[i] > kDeepestTreeInFile) return faultAt(file, "a tree that is too deep", where);
        if (!hasDirection(node.plane)) return faultAt(file, "a plane without a direction", where);
        for (const uint32_t child : node.child) {
            if ((child & LeafTreeNode::kLeaf) != 0) {
                if ((child ^ LeafTreeNode::kLeaf) >= out.leaves_)
                    return faultAt(file, "a child that is a leaf that there is not", where + 32);
                continue;
            }
            if (child <= i || child >= out.nodes_ || above[child] != 0)
                return faultAt(file, "a child that is not a node of its own behind its parent", where + 32);
            above[child] = static_cast<uint16_t>(above[i] + 1);
        }
    }
    return out;
}

LeafTree PlacedTree::tree() const {
    LeafTree out;
    if (leaves_ == 0) return out;
    out.bounds = {{bounds_[0], bounds_[1], bounds_[2]}, {bounds_[3], bounds_[4], bounds_[5]}};
    out.nodes.reserve(nodes_);
    for (uint32_t i = 0; i < nodes_; ++i) out.nodes.push_back(node(i));
    out.contents.reserve(leaves_);
    for (uint32_t i = 0; i < leaves_; ++i) out.contents.push_back(static_cast<LeafContents>(contents_[i]));
    return out;
}

}  // namespace sightline
