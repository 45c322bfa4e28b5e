// What holds a velocity down is said where it was asked for.

#include "apps/machine/held_velocity.hpp"

#include <gtest/gtest.h>

namespace taktwerk::apps {
namespace {

std::string told(const char* limiter, const char* mode, double override_factor = 1) {
    return held_velocity({{"velocity_limiter", limiter}, {"override", override_factor}}, mode);
}

TEST(HeldVelocity, NamesWhatHoldsItDownAndWhereThatIsSet) {
    EXPECT_NE(told("manual_speed", "setup").find("set-up mode holds the velocity down (manual.setup_velocity"), std::string::npos);
    EXPECT_NE(told("manual_speed", "manual").find("manual mode holds the velocity down (manual.fast"), std::string::npos);
    EXPECT_NE(told("axis_limit", "automatic").find("limits.velocity"), std::string::npos);
    EXPECT_NE(told("override_factor", "automatic", 0.2).find("the override is 20 %"), std::string::npos);
}

TEST(HeldVelocity, SaysNothingWhileTheCommandDecides) {
    for (const auto* limiter : {"none", "command", "stopping", "software_limit"}) EXPECT_EQ(told(limiter, "setup"), "") << limiter;
}

}  // namespace
}  // namespace taktwerk::apps
