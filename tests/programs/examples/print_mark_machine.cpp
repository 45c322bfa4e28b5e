// The print-mark correction by its physics: where the knife really cuts, against where the marks really are.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::print_mark_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

// Of the machine file.
constexpr double first_mark = 20, every = 297.4, nominal = 297, sensor = 200;  // mm
constexpr double turn = 360;                                                   // deg
constexpr double acceleration = 10000, period = 1e-3;                          // of the cutter, deg/s2; s

/// Each cut: how far from the nearest mark the knife came down. Between two cycles both move evenly.
struct Cuts {
    explicit Cuts(ExampleMachine& machine) : m(machine) {
        m.each_cycle = [this] { look(); };
    }
    void look() {
        const double web_now = m.place("web"), cutter_now = m.place("cutter");
        const double turns = std::floor(cutter_now / turn);
        if (seen && turns > std::floor(cutter / turn)) {
            const double cut = web + (web_now - web) * (turns * turn - cutter) / (cutter_now - cutter);
            errors.push_back(std::remainder(cut - sensor - first_mark, every));
        }
        web = web_now, cutter = cutter_now, seen = true;
        const auto& axis = m.axis("cutter");
        if (powered && axis.powered) largest_kink = std::max(largest_kink, std::abs(axis.set_velocity - velocity));
        powered = axis.powered;
        velocity = axis.set_velocity;
    }
    double largest(std::size_t from) const {
        double most = 0;
        for (std::size_t i = from; i < errors.size(); ++i) most = std::max(most, std::abs(errors[i]));
        return most;
    }

    ExampleMachine& m;
    std::vector<double> errors;  // mm
    double web = 0, cutter = 0, velocity = 0, largest_kink = 0;
    bool seen = false, powered = false;
};

// The first mark is under the knife at 20 + 200 = 220 mm of web, the cutter would come to it at 297, 77 mm too late. One correction takes 50 mm
// at most, so the first cut is 27 mm behind its mark; from the second on each is at its mark, although the print is 0.4 mm too long:
// uncorrected, twenty pieces would be 8 mm off.
TEST(PrintMark, CutsAtTheMarksAfterAFewOfThemAndStaysThere) {
    ExampleMachine m{"print_mark"};
    ASSERT_TRUE(m.up());
    Cuts cuts{m};

    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= 26; }, 30s)) << cuts.errors.size() << " cuts; alarms " << m.alarms();

    EXPECT_NEAR(cuts.errors[0], 27, 0.02);
    EXPECT_LT(cuts.largest(1), 0.02);
    EXPECT_NEAR(m.variable("mark_error"), nominal - every, 0.02) << "what the stretched print makes anew from mark to mark";
    EXPECT_TRUE(m.output("in_register"));
    EXPECT_LE(cuts.largest_kink, acceleration * period * 1.000001);
    EXPECT_EQ(m.alarms(), "");
}

TEST(PrintMark, KeepsTheRegisterWhileTheSpeedChanges) {
    ExampleMachine m{"print_mark"};
    ASSERT_TRUE(m.up());
    Cuts cuts{m};
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= 8; }, 30s)) << m.alarms();

    m.set_parameter("speed", 150);
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= 12; }, 30s)) << m.alarms();
    m.set_parameter("speed", 600);
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= 20; }, 30s)) << m.alarms();
    m.world().set_input("run", false);  // and through a stop
    ASSERT_TRUE(m.until([&] { return m.axis("web").set_velocity == 0; }, 10s));
    m.run(200ms);
    m.world().set_input("run", true);
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= 26; }, 30s)) << m.alarms();

    EXPECT_LT(cuts.largest(1), 0.02);
    EXPECT_EQ(m.alarms(), "");
}

// A stretch without print: three marks that do not come are an alarm, the cutter goes on at the nominal length. When there are marks again,
// the search finds them and the alarm goes.
TEST(PrintMark, MissingMarksAreAnAlarmAndAreSearchedForAnew) {
    ExampleMachine m{"print_mark"};
    ASSERT_TRUE(m.up());
    Cuts cuts{m};
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= 8; }, 30s)) << m.alarms();
    const double marks = m.variable("marks");

    m.world().drive("web")->blank(true);
    const auto cut = cuts.errors.size();
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= cut + 2; }, 10s));
    EXPECT_EQ(m.alarms(), "") << "one or two missing marks are none";
    EXPECT_FALSE(m.output("in_register"));
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= cut + 6; }, 10s));
    EXPECT_THAT(m.alarms(), ::testing::HasSubstr("No print mark"));
    EXPECT_LE(m.variable("marks"), marks + 1);
    // Uncorrected: 0.4 mm less with every piece.
    EXPECT_NEAR(cuts.errors[cut + 5] - cuts.errors[cut + 4], nominal - every, 0.02);

    m.world().drive("web")->blank(false);
    const auto again = cuts.errors.size();
    ASSERT_TRUE(m.until([&] { return cuts.errors.size() >= again + 6; }, 10s));
    EXPECT_EQ(m.alarms(), "");
    EXPECT_TRUE(m.output("in_register"));
    EXPECT_LT(cuts.largest(again + 3), 0.02);
}

// Without marks a person trims: 20 mm/s with 200 mm/s2 and the web's 5000 mm/s3. The ramp takes 0.1 s and 200 / 5000 = 0.04 s for its rounded ends, half of
// which are missing in the way: 20 * (0.5 - 0.07) = 8.6 mm when the button is let go after 0.5 s, and 20 * 0.07 = 1.4 mm more on the ramp of the halt. Then the register stays where it was put, 10 mm of web, but for the few cycles of inputs and tasks.
TEST(PrintMark, AButtonTrimsAsLongAsItIsHeldAndItsWayStays) {
    ExampleMachine m{"print_mark"};
    ASSERT_TRUE(m.up());
    m.world().drive("web")->blank(true);
    ASSERT_TRUE(m.until([&] { return m.axis("web").set_velocity > 399.9; }, 10s)) << m.alarms();
    m.run(200ms);
    const auto ahead = [&] { return m.axis("cutter").phase_shift; };
    ASSERT_EQ(ahead(), 0);

    m.world().set_input("trim_ahead", true);
    m.run(500ms);
    EXPECT_NEAR(ahead(), 8.6, 20 * 0.004);
    m.world().set_input("trim_ahead", false);
    m.run(300ms);
    const double trimmed = ahead();
    EXPECT_NEAR(trimmed, 10, 20 * 0.004);
    m.run(2s);
    EXPECT_EQ(ahead(), trimmed);

    m.world().set_input("trim_back", true);
    m.run(500ms);
    m.world().set_input("trim_back", false);
    m.run(300ms);
    EXPECT_NEAR(ahead(), 0, 20 * 0.004);
    EXPECT_EQ(m.axis("cutter").state, axes::AxisState::SynchronizedMotion);
}

}  // namespace
}  // namespace taktwerk::print_mark_example
