// Tables of pieces: what each statement draws, that copies are copies, and that faults name their line.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/pieces.h"

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

constexpr const char* kOak = "material old_oak 0.5 0.25 0.125\n";

Mesh pieceOf(const std::string& shapes) {
    Result<Pieces> pieces = readPieces(kOak + ("piece Thing\n" + shapes));
    EXPECT_TRUE(pieces) << pieces.error().message;
    return pieces->meshes.at(0);
}

void expectSame(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.indices, b.indices);
}

TEST(Pieces, ReadsMaterials) {
    const Result<Pieces> pieces = readPieces(
        "# a comment\n\nmaterial old_oak 0.5 0.25 0.125  # another\nmaterial pane 1 1 1 0.25 blend\n"
        "material leaf 0 1 0 mask two_sided");
    ASSERT_TRUE(pieces) << pieces.error().message;
    ASSERT_EQ(pieces->materials.size(), 3u);
    EXPECT_EQ(pieces->materials[0].name, "old oak");
    EXPECT_EQ(pieces->materials[0].base_color, glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
    EXPECT_EQ(pieces->materials[1].base_color.a, 0.25f);
    EXPECT_EQ(pieces->materials[1].alpha_mode, AlphaMode::kBlend);
    EXPECT_EQ(pieces->materials[2].alpha_mode, AlphaMode::kMask);
    EXPECT_TRUE(pieces->materials[2].double_sided);
}

TEST(Pieces, DrawsWhatTheSolidsDraw) {
    city::MeshBuilder mesh;
    addBox(mesh, 0, {-1, 0, -2}, {1, 3, 2});
    addPrism(mesh, 0, city::kAcross, {{0, 4}, {1, 4}, {0, 5}}, -0.5, 0.5);
    addTurned(mesh, 0, {4, 0, 1}, 6, {{0.5, 0}, {0.25, 1}, {0, 2}});
    mesh.quad(0, {0, 9, 0}, {1, 9, 0}, {1, 9, -1}, {0, 9, -1});
    mesh.triangle(0, {0, 8, 0}, {1, 8, 0}, {1, 8, -1});
    expectSame(mesh.finish("Thing"), pieceOf("box old_oak  -1 0 -2  1 3 2\n"
                                             "prism old_oak across  -0.5 0.5  0 4\n"
                                             "    1 4  0 5\n"
                                             "turned old_oak 6  4 0 1  0.5 0  0.25 1  0 2\n"
                                             "quad old_oak  0 9 0  1 9 0  1 9 -1  0 9 -1\n"
                                             "triangle old_oak  0 8 0  1 8 0  1 8 -1\n"));
}

TEST(Pieces, CopiesMoveWithinCopies) {
    city::MeshBuilder mesh;
    for (const double x : {-1.0, 2.0}) {
        addBox(mesh, 0, {x, 0, 0}, {x + 0.5, 1, 1});
        for (const double z : {3.0, 5.0, 7.0}) addTurned(mesh, 0, {x, 0.25, z}, 4, {{0.25, 0}, {0.25, 1}});
    }
    expectSame(mesh.finish("Thing"), pieceOf("copies x -1 2\n"
                                             "  box old_oak  0 0 0  0.5 1 1\n"
                                             "  copies z 3 5 7\n"
                                             "    turned old_oak 4  0 0.25 0  0.25 0  0.25 1\n"
                                             "  end\n"
                                             "end\n"));
}

TEST(Pieces, FifthsTurnWhereTheyStand) {
    city::MeshBuilder mesh;
    for (int fifth = 0; fifth < 5; ++fifth) {
        city::Frame frame = city::fifthFrame(fifth);
        frame.origin = {2, 0, 0};
        addPrism(mesh, 0, frame, {{0.5, 0}, {1, 0}, {0.5, 1}}, -0.125, 0.125);
    }
    expectSame(mesh.finish("Thing"), pieceOf("copies x 2\n fifths\n"
                                             "  prism old_oak along  -0.125 0.125  0.5 0  1 0  0.5 1\n end\nend\n"));
}

TEST(Pieces, AnEmptyPieceHasANameAlone) {
    const Result<Pieces> pieces = readPieces("piece Visitor's chair\npiece Desk");
    ASSERT_TRUE(pieces) << pieces.error().message;
    ASSERT_EQ(pieces->meshes.size(), 2u);
    EXPECT_EQ(pieces->meshes[0].name, "Visitor's chair");
    EXPECT_EQ(pieces->meshes[0].triangles(), 0u);
}

TEST(Pieces, FaultsNameTheirLine) {
    const std::pair<const char*, const char*> cases[] = {
        {"box old_oak 0 0 0 1 1 1", "line 2: box is neither"},
        {"piece", "line 2: piece is neither"},
        {"piece A\nbox oak 0 0 0 1 1 1", "line 3: box is of no material"},
        {"piece A\nbox old_oak 0 0 0 1 1", "line 3: box has too few"},
        {"piece A\nsphere old_oak 0 0 0 1", "line 3: sphere is no shape"},
        {"piece A\nprism old_oak down 0 1 0 0 1 0 0 1", "line 3: prism wants up"},
        {"piece A\nturned old_oak 5 0 0 0 1 0 1 1", "line 3: turned wants 3"},
        {"piece A\ncopies w 1 2\nend", "line 3: copies wants x"},
        {"piece A\ncopies x 1 2\nbox old_oak 0 0 0 1 1 1", "line 3: copies has no end"},
        {"piece A\nfifths\npiece B\nend", "line 3: fifths has no end"},
        {"piece A\nend", "line 3: end is no shape"},
        {"material pane 1 1", "line 2: material wants a name"},
        {"material pane 1 1 1 shiny", "line 2: material knows"},
    };
    for (const auto& [table, fault] : cases) {
        const Result<Pieces> pieces = readPieces(kOak + std::string(table));
        ASSERT_FALSE(pieces) << table;
        EXPECT_EQ(pieces.error().message.rfind(fault, 0), 0u) << table << "\n" << pieces.error().message;
    }
}

TEST(Pieces, TheTablesOfTheScenesHaveNoFaults) {
    for (const std::string_view table : {kBuildingPieces, kCityPieces, kTerrainPieces}) {
        const Result<Pieces> pieces = readPieces(table);
        EXPECT_TRUE(pieces) << pieces.error().message;
    }
}

}  // namespace
}  // namespace sightline
