// What any engine says that it drew, frame by frame: JSON or CSV from a stranger's file.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::tools {

/// One object that an engine drew, as its file calls it.
struct DrawnObject {
    std::string name;    ///< a name or a path; empty: it is called by its key
    uint64_t key = 0;    ///< SceneObject::key
    uint64_t place = 0;  ///< of JSON in its list, from 0; of CSV its line, from 1
};

struct AnsweredFrame {
    uint32_t frame = 0;              ///< of the camera path, from 0
    std::vector<DrawnObject> drawn;  ///< in the file's order, repeated where the file repeats them
    std::string place;               ///< of JSON: "frames[3].drawn"; of CSV empty
};

struct Answers {
    std::string file;                       ///< that it was read from
    std::vector<AnsweredFrame> frames;      ///< by rising number, each once
    CameraPath cameras;                     ///< of JSON that has some; else empty. Frame i is seen by cameras.frames[i]
    std::optional<uint32_t> width, height;  ///< of JSON that says so  [pixels]
    double stereo = 0;                      ///< distance of the eyes, both of which the answer is for; 0: one eye
    std::vector<glm::dvec4> sections;       ///< of JSON that has some: View::sections

    /// "answers.csv: line 12", "answers.json: frames[3].drawn[7]".
    std::string placeOf(const AnsweredFrame& frame, const DrawnObject& object) const;
};

/// Reads the two formats of docs/judging.md; what begins with a brace or a bracket is JSON. What `cull --json` wrote is such
/// JSON. A byte order mark and line ends of any kind are taken. Errors (kInput) name the file and the line or the place: columns
/// that there are not, quotes that do not close, frames or keys that are no whole numbers, a frame that is there twice,
/// cameras of some frames alone, no frame at all.
/// @param file  named by errors
Result<Answers> parseAnswers(std::string_view text, const std::string& file);

}  // namespace sightline::tools
