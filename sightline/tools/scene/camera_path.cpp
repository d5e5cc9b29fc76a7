// Camera paths: a list of frames, its JSON form, and the views that they stand for.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/camera_path.h"

#include <cmath>
#include <limits>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/geom/clip_space.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/suggestion.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::tools {
namespace {

using nlohmann::json;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// What is wrong, without file and frame; never leaves this file.
struct Complaint {
    std::string what;
};

double readNumber(const json& value, const std::string& name) {
    if (!value.is_number()) throw Complaint{fmt::format("\"{}\" is not a number", name)};
    const double number = value.get<double>();
    if (!std::isfinite(number)) throw Complaint{fmt::format("\"{}\" is not finite", name)};
    return number;
}

void readNumbers(const json& value, const std::string& name, double* out, size_t count) {
    if (!value.is_array() || value.size() != count)
        throw Complaint{fmt::format("\"{}\" is not an array of {} numbers", name, count)};
    for (size_t i = 0; i < count; ++i) out[i] = readNumber(value[i], fmt::format("{}[{}]", name, i));
}

std::optional<glm::dmat4> readMatrix(const json& value, const std::string& name) {
    if (value.is_null()) return std::nullopt;
    double numbers[16];
    readNumbers(value, name, numbers, 16);
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[i];
    return matrix;
}

std::optional<double> readOptional(const json& value, const std::string& name) {
    if (value.is_null()) return std::nullopt;
    return readNumber(value, name);
}

/// Which of the values that have no default were given; and how its matrices project, if that was said.
struct Given {
    bool eye = false, target = false;
    std::optional<ClipSpace> clip;
};

constexpr const char* kKeys[] = {"eye",  "target",     "up",   "fov_y_degrees", "near", "far", "orthographic_height",
                                 "view", "projection", "clip", "frames"};

ClipSpace readClipSpace(const json& value) {
    std::vector<std::string> names;
    for (const NamedClipSpace& known : kClipSpaces) {
        if (value == known.name) return known.space;
        names.push_back(known.name);
    }
    const std::string near = value.is_string() ? suggestion(value.get<std::string>(), names) : std::string();
    throw Complaint{fmt::format("\"clip\" is none of {}{}", joined(names, ", "), near)};
}

/// Takes what an object holds, the head's or a frame's, over what is there.
void overlay(const json& object, CameraFrame& frame, Given& given, bool is_head = false) {
    if (!object.is_object()) throw Complaint{"not a JSON object"};
    for (const auto& [name, value] : object.items()) {
        if (name == "eye") {
            readNumbers(value, name, &frame.eye.x, 3);
            given.eye = true;
        } else if (name == "target") {
            readNumbers(value, name, &frame.target.x, 3);
            given.target = true;
        } else if (name == "up") {
            readNumbers(value, name, &frame.up.x, 3);
        } else if (name == "fov_y_degrees") {
            frame.fov_y_degrees = readNumber(value, name);
        } else if (name == "near") {
            frame.z_near = readNumber(value, name);
        } else if (name == "far") {
            frame.z_far = readOptional(value, name);
        } else if (name == "orthographic_height") {
            frame.orthographic_height = readOptional(value, name);
        } else if (name == "view") {
            frame.view = readMatrix(value, name);
        } else if (name == "projection") {
            frame.projection = readMatrix(value, name);
        } else if (name == "clip") {
            given.clip = readClipSpace(value);
        } else if (name != "frames" || !is_head) {
            throw Complaint{fmt::format("there is no \"{}\"{}", oneLine(name),
                                        suggestion(name, {std::begin(kKeys), std::end(kKeys)}))};
        }
    }
}

/// Brings a frame's matrices into the conventions of views, and holds them to the rules of a view.
void settleMatrices(CameraFrame& frame, const Given& given) {
    if (!frame.view) throw Complaint{"\"projection\" without \"view\""};
    if (!frame.projection) throw Complaint{"\"view\" without \"projection\""};
    View seen;
    seen.view = *frame.view;
    seen.projection = *frame.projection;
    const ViewProblem before = problemOf(seen);
    if (given.clip || before == ViewProblem::kMirrors || before == ViewProblem::kReversed)
        setMatrices(seen, *frame.view, *frame.projection,
                    given.clip ? *given.clip : tellClipSpace(*frame.view, *frame.projection));
    switch (problemOf(seen)) {
        case ViewProblem::kNone:
            break;
        case ViewProblem::kRowMajor:
            throw Complaint{"the last row of \"view\" is not 0 0 0 1 (matrices are column-major: transpose it)"};
        case ViewProblem::kNotRigid:
            throw Complaint{"\"view\" is not rigid (a rotation and a translation)"};
        case ViewProblem::kMirrors:
            throw Complaint{"\"view\" mirrors"};
        case ViewProblem::kReversed:
            throw Complaint{"depth runs towards the eye: \"clip\" says something else"};
        default:
            throw Complaint{"its matrices are singular or overflow"};
    }
    frame.view = seen.view;
    frame.projection = seen.projection;
}

void checkCamera(const CameraFrame& frame, const Given& given) {
    if (!given.eye) throw Complaint{"\"eye\" is missing"};
    if (!given.target) throw Complaint{"\"target\" is missing"};
    if (frame.eye == frame.target) throw Complaint{"\"eye\" equals \"target\""};
    if (frame.orthographic_height) {
        if (!(*frame.orthographic_height > 0)) throw Complaint{"\"orthographic_height\" is not greater than 0"};
    } else {
        if (!(frame.fov_y_degrees > 0 && frame.fov_y_degrees < 180))
            throw Complaint{"\"fov_y_degrees\" is not between 0 and 180"};
        if (!(frame.z_near > 0)) throw Complaint{"\"near\" is not greater than 0"};
    }
    if (frame.z_far && !(*frame.z_far > frame.z_near)) throw Complaint{"\"far\" is not greater than \"near\""};
}

void settleFrame(CameraFrame& frame, const Given& given) {
    if (frame.view || frame.projection) settleMatrices(frame, given);
    else checkCamera(frame, given);
    if (!isUsable(makeView(frame, 1, 1))) throw Complaint{"its matrices are singular or overflow"};
}

/// What cull --json wrote: each frame has its camera.
bool isRun(const json& head) {
    const auto schema = head.is_object() ? head.find("schema") : head.end();
    return schema != head.end() && schema->is_string() && schema->get<std::string>().starts_with("sightline.cull/");
}

CameraPath readFrames(const json& head) {
    CameraFrame defaults;
    Given given_by_head;
    const bool is_run = isRun(head);
    try {
        if (!is_run) overlay(head, defaults, given_by_head, true);
    } catch (const Complaint& complaint) { throw Complaint{"head: " + complaint.what}; }
    const auto list = head.find("frames");
    if (list == head.end() || !list->is_array() || list->empty())
        throw Complaint{"no frames (\"frames\" must be an array of at least one)"};
    CameraPath path;
    path.frames.reserve(list->size());
    for (const json& entry : *list) {
        CameraFrame frame = defaults;
        Given given = given_by_head;
        try {
            const auto camera = is_run && entry.is_object() ? entry.find("camera") : entry.end();
            if (is_run && camera == entry.end()) throw Complaint{"there is no \"camera\""};
            overlay(is_run ? *camera : entry, frame, given);
            settleFrame(frame, given);
        } catch (const Complaint& complaint) {
            throw Complaint{fmt::format("frame {}: {}", path.frames.size(), complaint.what)};
        }
        path.frames.push_back(frame);
    }
    return path;
}

/// The library's message without its bracketed code.
std::string parseMessage(const char* what) {
    const std::string text = what;
    const size_t end = text.find("] ");
    return end == std::string::npos ? text : text.substr(end + 2);
}

json vectorJson(const glm::dvec3& v) { return json::array({v.x, v.y, v.z}); }

json matrixJson(const glm::dmat4& m) {
    json out = json::array();
    for (int i = 0; i < 16; ++i) out.push_back(m[i / 4][i % 4]);
    return out;
}

nlohmann::ordered_json frameJson(const CameraFrame& frame) {
    nlohmann::ordered_json out;
    out["eye"] = vectorJson(frame.eye);
    out["target"] = vectorJson(frame.target);
    out["up"] = vectorJson(frame.up);
    out["fov_y_degrees"] = frame.fov_y_degrees;
    out["near"] = frame.z_near;
    if (frame.z_far) out["far"] = *frame.z_far;
    if (frame.orthographic_height) out["orthographic_height"] = *frame.orthographic_height;
    if (frame.view) out["view"] = matrixJson(*frame.view);
    if (frame.projection) out["projection"] = matrixJson(*frame.projection);
    return out;
}

}  // namespace

