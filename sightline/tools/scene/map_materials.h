// What textures of a map's source are for sight, as far as the game's own files tell: shader scripts, .wal files, pictures.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace sightline::tools {

/// What a brush does to sight. The values order how little it hides: of two that both hold the larger is the safe one.
enum class BrushRole : uint8_t {
    kSolid,    ///< hides, and seals
    kSky,      ///< seals; a sight line ends in it
    kLiquid,   ///< another medium
    kUnknown,  ///< nobody says what it is: hides nothing, and is told
    kNothing,  ///< hides nothing: detail, clips, triggers, hints, grates
};

/// Games by their compilers' rules; several together where it is not known which.
enum MapGames : uint8_t {
    kNoGame = 0,
    kQuake = 1,                       ///< and Hexen 2
    kHalfLife = 2,                    ///< and what is built on it
    kQuake2 = 4,                      ///< and its kin
    kQuake3 = 8,                      ///< and its kin: Jedi Knight, Return to Castle Wolfenstein, OpenArena, ...
    kFlatGames = kQuake | kHalfLife,  ///< textures without folders; their names say all
    kDeepGames = kQuake2 | kQuake3,   ///< textures in folders; flags or scripts say what they are
    kAllGames = kFlatGames | kDeepGames,
};

/// The flags of a face of Quake 2.
struct MapFlags {
    uint32_t contents = 0, surface = 0;
};

/// What was read of a game's files. Names as nameOfTexture() gives them.
struct MapMaterials {
    std::unordered_map<std::string, BrushRole> shaders;  ///< of several of one name what hides the least
    std::unordered_map<std::string, MapFlags> wals;      ///< of several of one name all flags of them
    std::unordered_set<std::string> pictures;            ///< names with a picture
    std::vector<std::string> faults;  ///< a line each: what was not read to its end. Then a picture proves nothing

    void addShader(std::string name, BrushRole role) {
        const auto [at, fresh] = shaders.try_emplace(std::move(name), role);
        if (!fresh) at->second = std::max(at->second, role);
    }
    void addWal(const std::string& name, const MapFlags& flags) {
        MapFlags& known = wals[name];
        known.contents |= flags.contents;
        known.surface |= flags.surface;
    }
    void add(const MapMaterials& other) {
        for (const auto& [name, role] : other.shaders) addShader(name, role);
        for (const auto& [name, flags] : other.wals) addWal(name, flags);
        pictures.insert(other.pictures.begin(), other.pictures.end());
        faults.insert(faults.end(), other.faults.begin(), other.faults.end());
    }
};

/// Without "textures/", in small letters, with slashes.
inline std::string nameOfTexture(std::string_view full) {
    std::string name(full);
    for (char& c : name) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        if (c == '\\') c = '/';
    }
    return name.starts_with("textures/") ? name.substr(9) : name;
}

/// The same of a pattern, whose backslashes are its own.
inline std::string patternOfTextures(std::string_view full) {
    std::string pattern(full);
    for (char& c : pattern)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return pattern.starts_with("textures/") ? pattern.substr(9) : pattern;
}

/// Whether a whole name is a pattern's: `*` stands for any letters, `?` for one, a backslash takes the sign after it as it is.
/// O(name * pattern).
inline bool matches(std::string_view name, std::string_view pattern) {
    size_t n = 0, p = 0, star = std::string_view::npos, from = 0;
    while (n < name.size()) {
        const bool any = p < pattern.size() && pattern[p] == '*';
        const size_t letter = p < pattern.size() && pattern[p] == '\\' && p + 1 < pattern.size() ? p + 1 : p;
        if (any) {
            star = ++p;
            from = n;
        } else if (letter < pattern.size() && (pattern[letter] == name[n] || (pattern[letter] == '?' && letter == p))) {
            p = letter + 1;
            ++n;
        } else if (star != std::string_view::npos) {
            p = star;
            n = ++from;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

/// The same of several patterns with a blank between each two.
inline bool matchesAny(std::string_view name, std::string_view patterns) {
    for (size_t at = 0; at < patterns.size();) {
        const size_t end = std::min(patterns.find(' ', at), patterns.size());
        if (matches(name, patterns.substr(at, end - at))) return true;
        at = end + 1;
    }
    return false;
}

}  // namespace sightline::tools
