// A scene of an IFC file, which a test writes and reads.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "foreign_files.h"
#include "foreign_reading.h"
#include "ifc_files.h"

namespace sightline::test {

using namespace tools;

class Ifc : public SceneFiles {
protected:
    void SetUp() override {
        SceneFiles::SetUp();
        settings_.note = [this](const std::string& text) { notes_ += text + "\n"; };
        IfcFile file;
        file.solid("IFCWALL", "a", file.extruded({0, 0, 0}, {1, 1, 1}));
        static const std::string lacking = [&] {
            const Result<Scene> scene = load(write("probe.ifc", file.text()));
            return scene.ok() || scene.error().message.find("IFC is read by") == std::string::npos
                       ? ""
                       : scene.error().message;
        }();
        if (!lacking.empty()) GTEST_SKIP() << lacking;
        notes_.clear();
    }

    /// The scene of a file, which must be a sound one.
    Scene read(const std::string& text, const std::string& name = "a.ifc") {
        notes_.clear();
        Result<Scene> scene = load(write(name, text));
        EXPECT_TRUE(scene.ok()) << scene.error().message;
        if (!scene.ok()) return {};
        EXPECT_EQ(sceneFault(*scene), "");
        return std::move(*scene);
    }
    Scene read(const IfcFile& file) { return read(file.text()); }

    void expectNoted(const std::string& words) const { EXPECT_NE(notes_.find(words), std::string::npos) << notes_; }

    std::string notes_;
};

}  // namespace sightline::test
