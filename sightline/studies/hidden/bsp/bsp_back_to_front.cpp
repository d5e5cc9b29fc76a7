// Hidden surfaces by a BSP tree, back to front: a painter whose order is right for every scene and every eye.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/bsp/bsp_back_to_front.h"

#include <chrono>

#include "sightline/studies/hidden/bsp/bsp_frame.h"
#include "sightline/studies/hidden/methods/fill.h"

namespace sightline::studies {

void drawBspBackToFront(const BspScene& scene, const HiddenInput& input, HiddenImage& image) {
    BspFrame frame(scene, input, image);
    BspFragment fragment;
    BspStack stack;
    const int32_t width = static_cast<int32_t>(image.width);
    const auto paint = [&](const BspPiece& piece, const BspArrays& arrays) {
        if (!frame.makeFragment(piece, arrays, fragment)) return;
        scanFragment(fragment, fragment.window.row_begin, fragment.window.row_end, width,
                     [&](int32_t row, int32_t begin, int32_t end) { fillSpan(image, row, begin, end, piece.number); });
    };
    image.counters.splits = scene.tree.splits + scene.overlay.splits;
    withTree(scene, [&](const auto& tree) {
        walkBackToFront(
            tree, frame.eye(), stack, [](uint32_t) { return true; },
            [&](uint32_t node) {
                ++image.counters.nodes;
                frame.forPieces(node, true, paint);
            });
    });
}

void drawBspBackToFront(const HiddenInput& input, HiddenImage& image) {
    const auto start = std::chrono::steady_clock::now();
    const BspScene scene = buildBspScene(input.list);
    const auto spent = std::chrono::steady_clock::now() - start;
    image.counters.prepare_nanoseconds =
        static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count());
    drawBspBackToFront(scene, input, image);
}

}  // namespace sightline::studies