View makeView(const CameraFrame& frame, uint32_t width, uint32_t height) {
    View view;
    view.width = width;
    view.height = height;
    if (frame.view && frame.projection) {
        view.view = *frame.view;
        view.projection = *frame.projection;
        return view;
    }
    const double aspect = static_cast<double>(width) / height;
    const double z_far = frame.z_far.value_or(std::numeric_limits<double>::infinity());
    view.view = lookAt(frame.eye, frame.target, frame.up);
    view.projection = frame.orthographic_height
                          ? orthographic(*frame.orthographic_height, aspect, frame.z_near, z_far)
                          : perspective(frame.fov_y_degrees * kDegree, aspect, frame.z_near, z_far);
    return view;
}

Result<CameraPath> readCameraPath(const std::string& file) {
    const Result<std::string> text = readTextFile(file);
    return text ? parseCameraPath(*text, file) : text.error();
}

Result<CameraPath> parseCameraPath(std::string_view text, const std::string& file) {
    std::string what;
    try {
        return readFrames(parseJson(text));
    } catch (const Complaint& complaint) { what = complaint.what; } catch (const json::exception& exception) {
        what = "not JSON: " + parseMessage(exception.what());
    }
    return Error{Error::Kind::kInput, fmt::format("{}: {}", file, what)};
}

std::string cameraPathJson(const CameraPath& path) {
    std::string text = "{\"frames\": [";
    for (size_t i = 0; i < path.frames.size(); ++i)
        text += (i ? ",\n  " : "\n  ") + jsonText(frameJson(path.frames[i]));
    return text + "\n]}\n";
}

CameraPath sceneCameras(const Scene& scene) {
    CameraPath path;
    path.frames.reserve(scene.cameras.size());
    for (const SceneCamera& camera : scene.cameras) {
        CameraFrame frame;
        const glm::dmat4& m = camera.transform;
        frame.eye = glm::dvec3(m[3]);
        frame.target = frame.eye - glm::normalize(glm::dvec3(m[2]));
        frame.up = glm::normalize(glm::dvec3(m[1]));
        frame.z_near = camera.z_near;
        frame.z_far = camera.z_far;
        if (camera.fov_y > 0) frame.fov_y_degrees = camera.fov_y / kDegree;
        else frame.orthographic_height = camera.orthographic_height;
        path.frames.push_back(frame);
    }
    return path;
}

}  // namespace sightline::tools
