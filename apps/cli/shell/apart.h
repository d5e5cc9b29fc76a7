// Whether what is written is apart from what is read, and each output from the others.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sightline/base/result.h"

namespace sightline::cli {

/// Whether two names lead to one file; not, if one is empty.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// The files of one command, in the order of their naming. Of two outputs in one file the later one would be left, and
/// an output in an input's place would be the end of that.
class ApartFiles {
public:
    /// @param name  an empty one, a device and `-` are no files and pass over; so does a procedural scene
    void read(const std::string& option, const std::filesystem::path& name);
    void write(const std::string& option, const std::filesystem::path& name);
    /// The same bytes may be asked for twice: of the later no more is said.
    void writeAgain(const std::string& option, const std::filesystem::path& name, const std::filesystem::path& first);

    /// Errors (kUsage): a file is written and was named before.
    const Status& status() const { return status_; }

private:
    struct Named {
        std::string option;
        std::filesystem::path place;
    };
    void take(const std::string& option, const std::filesystem::path& name, bool written);

    std::vector<Named> taken_;
    Status status_ = success();
};

}  // namespace sightline::cli
