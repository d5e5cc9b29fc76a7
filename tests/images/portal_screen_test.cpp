// Pictures of a doorway on the viewer's screen.
// SPDX-License-Identifier: MIT
#include "sightline/images/portal_screen.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sightline/images/psnr.h"
#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

PortalPicture pictureOf(const DepthImage& image) {
    PortalPicture picture;
    picture.width = image.view.width;
    picture.height = image.view.height;
    picture.colour = coloursOf(image);
    return picture;
}

TEST(PortalScreen, DrawsInsideOfTheOutlineAlone) {
    const std::vector<glm::dvec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}};
    const PortalFrame frame = *portalFrame(corners, {0.5, 1, 1});
    PortalPicture picture;
    picture.width = picture.height = 4;
    picture.colour.assign(16, glm::u8vec3(7));
    const View view = viewAt({0.8, 1.1, 2}, {0.5, 0.9, 0});
    std::vector<glm::u8vec3> colours(size_t{view.width} * view.height, glm::u8vec3(0));
    const std::vector<uint32_t> through = samplesThrough(frame, view);
    EXPECT_EQ(drawOnScreen(frame, picture, view, {}, colours), through.size());
    EXPECT_GT(through.size(), 500u);
    size_t drawn = 0;
    for (uint32_t row = 0; row < view.height; ++row)
        for (uint32_t i = 0; i < view.width; ++i) {
            const bool is_drawn = colours[row * view.width + i] == glm::u8vec3(7);
            drawn += is_drawn;
            EXPECT_EQ(is_drawn, std::binary_search(through.begin(), through.end(), row * view.width + i));
        }
    EXPECT_EQ(drawn, through.size());
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 at = projected(view, corner + 0.02 * (frame.toWorld({0.7, 0.7, 0}) - corner));
        EXPECT_EQ(colours[static_cast<size_t>(at.y + 0.5) * view.width + static_cast<size_t>(at.x + 0.5)],
                  glm::u8vec3(7));
    }
}

TEST(PortalScreen, LeavesWhatStandsBefore) {
    const PortalFrame frame = madeDoorway();
    PortalPicture picture;
    picture.width = picture.height = 4;
    picture.colour.assign(16, glm::u8vec3(7));
    const View view = viewAt({0.5, 1, 2}, {0.5, 1, 0});
    std::vector<glm::u8vec3> colours(size_t{view.width} * view.height, glm::u8vec3(0));
    const std::vector<uint32_t> through = samplesThrough(frame, view);
    std::vector<float> nearness(colours.size(), 0.0f);
    nearness[through[0]] = 0.6f;   // before
    nearness[through[1]] = 0.5f;   // in the doorway's plane: before
    nearness[through[2]] = 0.49f;  // beyond
    EXPECT_EQ(drawOnScreen(frame, picture, view, nearness, colours), through.size() - 2);
    EXPECT_EQ(colours[through[0]], glm::u8vec3(0));
    EXPECT_EQ(colours[through[1]], glm::u8vec3(0));
    EXPECT_EQ(colours[through[2]], glm::u8vec3(7));
}

TEST(PortalScreen, DrawsNothingForAnEyeBehindOrWithoutAPicture) {
    const PortalFrame frame = madeDoorway();
    std::vector<glm::u8vec3> colours(160 * 90, glm::u8vec3(0));
    PortalPicture picture;
    EXPECT_EQ(drawOnScreen(frame, picture, viewAt({0.5, 1, 2}, {0.5, 1, 0}), {}, colours), 0u);
    picture.width = picture.height = 1;
    picture.colour.assign(1, glm::u8vec3(7));
    EXPECT_EQ(drawOnScreen(frame, picture, viewAt({0.5, 1, -2}, {0.5, 1, 0}), {}, colours), 0u);
    EXPECT_EQ(drawOnScreen(frame, picture, viewAt({0.5, 1, 2}, {0.5, 1, 5}), {}, colours), 0u) << "turned away";
}

TEST(PortalScreen, ShowsFromASamplePointWhatTheCameraSees) {
    const PortalFrame frame = madeDoorway();
    PictureError error;
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        const DoorwayRoom room(seed);
        const glm::dvec3 eye(0.3, 1.3, 1.4);
        const View camera = viewAt(eye, {0.6, 1, 0}, {.width = 240, .height = 135});
        const std::vector<glm::u8vec3> truth = coloursOf(room.take(camera));
        std::vector<glm::u8vec3> shown(truth.size());
        drawOnScreen(frame, pictureOf(room.take(eye, 400, 800)), camera, {}, shown);
        for (const uint32_t at : samplesThrough(frame, camera)) error.add(truth[at], shown[at]);
    }
    EXPECT_GT(error.psnr(), 38) << "but for the samples whose texel an edge crosses";
}

}  // namespace
}  // namespace sightline::test
