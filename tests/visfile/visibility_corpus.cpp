// Writes seeds for the fuzzer of visibility files.
// SPDX-License-Identifier: MIT
#include "tests/support/files.h"
#include "tests/visfile/made_file.h"
#include "tests/visfile/made_meshes.h"
#include "tests/visfile/made_places.h"
#include "tests/visfile/seal.h"

namespace sightline::test {
namespace {

/// With all sections of places, and view cells on request.
Array<char> withPlaces(const MadePlaces& places, bool views = false) {
    const MadeFile rows(5, places.object_rows.rows());
    return *visibilityFile({rows.visible,
                            {},
                            "house",
                            5,
                            &places.space,
                            &places.objects,
                            &places.object_rows,
                            views ? &places.view_tree : nullptr,
                            views ? &places.view_rows : nullptr},
                           VisibilityForm::kInPlace);
}

template <class Seed>
void makeAll(Seed seed) {
    const Array<char> plain = MadeFile(1, 40).bytes(VisibilityForm::kInPlace),
                      packed = MadeFile(2, 60).bytes(VisibilityForm::kPacked),
                      one = MadeFile(3, 1).bytes(VisibilityForm::kInPlace),
                      many = MadeFile(4, 200).bytes(VisibilityForm::kPacked);
    Array<char> cut = plain, damaged = packed, no_tiles = plain, many_cells = packed;
    cut.resize(cut.size() / 2);
    damaged[damaged.size() / 2] ^= 1;
    const uint64_t rows =
        SectionFile::open(plain, "")->placeOf(SectionFile::open(plain, "")->find(visibility_file::kRows));
    no_tiles[rows + 8] = 0;
    seal(no_tiles);
    const SectionFile sections = *SectionFile::open(packed, "");
    const uint64_t coded = sections.placeOf(sections.find(visibility_file::kPackedRows));
    for (const uint64_t at : {coded, coded + 1, coded + 4, coded + 5}) many_cells[at] = '\xff';
    seal(many_cells);
    const Array<char> boxes = withPlaces(boxesInARow(1, 5, 6, 20)), tree = withPlaces(leavesOfATree(2, 9, 6, 70));
    MadePlaces seen_from = boxesInARow(3, 4, 5, 40);
    Random random(3);
    seen_from.addViews(5, random);
    const Array<char> views = withPlaces(seen_from, true);
    // The fuzzer takes inputs of up to 4096 bytes.
    const MadePlaces few = boxesInARow(4, 2, 2, 2);
    const MadeFile few_rows(5, few.object_rows.rows());
    PreparedMeshes made;
    made.meshes.push_back(madeMesh(Torus(4, 3), true, false));
    made.mesh_of_object.assign(few.objects.size(), 0);
    VisibilityContent with_meshes{few_rows.visible, {}, "house", 5, &few.space, &few.objects};
    with_meshes.prepared = made.meshes;
    with_meshes.prepared_of_object = made.mesh_of_object;
    const Array<char> prepared = *visibilityFile(with_meshes, VisibilityForm::kInPlace);
    Array<char> loose_child = tree;
    const SectionFile tree_sections = *SectionFile::open(tree, "");
    loose_child[tree_sections.placeOf(tree_sections.find(visibility_file::kTree)) + 56 + 32] = 0;
    seal(loose_child);
    seed("boxes.see", boxes);
    seed("tree.see", tree);
    seed("views.see", views);
    seed("prepared.see", prepared);
    seed("loose_child.see", loose_child);
    seed("in_place.see", plain);
    seed("packed.see", packed);
    seed("one_cell.see", one);
    seed("many.see", many);
    seed("cut.see", cut);
    seed("damaged.see", damaged);
    seed("no_tiles.see", no_tiles);
    seed("many_cells.see", many_cells);
}

}  // namespace
}  // namespace sightline::test

int main(int argc, char** argv) {
    return sightline::test::writeSeeds(argc, argv, [](auto seed) { sightline::test::makeAll(seed); });
}
