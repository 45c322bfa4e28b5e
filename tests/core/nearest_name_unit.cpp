#include "core/nearest_name.hpp"

#include <gtest/gtest.h>

namespace taktwerk {
namespace {

TEST(NearestName, FindsASlipOfTheKeyboard) {
    EXPECT_EQ(nearest_name("velocitty", {"position", "velocity", "jerk"}), "velocity");
    EXPECT_EQ(nearest_name("strat_button", {"start_button", "stop_button"}), "start_button");
    EXPECT_EQ(nearest_name("y", {"x"}), "x");
    EXPECT_EQ(nearest_name("SV33-E", {"sv-da200", "sv33-e"}), "sv33-e");
}

TEST(NearestName, SaysNothingWhenNothingIsNear) {
    EXPECT_EQ(nearest_name("temperature", {"position", "velocity"}), "");
    EXPECT_EQ(nearest_name("x", {}), "");
    EXPECT_EQ(nearest_name(std::string(100, 'a'), {std::string(100, 'a')}), "");
}

}  // namespace
}  // namespace taktwerk
