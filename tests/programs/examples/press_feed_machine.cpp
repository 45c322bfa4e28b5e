// The press feed by its physics: what the strip does in the closed tool, and how far it goes per stroke.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::press_feed_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

// Of the machine file and the program.
constexpr double closed_from = 120, closed_to = 240;     // deg
constexpr double acceleration = 30000, velocity = 1200;  // mm/s2, mm/s
constexpr double period = 1e-3;                          // s

/// Follows the strip stroke by stroke.
struct Watch {
    explicit Watch(ExampleMachine& machine) : m(machine) {
        m.each_cycle = [this] { look(); };
    }
    void look() {
        const auto &press = m.axis("press"), &feeder = m.axis("feeder");
        const double angle = press.set_position, strip = m.place("feeder");
        const bool closed = angle >= closed_from && angle <= closed_to;
        if (closed && !was_closed) low = high = strip;
        if (closed) {
            low = std::min(low, strip), high = std::max(high, strip);
            slip = std::max(slip, high - low);
            set_slip = std::max(set_slip, std::abs(feeder.set_velocity));
        }
        was_closed = closed;
        if (angle >= 180 && before < 180 && before > 90) {
            strokes.push_back(feeder.set_position);
            actual.push_back(strip);
        }
        before = angle;
        if (powered && feeder.powered) {
            largest_step = std::max(largest_step, std::abs(feeder.set_position - set_position));
            largest_kink = std::max(largest_kink, std::abs(feeder.set_velocity - set_velocity));
        }
        powered = feeder.powered;
        set_position = feeder.set_position;
        set_velocity = feeder.set_velocity;
    }
    /// mm of set strip in the stroke that ended at bottom number n.
    double fed(std::size_t n) const { return strokes[n] - strokes[n - 1]; }

    ExampleMachine& m;
    std::vector<double> strokes, actual;  // strip at each bottom: set, real
    double slip = 0, set_slip = 0, largest_step = 0, largest_kink = 0;
    double low = 0, high = 0, before = 0, set_position = 0, set_velocity = 0;
    bool was_closed = false, powered = false;
};

// 100 strokes of 32.5 mm, at full speed: each is exact, and so is their sum; the strip stands in the closed tool from the first stroke on,
// the one that begins to feed included.
TEST(PressFeed, FeedsTheSameLengthInEachStrokeAndStandsWhileTheToolIsClosed) {
    ExampleMachine m{"press_feed"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    m.set_parameter("strokes", 300);

    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= 104; }, 30s)) << watch.strokes.size() << " strokes; alarms " << m.alarms();

    EXPECT_EQ(watch.strokes[0], watch.strokes[1] - 32.5) << "the cam was entered at the first bottom";
    for (std::size_t i = 1; i < watch.strokes.size(); ++i) {
        EXPECT_NEAR(watch.fed(i), 32.5, 1e-9) << "stroke " << i;
        // The mechanics come to rest a hair short of it, always by the same once the press has its speed.
        if (i > 4) {
            EXPECT_NEAR(watch.actual[i] - watch.actual[i - 1], 32.5, 0.005) << "stroke " << i;
        }
    }
    EXPECT_NEAR(watch.strokes[103] - watch.strokes[3], 3250, 1e-9);
    EXPECT_NEAR(watch.actual[103] - watch.actual[3], 3250, 0.005);
    EXPECT_EQ(watch.set_slip, 0);
    EXPECT_LT(watch.slip, 0.1) << "mm while the tool was closed: the program's tolerance";
    EXPECT_LE(watch.largest_kink, acceleration * period * 1.000001);
    EXPECT_EQ(m.alarms(), "");
}

