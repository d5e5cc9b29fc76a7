// One scene written in many formats, so that what readers make of them can be compared.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::test {

/// A surface of polygons, counter-clockwise as seen from outside; y is up, in metres.
struct Surface {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<std::vector<uint32_t>> faces;

    /// Its faces as fans.
    std::vector<glm::uvec3> triangles() const;
};

/// Two boxes of different sizes that do not touch, off the origin on every axis.
std::vector<Surface> twoBoxes();

/// A file of a format, as its usual writers make it.
struct ForeignFile {
    std::string name;  ///< with the format's suffix
    std::string bytes;
    bool objects = true;        ///< surfaces stay apart, with their names
    bool single_sided = false;  ///< the format tells of sides, and this file says one
    double unit = 1;            ///< metres in what the reader is expected to give
};

std::string objText(const std::vector<Surface>& surfaces);
std::string plyText(const std::vector<Surface>& surfaces);
std::string plyBytes(const std::vector<Surface>& surfaces);
std::string stlText(const std::vector<Surface>& surfaces);
std::string stlBytes(const std::vector<Surface>& surfaces);
std::string offText(const std::vector<Surface>& surfaces);
std::string daeText(const std::vector<Surface>& surfaces);
std::string fbxText(const std::vector<Surface>& surfaces);
std::string fbxBytes(const std::vector<Surface>& surfaces);
std::string xText(const std::vector<Surface>& surfaces);
std::string x3dText(const std::vector<Surface>& surfaces);
std::string dxfText(const std::vector<Surface>& surfaces);
std::string amfText(const std::vector<Surface>& surfaces);
std::string acText(const std::vector<Surface>& surfaces);
std::string bytesOf3ds(const std::vector<Surface>& surfaces);
std::string bytesOf3mf(const std::vector<Surface>& surfaces);
std::string glbBytes(const std::vector<Surface>& surfaces);

/// A wall of 5 x 3 x 0.2 m, in millimetres and with z up.
/// @param schema  "IFC2X3" or "IFC4"
std::string ifcText(const std::string& schema);

/// All of the above of one scene, without glTF and IFC.
std::vector<ForeignFile> foreignFiles(const std::vector<Surface>& surfaces);

/// A zip archive of files that are stored as they are.
std::string zipBytes(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace sightline::test
