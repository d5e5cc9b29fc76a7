// The pictures of a page, which are files beside it as well.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/result.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// A polygon as SVG writes its points.
std::string svgPoints(std::span<const glm::dvec2> outline);
/// The bits of rows, each row in whole words, the lowest bit first.
std::string base64Rows(const BitMatrix& rows);

class PagePictures {
public:
    explicit PagePictures(std::string directory) : directory_(std::move(directory)) {}

    void add(const std::string& name, const Image<Rgb>& image, const std::string& text);
    /// A plan that a reader may ask.
    void ask(nlohmann::ordered_json plan) { plan_ = std::move(plan); }
    /// Writes the page and its numbers. Errors (kOutput): the first of all files.
    /// @param page  what it is of, as report.js knows it
    /// @param run   JSON, written as PAGE.json, too
    Status finish(const std::string& page, const std::string& run);

private:
    void save(const std::string& name, std::string_view bytes);

    std::string directory_;
    nlohmann::ordered_json pictures_ = nlohmann::ordered_json::array();
    nlohmann::ordered_json plan_;  // null: there is none to ask
    Status status_ = success();
};

}  // namespace sightline::tools
