// Hidden surfaces by a BSP tree: back to front as a painter, or front to back, where each sample is written once.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/bsp/bsp_render.h"

#include <chrono>

#include "sightline/studies/hidden/bsp/bsp_frame.h"
#include "sightline/studies/hidden/methods/dynamic_screen.h"
#include "sightline/studies/hidden/methods/fill.h"

namespace sightline::studies {
namespace {

/// Subtrees of fewer pieces are not worth projecting a box.
constexpr uint32_t kWorthABox = 8;

/// Writes a run of free samples, whose fragments were counted as generated before.
void fillFree(HiddenImage& image, int32_t row, int32_t begin, int32_t end, uint32_t surface) {
    uint32_t* line = image.surface.data() + static_cast<size_t>(row) * image.width;
    std::fill(line + begin, line + end, surface);
    image.counters.passed += static_cast<uint64_t>(end - begin);
    countSpan(image, image.passed, row, begin, end);
    countSpan(image, image.shaded, row, begin, end);
}

template <class Screen>
class FrontToBack {
public:
    FrontToBack(const BspScene& scene, const HiddenInput& input, HiddenImage& image, Screen& screen)
        : frame_(scene, input, image), image_(image), screen_(screen), width_(static_cast<int32_t>(image.width)) {}

    template <class Tree>
    void draw(const Tree& tree) {
        BspStack stack;
        walkFrontToBack(
            tree, frame_.eye(), stack, [&](uint32_t node) { return enter(node); },
            [&](uint32_t node) {
                ++image_.counters.nodes;
                if (screen_.full()) return;
                frame_.forPieces(node, false,
                                 [&](const BspPiece& piece, const BspArrays& arrays) { paint(piece, arrays); });
            });
        image_.counters.shaded = image_.counters.passed;
    }

private:
    bool enter(uint32_t node) {
        if constexpr (std::is_same_v<Screen, CheckedScreen>) return true;
        if (screen_.full()) {
            ++image_.counters.skipped_subtrees;
            return false;
        }
        if (frame_.piecesBelow(node) < kWorthABox) return true;
        const ScreenWindow window = frame_.windowOf(frame_.boundsOf(node));
        if (window.empty()) return false;
        if (screen_.anyFree(window)) return true;
        ++image_.counters.skipped_subtrees;
        return false;
    }

    void paint(const BspPiece& piece, const BspArrays& arrays) {
        if (!screen_.anyFree(frame_.windowOf(piece))) return;
        if (!frame_.makeFragment(piece, arrays, fragment_)) return;
        if (!fragment_.cuts.empty() && !screen_.anyFree(fragment_.window)) return;
        screen_.forFreeRows(fragment_.window, [&](int32_t row_begin, int32_t row_end) {
            scanFragment(fragment_, row_begin, row_end, width_, [&](int32_t row, int32_t begin, int32_t end) {
                const uint64_t count = static_cast<uint64_t>(end - begin);
                image_.counters.generated += count;
                image_.counters.tested += count;
                countSpan(image_, image_.generated, row, begin, end);
                countSpan(image_, image_.tested, row, begin, end);
                screen_.take(row, begin, end,
                             [&](int32_t from, int32_t to) { fillFree(image_, row, from, to, piece.number); });
            });
        });
    }

    BspFrame frame_;
    HiddenImage& image_;
    Screen& screen_;
    BspFragment fragment_;
    int32_t width_;
};

template <class Screen>
void drawWith(Screen screen, const BspScene& scene, const HiddenInput& input, HiddenImage& image) {
    image.counters.splits = scene.tree.splits + scene.overlay.splits;
    FrontToBack<Screen> drawing(scene, input, image, screen);
    withTree(scene, [&](const auto& tree) { drawing.draw(tree); });
}

}  // namespace

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

void drawBspFrontToBack(const BspScene& scene, const HiddenInput& input, HiddenImage& image) {
    const int32_t width = static_cast<int32_t>(image.width), height = static_cast<int32_t>(image.height);
    switch (input.settings.free_samples) {
        case FreeSamples::kCheck:
            return drawWith(CheckedScreen(image), scene, input, image);
        case FreeSamples::kSegments:
            return drawWith(SegmentScreen(width, height), scene, input, image);
        case FreeSamples::kBits:
            return drawWith(BitScreen(width, height), scene, input, image);
    }
}

void drawBspFrontToBack(const HiddenInput& input, HiddenImage& image) {
    const auto start = std::chrono::steady_clock::now();
    const BspScene scene = buildBspScene(input.list);
    const auto spent = std::chrono::steady_clock::now() - start;
    image.counters.prepare_nanoseconds =
        static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count());
    drawBspFrontToBack(scene, input, image);
}

}  // namespace sightline::studies
