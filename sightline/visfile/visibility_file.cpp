// Writes and opens visibility files.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/visibility_file.h"

#include <utility>

#include "sightline/base/bytes.h"
#include "sightline/visfile/leaf_cells.h"
#include "sightline/visfile/packed_rows.h"

namespace sightline {

using namespace visibility_file;

namespace {

constexpr size_t kMapBytes = 16;  // before the name

/// The sections of places: the same in both forms.
constexpr uint32_t kPlaces[] = {kCells,   kCellNames,  kRegions,  kTree,     kPortals, kDoors,
                                kObjects, kObjectRows, kViewTree, kViewRows, kPrepared};

Array<char> mapSection(size_t leaves, uint64_t hash, std::string_view name, Memory* memory) {
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    out.put(static_cast<uint32_t>(leaves));
    out.put(uint32_t{0});
    out.put(hash);
    bytes.insert(bytes.end(), name.begin(), name.end());
    return bytes;
}

/// A section in place, or what a packed one unpacks to.
struct Section {
    std::span<const char> bytes;
    uint64_t at = 0;
};

template <class Unpack>
Result<Section> eitherForm(const SectionFile& sections, uint32_t in_place, uint32_t packed, std::string_view file,
                           Array<char>& unpacked, Unpack unpack) {
    const std::span<const char> plain = sections.find(in_place), coded = sections.find(packed);
    if (!plain.empty() && !coded.empty())
        return faultAt(file, "a section that is there twice, packed and not", sections.placeOf(coded));
    if (coded.empty()) return Section{plain, sections.placeOf(plain)};
    Result<Array<char>> bytes = unpack(coded, file, sections.placeOf(coded), unpacked.memory());
    if (!bytes) return bytes.error();
    unpacked = std::move(*bytes);
    return Section{unpacked, sections.placeOf(coded)};
}

Status addPlaces(const VisibilityContent& content, SectionWriter& writer, Memory* memory) {
    const auto wrong = [](const char* what) { return Error{Error::Kind::kUsage, what}; };
    const CellSpace* space = content.space;
    if (!content.view_tree != !content.view_rows) return wrong("view cells without rows, or rows without view cells");
    if ((content.object_rows || content.view_rows) && !content.objects) return wrong("rows of objects without objects");
    if (!content.prepared.empty() && !content.objects) return wrong("prepared meshes without objects");
    if (!space) return content.objects ? wrong("objects without cells") : success();
    if (Status added = addCellSections(*space, static_cast<uint32_t>(content.visible.rows()), writer, memory); !added)
        return added;
    if (space->ofTree()) {
        if (space->graph.cell_of_leaf.size() != space->tree.contents.size()) return wrong("not a cell for each leaf");
        Result<Array<char>> tree = treeSection(space->tree, memory);
        if (!tree) return tree.error();
        writer.add(kTree, std::move(*tree));
    }
    if (Status added = addPortalSections(*space, writer, memory); !added) return added;
    if (!content.objects) return success();
    Result<Array<char>> objects = objectSection(*content.objects, space->graph.cells, memory);
    if (!objects) return objects.error();
    writer.add(kObjects, std::move(*objects));
    const auto fits = [&](const BitMatrix& matrix, size_t rows) {
        return matrix.rows() == rows && matrix.columns() == content.objects->size();
    };
    if (content.object_rows) {
        if (!fits(*content.object_rows, content.visible.rows()))
            return wrong("rows of objects that are not rows of these cells and objects");
        writer.add(kObjectRows, objectRowsSection(*content.object_rows, memory));
    }
    if (!content.prepared.empty()) {
        if (content.prepared_of_object.size() != content.objects->size())
            return wrong("prepared meshes of other objects");
        Array<char> prepared = preparedSection(content.prepared, content.prepared_of_object, memory);
        if (const Result<PreparedMeshes> read =
                readPreparedSection(prepared, content.objects->size(), "prepared meshes", 0, memory);
            !read)
            return wrong(read.error().message.c_str());
        writer.add(kPrepared, std::move(prepared));
    }
    if (!content.view_tree) return success();
    if (!fits(*content.view_rows, content.view_tree->contents.size()))
        return wrong("rows of view cells that are not rows of these cells and objects");
    Result<Array<char>> view_tree = treeSection(*content.view_tree, memory);
    if (!view_tree) return view_tree.error();
    writer.add(kViewTree, std::move(*view_tree));
    writer.add(kViewRows, objectRowsSection(*content.view_rows, memory));
    return success();
}

}  // namespace

Result<Array<char>> visibilityFile(const VisibilityContent& content, VisibilityForm form, Memory* memory) {
    Result<Array<char>> rows = tiledRows(content.visible, memory);
    if (!rows) return rows;
    for (const uint32_t cell : content.cell_of_leaf)
        if (cell >= content.visible.rows() && cell != CellGraph::kNoCell)
            return Error{Error::Kind::kUsage, "a leaf of a cell that there is not"};
    SectionWriter writer(memory);
    writer.add(kMap, mapSection(content.cell_of_leaf.size(), content.map_hash, content.map_name, memory));
    writer.add(kRows, std::move(*rows));
    writer.add(kLeaves, leafCells(content.cell_of_leaf, memory));
    if (Status added = addPlaces(content, writer, memory); !added) return added.error();
    Array<char> bytes = writer.file();
    if (form == VisibilityForm::kInPlace) return bytes;
    const Result<VisibilityFile> opened = VisibilityFile::open(bytes, "what was written", memory);
    if (!opened) return opened.error();
    return packedFile(*opened, memory);
}

Array<char> packedFile(const VisibilityFile& file, Memory* memory) {
    Array<uint32_t> cell_of_leaf(file.leaves(), 0, memory);
    for (uint32_t leaf = 0; leaf < file.leaves(); ++leaf) cell_of_leaf[leaf] = file.cellOfLeaf(leaf);
    SectionWriter writer(memory);
    writer.add(kMap, mapSection(file.leaves(), file.mapHash(), file.mapName(), memory));
    writer.add(kPackedRows, packedRows(file.rows(), memory));
    writer.add(kPackedLeaves, packedLeafCells(cell_of_leaf, memory));
    for (const uint32_t tag : kPlaces)
        if (const std::span<const char> section = file.sections_.find(tag); !section.empty())
            writer.add(tag, Array<char>(section.begin(), section.end(), memory));
    return writer.file();
}

size_t VisibilityFile::residentBytes() const {
    size_t bytes = rows_.bytes() + 2 * cell_of_leaf_.size();
    for (const uint32_t tag : kPlaces)
        if (tag != kPrepared) bytes += sections_.find(tag).size();
    return bytes;
}

CellSpace VisibilityFile::cellSpace() const {
    CellSpace space;
    cells_.copyTo(space);
    portals_.copyTo(space);
    if (!cells_.hasRegions()) space.tree = tree_.tree();
    return space;
}

Result<PreparedMeshes> VisibilityFile::prepared(std::string_view file, Memory* memory) const {
    const std::span<const char> bytes = sections_.find(kPrepared);
    return readPreparedSection(bytes, objects_.size(), file, sections_.placeOf(bytes), memory);
}

Status VisibilityFile::openPlaces(const SectionFile& sections, std::string_view file) {
    sections_ = sections;
    const auto at = [&](uint32_t tag) { return sections.placeOf(sections.find(tag)); };
    has_cells_ = !sections.find(kCells).empty();
    has_objects_ = !sections.find(kObjects).empty();
    has_object_rows_ = !sections.find(kObjectRows).empty();
    has_prepared_ = !sections.find(kPrepared).empty();
    if (!has_cells_) {
        for (const uint32_t tag : kPlaces)
            if (!sections.find(tag).empty()) return faultAt(file, "a section of cells that there are not", at(tag));
        return success();
    }
    const Result<PlacedCells> cells = PlacedCells::open(sections, rows_.cells(), file);
    if (!cells) return cells.error();
    cells_ = *cells;
    const std::span<const char> tree_bytes = sections.find(kTree);
    if (cells->hasRegions() != tree_bytes.empty() && cells->cells() > 0)
        return faultAt(file, "cells of both regions and a tree, or of neither", at(kCells));
    if (!tree_bytes.empty()) {
        const Result<PlacedTree> tree = PlacedTree::open(tree_bytes, file, at(kTree), unpacked_rows_.memory());
        if (!tree) return tree.error();
        if (tree->leaves() != cells->leaves()) return faultAt(file, "not a cell for each leaf", at(kTree));
        if (cells->outside() != CellGraph::kNoCell) return faultAt(file, "a tree with an outside", at(kCells));
        tree_ = *tree;
    }
    const Result<PlacedPortals> portals = PlacedPortals::open(sections, cells->cells(), file);
    if (!portals) return portals.error();
    portals_ = *portals;
    if (has_objects_) {
        const Result<PlacedObjects> objects =
            PlacedObjects::open(sections.find(kObjects), cells->cells(), file, at(kObjects));
        if (!objects) return objects.error();
        objects_ = *objects;
    } else if (has_prepared_) {
        return faultAt(file, "prepared meshes of no objects", at(kPrepared));
    }
    if (has_object_rows_) {
        const Result<PlacedObjectRows> rows =
            PlacedObjectRows::open(sections.find(kObjectRows), rows_.cells(), objects_.size(), file, at(kObjectRows));
        if (!rows) return rows.error();
        object_rows_ = *rows;
    }
    const std::span<const char> view_tree = sections.find(kViewTree), view_rows = sections.find(kViewRows);
    has_view_cells_ = !view_tree.empty();
    if (has_view_cells_ != !view_rows.empty())
        return faultAt(file, "view cells without rows, or rows without view cells",
                       at(has_view_cells_ ? kViewTree : kViewRows));
    if (!has_view_cells_) return success();
    const Result<PlacedTree> tree = PlacedTree::open(view_tree, file, at(kViewTree), unpacked_rows_.memory());
    if (!tree) return tree.error();
    view_tree_ = *tree;
    const Result<PlacedObjectRows> rows =
        PlacedObjectRows::open(view_rows, view_tree_.leaves(), objects_.size(), file, at(kViewRows));
    if (!rows) return rows.error();
    view_rows_ = *rows;
    return success();
}

Result<VisibilityFile> VisibilityFile::open(std::span<const char> bytes, std::string_view file, Memory* memory) {
    const Result<SectionFile> sections = SectionFile::open(bytes, file);
    if (!sections) return sections.error();
    VisibilityFile opened(memory);
    const std::span<const char> map = sections->find(kMap);
    if (map.size() < kMapBytes) return faultAt(file, "no word on the map", sections->placeOf(map));
    ByteCursor head(map);
    const uint32_t leaves = head.take<uint32_t>();
    if (head.take<uint32_t>() != 0) return faultAt(file, "a mark that is not known", sections->placeOf(map) + 4);
    opened.map_hash_ = head.take<uint64_t>();
    opened.map_name_ = {map.data() + kMapBytes, map.size() - kMapBytes};

    const Result<Section> rows = eitherForm(*sections, kRows, kPackedRows, file, opened.unpacked_rows_, unpackedRows);
    if (!rows) return rows.error();
    if (rows->bytes.empty()) return faultAt(file, "no rows", bytes.size());
    const Result<VisibleRows> view = VisibleRows::open(rows->bytes, file, rows->at);
    if (!view) return view.error();
    opened.rows_ = *view;

    const Result<Section> numbers =
        eitherForm(*sections, kLeaves, kPackedLeaves, file, opened.unpacked_leaves_, unpackedLeafCells);
    if (!numbers) return numbers.error();
    if (numbers->bytes.size() != 2 * uint64_t{leaves})
        return faultAt(file, "not as many leaves as it says", numbers->at);
    opened.cell_of_leaf_ = PlacedNumbers<uint16_t>(numbers->bytes);
    for (uint32_t leaf = 0; leaf < leaves; ++leaf)
        if (const uint16_t cell = opened.cell_of_leaf_[leaf]; cell >= view->cells() && cell != kNoCellInFile)
            return faultAt(file, "a leaf of a cell that there is not", numbers->at);
    if (const Status places = opened.openPlaces(*sections, file); !places) return places.error();
    return opened;
}

}  // namespace sightline
