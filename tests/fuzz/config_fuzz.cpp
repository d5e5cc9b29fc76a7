// Any bytes are a configuration file or one line that says where they are none.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "apps/cli/config_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline::cli;
    const auto file = parseConfig({reinterpret_cast<const char*>(data), size}, "t");
    if (!file) {
        if (file.error().message.rfind("t:", 0) != 0) std::abort();
        return 0;
    }
    // Text that was read is read the same once it was written.
    for (const ConfigEntry& entry : file->entries) {
        if (entry.kind != ConfigEntry::Kind::kText) continue;
        const auto again = parseConfig("k = " + tomlText(entry.words[0]), "t");
        if (!again || again->entries.size() != 1 || again->entries[0].words != entry.words) std::abort();
    }
    return 0;
}
