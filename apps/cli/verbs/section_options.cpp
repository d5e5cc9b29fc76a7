// The option of section planes.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/section_options.h"

#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sightline::cli {
namespace {

CLI::ValidationError wrongPlane(const std::string& text) {
    return CLI::ValidationError("--section",
                                "wants four numbers A,B,C,D: Ax + By + Cz + D >= 0 is kept, not '" + text + "'");
}

glm::dvec4 readPlane(const std::string& text) {
    const std::vector<std::string> parts = CLI::detail::split(text, ',');
    glm::dvec4 plane(0.0);
    if (parts.size() != 4) throw wrongPlane(text);
    for (int i = 0; i < 4; ++i)
        if (!CLI::detail::lexical_cast(parts[static_cast<size_t>(i)], plane[i]) || !std::isfinite(plane[i]))
            throw wrongPlane(text);
    if (glm::dvec3(plane) == glm::dvec3(0.0)) throw wrongPlane(text);
    return plane;
}

}  // namespace

void addSectionOptions(CLI::App& verb, RunOptions& options) {
    verb.add_option_function<std::vector<std::string>>(
            "--section",
            [&options](const std::vector<std::string>& planes) {
                options.sections = {};
                for (const std::string& plane : planes)
                    if (!options.sections.add(readPlane(plane)))
                        throw CLI::ValidationError("--section", fmt::format("{} planes at most", ViewPlanes::kMost));
            },
            "cut the scene open: what is not on the side Ax + By + Cz + D >= 0 is not drawn [may be given 8 times]")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("A,B,C,D")
        ->group("Culling");
}

std::string sectionOptionsOf(const ViewPlanes& sections) {
    std::string words;
    for (const glm::dvec4& plane : sections.all())
        words += fmt::format(" --section={},{},{},{}", plane.x, plane.y, plane.z, plane.w);
    return words;
}

}  // namespace sightline::cli
