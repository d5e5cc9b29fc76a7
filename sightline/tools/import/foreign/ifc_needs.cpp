// Looks for Node.js in the search path, and for web-ifc beside sightline-import.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/foreign/ifc_needs.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <unistd.h>

#include <fmt/core.h>

namespace sightline::tools {
namespace {

namespace fs = std::filesystem;

/// A program of the search path. Empty: there is none of these names.
std::string findProgram(std::initializer_list<const char*> names) {
    const char* list = std::getenv("PATH");
    std::string_view left = list ? list : "/usr/local/bin:/usr/bin:/bin";
    while (!left.empty()) {
        const size_t end = std::min(left.find(':'), left.size());
        const fs::path folder(left.substr(0, end));
        left.remove_prefix(std::min(end + 1, left.size()));
        std::error_code error;
        for (const char* name : names)
            if (!folder.empty() && access((folder / name).c_str(), X_OK) == 0 &&
                !fs::is_directory(folder / name, error))
                return (folder / name).string();
    }
    return {};
}

}  // namespace

IfcNeeds findIfcNeeds(const std::string& worker) {
    IfcNeeds out;
    out.node = findProgram({"node", "nodejs"});
    if (out.node.empty()) {
        out.lacks = "IFC is read by Node.js, which is not installed: install it (apt install nodejs)";
        return out;
    }
    std::error_code error;
    const fs::path folder = fs::canonical(worker, error).parent_path() / "ifc";
    for (const char* needed : {"read_ifc.mjs", "web-ifc/web-ifc-api-node.js", "web-ifc/web-ifc-node.wasm"})
        if (out.lacks.empty() && !fs::is_regular_file(folder / needed, error))
            out.lacks = fmt::format(
                "IFC is read by web-ifc, which this build lacks ({}): install npm (apt install npm) and "
                "build sightline-import again",
                needed);
    out.script = (folder / "read_ifc.mjs").string();
    return out;
}

}  // namespace sightline::tools
