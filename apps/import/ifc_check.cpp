// What Assimp cannot read of IFC, found before it tries.
// SPDX-License-Identifier: MIT
#include "apps/import/ifc_check.h"

#include <array>
#include <cctype>
#include <cstdio>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "apps/import/fault.h"

namespace sightline::import {
namespace {

constexpr std::array<std::string_view, 9> kNotRead = {"IFCTRIANGULATEDFACESET",
                                                      "IFCTRIANGULATEDIRREGULARNETWORK",
                                                      "IFCPOLYGONALFACESET",
                                                      "IFCINDEXEDPOLYCURVE",
                                                      "IFCADVANCEDBREP",
                                                      "IFCADVANCEDBREPWITHVOIDS",
                                                      "IFCADVANCEDFACE",
                                                      "IFCFIXEDREFERENCESWEPTAREASOLID",
                                                      "IFCEXTRUDEDAREASOLIDTAPERED"};

/// Takes a file's characters one by one and knows the type of each entity: the word between = and (.
class EntityTypes {
public:
    /// A type when its ( comes; empty otherwise.
    std::string_view take(char c) {
        if (text_) {
            text_ = c != '\'';
            return {};
        }
        if (c == '\'') {
            text_ = true;
        } else if (c == '=') {
            word_.clear();
            after_equals_ = true;
        } else if (c == '(' && after_equals_) {
            after_equals_ = false;
            return word_;
        } else if (after_equals_ && !std::isspace(static_cast<unsigned char>(c)) && word_.size() < 64) {
            word_ += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        }
        return {};
    }

private:
    std::string word_;
    bool text_ = false, after_equals_ = false;
};

}  // namespace

void checkIfc(const std::string& file) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
    if (!stream) return;
    EntityTypes types;
    std::array<char, 1 << 16> block;
    while (const size_t got = std::fread(block.data(), 1, block.size(), stream.get()))
        for (size_t i = 0; i < got; ++i) {
            const std::string_view type = types.take(block[i]);
            if (type.empty()) continue;
            for (const std::string_view bad : kNotRead)
                if (type == bad)
                    throw Fault{
                        fmt::format("holds IFC4 geometry that is not read ({}): export it as IFC2x3 or glTF", bad)};
        }
}

}  // namespace sightline::import
