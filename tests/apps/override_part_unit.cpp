#include "apps/machine/override_part.hpp"

#include <gtest/gtest.h>

namespace taktwerk::apps {
namespace {

TEST(OverridePart, IsWrittenPerCent) {
    EXPECT_DOUBLE_EQ(override_part("30").value(), 0.3);
    EXPECT_DOUBLE_EQ(override_part("50.5 %").value(), 0.505);
    EXPECT_DOUBLE_EQ(override_part("0").value(), 0);
    EXPECT_DOUBLE_EQ(override_part("100%").value(), 1);
}

// Said here, for the machine counts in parts: whoever follows "give 0 to 1" would get one per cent.
TEST(OverridePart, BeyondAHundredIsRefusedPerCent) {
    for (const char* text : {"100.1", "150", "-3", "1e9"}) {
        const auto part = override_part(text);
        ASSERT_FALSE(part) << text;
        EXPECT_NE(part.error().text().find("100"), std::string::npos) << part.error().text();
    }
    EXPECT_FALSE(override_part("fast"));
    EXPECT_FALSE(override_part("30 mm"));
}

}  // namespace
}  // namespace taktwerk::apps
