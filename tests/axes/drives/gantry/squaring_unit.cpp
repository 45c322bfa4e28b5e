// Homing squares a portal: each side has a home switch, and the follower is led until both are at their edges.

#include "tests/axes/drives/gantry/portal_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double pace = 2;  // u/s; 2 counts a cycle

AxisConfig squared(double offset = 0) {
    auto config = portal();
    config.homing = homing_by(HomingKind::home_switch).homing;
    config.homing.negative = true;
    config.gantry.square_velocity = pace;
    config.gantry.square_offset = offset;
    return config;
}

/// The leader's switch is on below -10 u; the follower's edge lies `racked` counts further than it would if the sides were square.
struct Racked : Portal {
    explicit Racked(std::int64_t racked, bool turned = false, double offset = 0) : Portal(turned, squared(offset)), mirrored(turned) {
        left->switches = right->switches = true;
        left->home_low = -1'000'000;
        left->home_high = -10'000;
        const std::int64_t edge = -10'000 + racked;
        right->home_low = mirrored ? 5000 - edge : -1'000'000;
        right->home_high = mirrored ? 1'000'000 : 5000 + edge;
    }
    /// Counts that the follower is ahead of the leader of where it was at the start, as the motors stand.
    [[nodiscard]] double ahead() const { return (mirrored ? -1 : 1) * (right->position - 5000) - left->position; }
    void home() {
        power_on();
        EXPECT_EQ(axis.submit(test::home(0), Owner::program).error, ErrorId::none);
    }
    /// Step by step until the condition: how fast and how abruptly the follower was led beside the leader, counts per cycle.
    bool watched_until(const std::function<bool()>& condition, int most = 20000) {
        for (int i = 0; i < most && !condition(); ++i) {
            const double before = ahead();
            step();
            const double led = ahead() - before;
            fastest = std::max(fastest, std::abs(led));
            roughest = std::max(roughest, std::abs(led - last_led));
            last_led = led;
        }
        return condition();
    }
    bool mirrored;
    double fastest = 0, roughest = 0, last_led = 0;
};

TEST(Squaring, LeadsTheFollowerUntilBothSidesAreAtTheirEdges) {
    for (const bool mirrored : {false, true})
        for (const std::int64_t racked : {-400, -3, 0, 3, 400}) {
            SCOPED_TRACE(testing::Message() << racked << (mirrored ? " mirrored" : ""));
            Racked rig(racked, mirrored);
            rig.home();
            ASSERT_TRUE(rig.watched_until([&] { return rig.view().homed && rig.view().state == AxisState::Standstill; }));
            rig.run(10);
            EXPECT_NEAR(rig.ahead(), static_cast<double>(racked), 1.5) << "an edge is seen in the cycle after it";
            EXPECT_NEAR(rig.left->position, -10000 + rig.view().actual_position * 1000, 2) << "the leader's edge is the reference";
            EXPECT_NEAR(rig.view().skew, 0, 0.001);
            EXPECT_LE(rig.fastest, pace + 1) << "rounded to counts";
            EXPECT_LE(rig.roughest, 1 + 1) << "with ramps, rounded to counts";
            EXPECT_FALSE(rig.raised(AxisAlarm::gantry_skew));
            EXPECT_EQ(rig.raised(AxisAlarm::gantry_skew_warning), std::abs(racked) > 200) << "how racked it was is said";
            EXPECT_TRUE(rig.axis.active_alarms().empty());
        }
}

TEST(Squaring, TheSwitchesMayStandApart) {
    Racked rig(1300, false, 1.0);  // 1 u of it is how they are mounted
    rig.home();
    ASSERT_TRUE(rig.watched_until([&] { return rig.view().homed && rig.view().state == AxisState::Standstill; }));
    EXPECT_NEAR(rig.ahead(), 300, 1.5);
}

TEST(Squaring, MoreThanThePortalBearsIsNotForced) {
    Racked rig(700);
    rig.home();
    ASSERT_TRUE(rig.watched_until([&] { return rig.view().state == AxisState::ErrorStop; }));
    rig.run(2000);
    EXPECT_TRUE(rig.raised(AxisAlarm::gantry_skew));
    EXPECT_FALSE(rig.view().homed);
    EXPECT_EQ(rig.ahead(), 0) << "neither side is led anywhere";
}

TEST(Squaring, AStopStopsTheFollowerToo) {
    Racked rig(400);
    rig.home();
    ASSERT_TRUE(rig.watched_until([&] { return rig.ahead() > 150; }));
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    EXPECT_EQ(rig.axis.submit(stop(), Owner::program).error, ErrorId::none);
    rig.run(110);  // its ramp takes 0.1 s
    const double stands = rig.ahead();
    EXPECT_LT(stands, 150 + 110);
    rig.run(500);
    EXPECT_EQ(rig.ahead(), stands);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_NEAR(rig.view().skew, (stands - 400) / 1000, 0.002) << "how far it is from square is known by now";
}

TEST(Squaring, IsKeptWithoutPowerAndDoneAgainWhenPowerComes) {
    Racked rig(300);
    rig.home();
    ASSERT_TRUE(rig.watched_until([&] { return rig.view().homed && rig.view().state == AxisState::Standstill; }));
    rig.enable = false;
    rig.run(20);
    rig.right->position += 250;  // somebody leans on it
    rig.power_on();
    rig.run(3);
    EXPECT_NEAR(rig.view().skew, 0.25, 0.01);
    rig.right->largest_step = 0;
    rig.fastest = 0;
    rig.last_led = 0;
    ASSERT_TRUE(rig.watched_until([&] { return rig.view().skew == 0; }, 1000));
    EXPECT_LE(rig.fastest, pace + 1);
    EXPECT_NEAR(rig.ahead(), 300, 1.5);

    // More than it bears: no motion is begun with it.
    rig.enable = false;
    rig.run(20);
    rig.right->position -= 800;
    rig.enable = true;
    rig.run(100);
    EXPECT_TRUE(rig.raised(AxisAlarm::gantry_skew));
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
}

TEST(Squaring, IsForgottenWhenADriveHasBeenAway) {
    Racked rig(300);
    rig.home();
    ASSERT_TRUE(rig.watched_until([&] { return rig.view().homed && rig.view().state == AxisState::Standstill; }));
    rig.enable = false;
    rig.run(20);
    rig.right->position += 250;
    ++rig.right->epoch;  // its counts may begin anywhere now
    rig.power_on();
    rig.run(500);
    EXPECT_EQ(rig.view().skew, 0) << "from where it was when power came";
    EXPECT_NEAR(rig.ahead(), 550, 1.5);
}

TEST(Squaring, NeedsASwitchOnEachSide) {
    auto config = squared();
    EXPECT_TRUE(check(config).empty());
    config.homing.kind = HomingKind::set_here;
    ASSERT_EQ(check(config).size(), 1u);
    EXPECT_EQ(check(config)[0].subject, "axes.x.gantry.square");
}

}  // namespace
}  // namespace taktwerk::axes::test
