// Which scene a verb is to look at: files or a procedural one, and how files are read.
// SPDX-License-Identifier: MIT
#include "apps/cli/scene_choice.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "sightline/import/scene_file.h"
#include "sightline/scene/procedural.h"

namespace sightline::cli {

std::string SceneChoice::title() const { return fmt::format("{}", fmt::join(names, " + ")); }

std::string SceneChoice::words() const {
    std::string words;
    for (const std::string& name : names) words += (words.empty() ? "" : " ") + quoted(name);
    return words;
}

std::string SceneChoice::procedural() const {
    return names.size() == 1 && isProcedural(names.front()) ? names.front() : std::string();
}

void addSceneChoice(CLI::App& verb, SceneChoice& choice) {
    verb.add_option("SCENE", choice.names, "a .glb or .gltf file, city:SEED:OBJECTS or made:NAME")
        ->required()
        ->expected(1, 1000);
}

Result<Scene> loadScene(const SceneChoice& choice) {
    if (!choice.procedural().empty()) return makeProcedural(choice.procedural());
    if (choice.names.size() > 1)
        return Error{Error::Kind::kUsage, fmt::format("{}: one scene at a time", choice.names[1])};
    return loadSceneFile(choice.names.front());
}

}  // namespace sightline::cli
