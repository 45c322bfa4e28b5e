// The committed reference pages are what the tables say today.

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "apps/docs/device_page.hpp"
#include "apps/docs/reference_pages.hpp"
#include "fb_library/block_reference.hpp"

namespace taktwerk::apps {
namespace {

std::string committed(const std::string& name) {
    std::ifstream file(std::string(TAKTWERK_SOURCE_DIR) + "/docs/reference/" + name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(ReferencePages, EqualTheGeneratedText) {
    EXPECT_EQ(committed("blocks.md"), fb::block_reference_markdown()) << "taktwerk docs blocks -o docs/reference/blocks.md";
    EXPECT_EQ(committed("alarms.md"), alarm_reference_markdown()) << "taktwerk docs alarms -o docs/reference/alarms.md";
    EXPECT_TRUE(committed("devices.md") == device_reference_markdown({std::string(TAKTWERK_SOURCE_DIR) + "/config/devices"}))
        << "taktwerk docs devices -o docs/reference/devices.md";
    EXPECT_EQ(committed("errors.md"), error_reference_markdown()) << "taktwerk docs errors -o docs/reference/errors.md";
    EXPECT_EQ(committed("parameters.md"), parameter_reference_markdown()) << "taktwerk docs parameters -o docs/reference/parameters.md";
}

}  // namespace
}  // namespace taktwerk::apps
