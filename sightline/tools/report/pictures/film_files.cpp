// The pictures that lie beside a run's file, as a film.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/film_files.h"

#include <algorithm>
#include <filesystem>

#include <fmt/core.h>

#include "sightline/tools/scene/text_file.h"

namespace sightline::tools {
namespace {

constexpr size_t kLargestPicture = size_t{64} << 20;  // [bytes]
constexpr uint32_t kLargestSide = 1u << 16;           // [pixels]

std::string pathOf(const RunFile& file, const std::string& id, size_t frame) {
    return fmt::format("{}frames/{}-{:04}.png", file.directory, id == "shaded" ? "frame" : id, frame);
}

/// The file's size; 0 if there is none that could be a picture.
size_t sizeOf(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return 0;
    const auto size = std::filesystem::file_size(path, error);
    return error || size < 33 || size > kLargestPicture ? 0 : static_cast<size_t>(size);
}

uint32_t bigEndian(const std::string& bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// A PNG as the page takes it: that it is one is told by its first bytes.
bool isPng(const std::string& bytes) {
    if (bytes.size() < 33 || bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") != 0 || bytes.compare(12, 4, "IHDR") != 0)
        return false;
    const uint32_t width = bigEndian(bytes, 16), height = bigEndian(bytes, 20);
    return width >= 1 && width <= kLargestSide && height >= 1 && height <= kLargestSide;
}

/// The bytes of a picture; empty if there is none.
std::string pictureAt(const std::string& path) {
    if (sizeOf(path) == 0) return {};
    const Result<std::string> bytes = readTextFile(path, kLargestPicture);
    return bytes && isPng(*bytes) ? *bytes : std::string();
}

}  // namespace

Film filmBeside(const RunFile& file, const std::vector<std::string>& ids, const std::vector<size_t>& frames,
                size_t budget) {
    Film film;
    film.heat_scale = 0;
    if (file.directory.empty()) return film;
    std::vector<std::pair<size_t, size_t>> there;  // frame, bytes
    for (const size_t frame : frames) {
        size_t bytes = 0;
        for (const std::string& id : ids) bytes += sizeOf(pathOf(file, id, frame));
        if (bytes > 0) there.emplace_back(frame, bytes);
    }
    std::vector<size_t> chosen;
    for (size_t count = there.size(); count > 0; count = count * 3 / 4) {
        chosen.clear();
        size_t sum = 0;
        for (size_t i = 0; i < count; ++i) {
            const auto& [frame, bytes] = there[count > 1 ? i * (there.size() - 1) / (count - 1) : 0];
            chosen.push_back(frame);
            sum += bytes;
        }
        if (sum <= budget) break;
        chosen.clear();
    }
    for (const size_t frame : chosen) {
        Shot shot;
        shot.frame = frame;
        shot.plan_text = "From above.";
        shot.section_text = "From the side.";
        for (const std::string& id : ids) {
            const std::string bytes = pictureAt(pathOf(file, id, frame));
            if (bytes.empty()) continue;
            if (id == "shaded") {
                film.width = bigEndian(bytes, 16);
                film.height = bigEndian(bytes, 20);
            }
            shot.images.push_back({id, bytes});
        }
        if (!shot.images.empty()) film.shots.push_back(std::move(shot));
    }
    if (!film.shots.empty()) film.overview = pictureAt(file.directory + "frames/overview.png");
    if (film.width == 0) {
        film.width = file.run.width;
        film.height = file.run.height;
    }
    return film;
}

}  // namespace sightline::tools
