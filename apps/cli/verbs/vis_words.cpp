// What compilers' tools of the Quake family are told with one dash: a table.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/vis_words.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/core.h>

#include "apps/cli/shell/session.h"

namespace sightline::cli {
namespace {

enum class Means { kOption, kNothing, kOtherRows };

struct Word {
    std::string_view name;
    Means means;
    bool has_value = false;
    std::string_view text = {};  ///< an option of ours; or why it means nothing, or what is not done
};

constexpr std::string_view kTight = "rows are always as tight as they can be proved";
constexpr std::string_view kOwnWay = "it says how other tools work";

constexpr auto kWords = std::to_array<Word>({
    {"-threads", Means::kOption, true, "--threads"},
    {"-quiet", Means::kOption, false, "--quiet"},
    {"-level", Means::kNothing, true, kTight},
    {"-fast", Means::kNothing, false, kTight},
    {"-full", Means::kNothing, false, kTight},
    {"-v", Means::kNothing, false, kOwnWay},
    {"-vv", Means::kNothing, false, kOwnWay},
    {"-verbose", Means::kNothing, false, kOwnWay},
    {"-log", Means::kNothing, false, kOwnWay},
    {"-nolog", Means::kNothing, false, kOwnWay},
    {"-nocolor", Means::kNothing, false, kOwnWay},
    {"-noprogress", Means::kNothing, false, kOwnWay},
    {"-nopercent", Means::kNothing, false, kOwnWay},
    {"-nostat", Means::kNothing, false, kOwnWay},
    {"-nostate", Means::kNothing, false, kOwnWay},
    {"-lowpriority", Means::kNothing, false, kOwnWay},
    {"-low", Means::kNothing, false, kOwnWay},
    {"-high", Means::kNothing, false, kOwnWay},
    {"-estimate", Means::kNothing, false, kOwnWay},
    {"-noestimate", Means::kNothing, false, kOwnWay},
    {"-chart", Means::kNothing, false, kOwnWay},
    {"-nosort", Means::kNothing, false, kOwnWay},
    {"-nopassage", Means::kNothing, false, kOwnWay},
    {"-passageonly", Means::kNothing, false, kOwnWay},
    {"-saveprt", Means::kNothing, false, "portal files stay"},
    {"-vis", Means::kNothing, false, "it is the verb"},
    {"-noambient", Means::kOption, false, "--no-ambient=all"},
    {"-noambientsky", Means::kOption, false, "--no-ambient=sky"},
    {"-noambientwater", Means::kOption, false, "--no-ambient=water"},
    {"-noambientslime", Means::kOption, false, "--no-ambient=slime"},
    {"-noambientlava", Means::kOption, false, "--no-ambient=lava"},
    {"-visdist", Means::kOption, true, "--farthest"},
    {"-maxdistance", Means::kOption, true, "--farthest"},
    {"-phsonly", Means::kOtherRows, false, "what is heard is made with what is seen"},
    {"-merge", Means::kOtherRows, false, "clusters stay as the compiler made them; see --cells"},
    {"-mergeportals", Means::kOtherRows, false, "clusters stay as the compiler made them; see --cells"},
});

}  // namespace

Result<std::vector<std::string>> visWords(const std::vector<std::string>& words) {
    if (words.empty() || words[0] != "vis") return words;
    std::vector<std::string> out;
    for (size_t i = 0; i < words.size(); ++i) {
        const auto* const known =
            std::find_if(kWords.begin(), kWords.end(), [&](const Word& word) { return word.name == words[i]; });
        if (known == kWords.end()) {
            out.push_back(words[i]);
            continue;
        }
        if (known->has_value && i + 1 == words.size())
            return Error{Error::Kind::kUsage, fmt::format("{}: its value is missing", known->name)};
        if (known->means == Means::kOtherRows)
            return Error{Error::Kind::kUsage, fmt::format("{}: {}", known->name, known->text)};
        if (known->means == Means::kOption) {
            out.emplace_back(known->text);
        } else {
            note(fmt::format("{} has no effect: {}", known->name, known->text));
            if (known->has_value) ++i;
        }
    }
    return out;
}

}  // namespace sightline::cli