// Coupled while the press turns, in the middle of what would be a feed: nothing moves before the next bottom, and nothing jumps.
TEST(PressFeed, IsCoupledToATurningPressWithoutAJump) {
    ExampleMachine m{"press_feed"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    m.world().set_input("feed", false);
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= 6; }, 10s)) << m.alarms();
    EXPECT_EQ(watch.strokes[5], watch.strokes[0]) << "not coupled: the strip stands";
    ASSERT_TRUE(m.until([&] { return m.axis("press").set_position > 330; }, 1s));

    m.world().set_input("feed", true);
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= 12; }, 10s)) << m.alarms();

    EXPECT_EQ(watch.strokes[6], watch.strokes[5]) << "the feed it came into is not fed by a part";
    for (std::size_t i = 7; i < 12; ++i) EXPECT_NEAR(watch.fed(i), 32.5, 1e-9);
    EXPECT_EQ(watch.set_slip, 0);
    EXPECT_LT(watch.slip, 0.1);
    EXPECT_LE(watch.largest_step, velocity * period);
    EXPECT_LE(watch.largest_kink, acceleration * period * 1.000001);

    // And released in the middle of a feed: that piece gets its whole length.
    ASSERT_TRUE(m.until([&] { return m.axis("press").set_position > 330; }, 1s));
    m.world().set_input("feed", false);
    const auto last = watch.strokes.size();
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= last + 3; }, 10s)) << m.alarms();
    EXPECT_NEAR(watch.fed(last), 32.5, 1e-9);
    EXPECT_EQ(watch.fed(last + 1), 0);
    EXPECT_LE(watch.largest_kink, acceleration * period * 1.000001);
}

// Another length while it runs: every stroke has the old one or the new one, none a mixture.
TEST(PressFeed, TakesAnotherCamAtABottomWithoutAJump) {
    ExampleMachine m{"press_feed"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= 5; }, 10s)) << m.alarms();
    ASSERT_TRUE(m.until([&] { return m.axis("press").set_position > 350; }, 1s));
    const auto changed = watch.strokes.size();

    m.set_parameter("feed_length", 41.25);
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= changed + 6; }, 10s)) << m.alarms();

    EXPECT_NEAR(watch.fed(changed - 1), 32.5, 1e-9);
    EXPECT_NEAR(watch.fed(changed), 32.5, 1e-9) << "had begun with the old cam";
    for (std::size_t i = changed + 1; i < watch.strokes.size(); ++i) EXPECT_NEAR(watch.fed(i), 41.25, 1e-9) << i;
    EXPECT_EQ(watch.set_slip, 0);
    EXPECT_LT(watch.slip, 0.1);
    EXPECT_LE(watch.largest_kink, acceleration * period * 1.000001);
    EXPECT_EQ(m.alarms(), "");
}

// The press stops at its top, in the middle of a feed. The strip is then where the cam has it at 0 degrees, and the stroke goes on with the press: 32.5 mm
// from bottom to bottom. By hand: from rest at 280 to rest at 440 degrees, 360 is the middle, half of the length.
TEST(PressFeed, StopsAndGoesOnInStepWithThePress) {
    ExampleMachine m{"press_feed"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= 5; }, 10s)) << m.alarms();

    m.world().set_input("run", false);
    ASSERT_TRUE(m.until([&] { return m.axis("press").state == axes::AxisState::Standstill; }, 5s)) << m.alarms();
    m.run(200ms);
    EXPECT_NEAR(m.axis("press").set_position, 0, 1e-9);
    EXPECT_NEAR(m.axis("feeder").set_position - watch.strokes.back(), 32.5 / 2, 1e-9);
    EXPECT_NEAR(m.place("feeder") - watch.actual.back(), 32.5 / 2, 0.02);

    m.world().set_input("run", true);
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= 12; }, 10s)) << m.alarms();
    for (std::size_t i = 1; i < watch.strokes.size(); ++i) EXPECT_NEAR(watch.fed(i), 32.5, 1e-9) << i;
    EXPECT_LE(watch.largest_kink, acceleration * period * 1.000001);
    EXPECT_EQ(m.alarms(), "");
}

// The mechanics of the feeder stick: the strip is not where it should be when the tool closes, and goes there in the closed tool.
TEST(PressFeed, StopsThePressWhenTheStripMovesInTheClosedTool) {
    ExampleMachine m{"press_feed"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    ASSERT_TRUE(m.until([&] { return watch.strokes.size() >= 3; }, 10s)) << m.alarms();
    // Jammed for the last 3 % of a feed, one millimetre, and let go as the tool closes.
    ASSERT_TRUE(m.until([&] { return m.axis("press").set_position > 50 && m.axis("press").set_position < 60; }, 1s));
    m.world().drive("feeder")->jam(true);
    ASSERT_TRUE(m.until([&] { return m.axis("press").set_position > closed_from; }, 1s));
    m.world().drive("feeder")->jam(false);

    EXPECT_TRUE(m.until([&] { return m.axis("press").set_velocity == 0; }, 3s)) << "the press turns on; alarms " << m.alarms();
    EXPECT_THAT(m.alarms(), ::testing::HasSubstr("The strip moved while the tool was closed"));
}

}  // namespace
}  // namespace taktwerk::press_feed_example
