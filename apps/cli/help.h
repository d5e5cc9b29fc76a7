// What the tool says of itself: its words on scenes, cameras, exit codes, files; help of a verb; the nearest word.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sightline::cli {

struct SessionOptions;

/// A word and what it means.
struct Entry {
    const char* term;
    const char* text;
};

extern const char* const kAbout;
std::span<const Entry> sceneEntries();
std::span<const Entry> cameraEntries();
std::span<const Entry> exitCodeEntries();
std::span<const Entry> environmentEntries();
std::span<const Entry> fileEntries();

/// Command lines of a verb, each with what it does. For no verb: one or two of each.
std::vector<Entry> examplesOf(const std::string& verb);

/// Gives the tool and its verbs their help's look and their last words.
void dressHelp(CLI::App& tool);
/// The verb `help VERB`.
void addHelp(CLI::App& tool, int& exit_code);

/// The nearest of some words, if it is near enough to have been meant; else nothing.
std::string nearest(const std::string& word, const std::vector<std::string>& words);
/// "; did you mean X?", or nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& words);

/// A text in lines of at most so many characters, each but the first after the indent.
std::string wrapped(const std::string& text, size_t indent, size_t width);

}  // namespace sightline::cli
