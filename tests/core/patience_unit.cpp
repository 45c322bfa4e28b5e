#include "tests/patience.hpp"

#include <gtest/gtest-spi.h>

namespace taktwerk {
namespace {

TEST(Patience, AWaitThatEndsIsLeftAlone) {
    int turns = 0;
    for (Patience patience{10}; patience.lasts(turns < 10);) ++turns;
    EXPECT_EQ(turns, 10);
}

TEST(Patience, AWaitThatDoesNotEndFailsTheTestAndGoesOn) {
    int turns = 0;
    EXPECT_NONFATAL_FAILURE(for (Patience patience{10}; patience.lasts(true);)++ turns, "this wait has no end");
    EXPECT_EQ(turns, 10);
}

}  // namespace
}  // namespace taktwerk
