// Assimp's view of the disk: regular files alone, read-only, the scene's file under the suffix of its format.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include <assimp/DefaultIOSystem.h>

namespace sightline::import {

class FileAccess : public Assimp::DefaultIOSystem {
public:
    /// @param suffix  by which Assimp knows the format: "obj"
    FileAccess(std::string file, const std::string& suffix);

    /// The name to give to Assimp: the file's own, with another suffix where its own is not the format's.
    const std::string& alias() const { return alias_; }

    /// All of the file. Throws a Fault if it cannot be read.
    std::string text() const;
    /// From now on the file holds this.
    void replace(std::string text) { text_ = std::move(text); }

    bool Exists(const char* name) const override;
    Assimp::IOStream* Open(const char* name, const char* mode) override;

private:
    std::string realName(const char* name) const;

    std::string file_, alias_;
    std::string text_;  ///< instead of the file's own, unless empty
};

}  // namespace sightline::import
