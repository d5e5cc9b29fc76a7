// Pieces of pages: what is written into them stays where it is written.
// SPDX-License-Identifier: MIT
#include "sightline/report/page_parts.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace sightline {
namespace {

TEST(PageParts, NoNameEndsTheScriptThatHoldsIt) {
    // <!--<script> makes the browser pass over the next </script>: the page would end within its data.
    for (const char* name : {"</script><script>alert(1)</script>", "<!--<script>", "]]>&amp;\"'\\"}) {
        const nlohmann::json data = {{"name", name}};
        const std::string text = embedded(data.dump());
        EXPECT_EQ(text.find('<'), std::string::npos) << text;
        EXPECT_EQ(nlohmann::json::parse(text), data);
    }
}

}  // namespace
}  // namespace sightline
