// Whether what is written is apart from what is read, and each output from the others.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/apart.h"

#include <system_error>

#include <fmt/core.h>

#include "sightline/tools/import/quake/map_source.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// Where a name leads to, as far as that exists.
std::filesystem::path placeOf(const std::filesystem::path& name) {
    std::error_code error;
    const std::filesystem::path place = weakly_canonical(std::filesystem::absolute(name, error), error);
    return error ? name : place;
}

}  // namespace

bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    return !a.empty() && !b.empty() && placeOf(a) == placeOf(b);
}

void ApartFiles::read(const std::string& option, const std::filesystem::path& name) { take(option, name, false); }

void ApartFiles::write(const std::string& option, const std::filesystem::path& name) { take(option, name, true); }

void ApartFiles::writeAgain(const std::string& option, const std::filesystem::path& name,
                            const std::filesystem::path& first) {
    if (!sameFile(first, name)) write(option, name);
}

void ApartFiles::take(const std::string& option, const std::filesystem::path& name, bool written) {
    if (name.empty() || name == "-") return;
    std::error_code ignored;
    if (exists(name, ignored) && !is_regular_file(name, ignored)) return;
    const std::filesystem::path place =
        placeOf(written ? name : std::filesystem::path(splitMapName(name.string()).file));
    for (const Named& other : taken_)
        if (status_ && written && other.place == place)
            status_ =
                Error{Error::Kind::kUsage, fmt::format("{}: {} is taken by {}", option, name.string(), other.option)};
    taken_.push_back({option, place});
}

}  // namespace sightline::cli
