// The pictures of a page, which are files beside it as well.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/page_pictures.h"

#include <fmt/core.h>

#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/page/page.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {

std::string svgPoints(std::span<const glm::dvec2> outline) {
    std::string points;
    for (const glm::dvec2& p : outline) points += fmt::format("{:.1f},{:.1f} ", p.x, p.y);
    return points;
}

std::string base64Rows(const BitMatrix& rows) {
    std::string bytes;
    for (size_t r = 0; r < rows.rows(); ++r)
        for (const uint64_t word : rows.row(r))
            for (int at = 0; at < 64; at += 8) bytes += static_cast<char>(word >> at & 0xff);
    return base64(bytes);
}

void PagePictures::add(const std::string& name, const Image<Rgb>& image, const std::string& text) {
    const std::string png = encodePalettePng(image);
    save(name + ".png", png);
    pictures_.push_back({{"name", name}, {"image", dataUri(png)}, {"text", text}});
}

Status PagePictures::finish(const std::string& page, const std::string& run) {
    save(page + ".json", run);
    save("index.html", pageWith("{\"page\":\"" + page + "\",\"pictures\":" + jsonText(pictures_) +
                                ",\"plan\":" + jsonText(plan_) + ",\"run\":" + run + "}"));
    return status_;
}

void PagePictures::save(const std::string& name, std::string_view bytes) {
    if (status_) status_ = writeFileAside(directory_ + "/" + name, bytes);
}

}  // namespace sightline::tools
