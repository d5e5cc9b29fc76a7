// An explanation in plain sentences.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "sightline/query/explain/explain.h"

namespace sightline::tools {

/// What an object is called in a sentence: "'Floor 3/Office/Desk'", or "object 4711" if it has no name.
using NameOfObject = std::function<std::string(ObjectId)>;

/// "culled by occlusion: object 4711 'Desk' lies behind 'Wall 12' (71 %) and 'Door 3' (29 %); without these two it would
/// be visible." and what else there is to say, in one paragraph.
/// @param subject  the object itself: "object 4711 'Desk'"
/// @param seen     what else is known of it if it is kept, said first, as the end of a sentence: "is seen: ..."; or empty
std::string explanationText(const Explanation& why, const std::string& subject, const NameOfObject& name,
                            const std::string& seen = {});

/// One clause without the object's name: "behind 'Wall 12' (71 %) and 'Door 3' (29 %)", for lists of frames.
/// @param most  occluders that are named; of more, their number is
std::string explanationClause(const Explanation& why, const NameOfObject& name, size_t most = 6);

/// "frustum", "occlusion", or empty where no stage culled it.
std::string stageOf(const Explanation& why);

/// As JSON has it: "visible", "outside frustum", "occluded", "too far", "too small", "outside layers", "no such object".
const char* verdictName(Verdict verdict);
/// "open pixel", "view not usable", and so on.
const char* keptBecauseName(KeptBecause because);

/// A paragraph in lines of at most so many characters; a word that is longer has a line of its own.
/// @param indent  before all lines but the first
std::string wrapped(const std::string& text, size_t width, const std::string& indent = "");

}  // namespace sightline::tools
