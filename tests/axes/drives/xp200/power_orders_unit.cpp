// Whose power RUN shows, order by order (power_orders.hpp).

#include <gtest/gtest.h>

#include "axes/drives/xp200/power_orders.hpp"

namespace taktwerk::axes::xp200 {
namespace {

using namespace std::chrono_literals;
using Heard = PowerOrders::Heard;

constexpr Instant start{10s};

/// Has its power by the wish of turn 1.
PowerOrders running() {
    PowerOrders orders;
    EXPECT_TRUE(orders.enable(1, start));
    orders.answered(Heard::done);
    orders.seen(true);
    EXPECT_TRUE(orders.on());
    EXPECT_EQ(orders.power_of(), 1);
    return orders;
}

TEST(PowerOrders, RunOfAnOrderThatWasTakenBackIsNotThePowerOfTheNext) {
    PowerOrders orders;
    ASSERT_TRUE(orders.enable(1, start));
    orders.answered(Heard::done);
    orders.want(false, 2);
    EXPECT_FALSE(orders.enable(3, start + 2s)) << "it has not been seen off";
    ASSERT_TRUE(orders.disable(start + 10ms));
    orders.answered(Heard::done);
    orders.seen(true);  // Pr166 holds for the brake
    EXPECT_FALSE(orders.on());
    EXPECT_EQ(orders.power_of(), 0);
    EXPECT_FALSE(orders.enable(3, start + 2s));
    orders.seen(false);
    ASSERT_TRUE(orders.enable(3, start + 20ms)) << "nothing to wait for any more";
    orders.seen(true);
    EXPECT_EQ(orders.power_of(), 3);
}

// The enabling order may still be on its way through the drive.
TEST(PowerOrders, OffIsOffOnlyOnceTheDriveHasConfirmedThatItIsDisabled) {
    for (const auto heard : {Heard::nothing, Heard::refused}) {
        PowerOrders orders;
        ASSERT_TRUE(orders.enable(1, start));
        orders.want(false, 2);
        ASSERT_TRUE(orders.disable(start + 10ms));
        if (heard != Heard::nothing) orders.answered(heard);
        orders.seen(false);
        EXPECT_TRUE(orders.unclear());
        ASSERT_TRUE(orders.disable(start + 2s));
        orders.answered(Heard::done);
        orders.seen(false);
        EXPECT_TRUE(orders.off());
    }
}

TEST(PowerOrders, AnOrderWithoutAnAnswerIsGivenAgainAtOnceAndOneWithAnAnswerAfterASecond) {
    PowerOrders orders;
    ASSERT_TRUE(orders.enable(1, start));
    EXPECT_TRUE(orders.enable(1, start + 20ms));
    orders.answered(Heard::done);
    EXPECT_FALSE(orders.enable(1, start + 1019ms));
    EXPECT_TRUE(orders.enable(1, start + 1020ms));
    orders.want(false, 2);
    ASSERT_TRUE(orders.disable(start + 1030ms)) << "another order waits for none before it";
    EXPECT_TRUE(orders.disable(start + 1040ms));
    orders.answered(Heard::done);
    EXPECT_FALSE(orders.disable(start + 2039ms));
    EXPECT_TRUE(orders.disable(start + 2040ms));
}

TEST(PowerOrders, PowerThatIsLostIsNotOrderedAgainByTheSameWish) {
    auto orders = running();
    orders.seen(false);
    EXPECT_EQ(orders.power_of(), 0);
    EXPECT_FALSE(orders.enable(1, start + 5s));
    EXPECT_TRUE(orders.unclear()) << "the order still stands in the drive";
}

TEST(PowerOrders, PowerThatIsToGoIsStillThatOfItsWish) {
    auto orders = running();
    orders.want(false, 2);
    EXPECT_EQ(orders.power_of(), 1);
    ASSERT_TRUE(orders.disable(start));
    orders.answered(Heard::done);
    orders.seen(true);
    EXPECT_EQ(orders.power_of(), 1);
    orders.seen(false);
    EXPECT_EQ(orders.power_of(), 0);
}

// Off and on again between two questions: the drive was never told.
TEST(PowerOrders, APauseThatTheLineNeverHeardOfIsNone) {
    auto orders = running();
    orders.want(true, 3);
    EXPECT_TRUE(orders.on());
    EXPECT_EQ(orders.power_of(), 3);
}

TEST(PowerOrders, PowerThatSomebodyElseGaveIsNobodysAndIsDisabledFirst) {
    PowerOrders orders;
    orders.seen(true);
    EXPECT_EQ(orders.power_of(), 0);
    EXPECT_FALSE(orders.enable(1, start));
    EXPECT_TRUE(orders.disable(start));
}

TEST(PowerOrders, AnOpenedLineWaitsForRunToGo) {
    PowerOrders orders;
    orders.opened(start);
    orders.seen(true);
    EXPECT_FALSE(orders.enable(1, start + 5s));
    orders.seen(false);
    EXPECT_TRUE(orders.enable(1, start + 5s));
}

}  // namespace
}  // namespace taktwerk::axes::xp200
