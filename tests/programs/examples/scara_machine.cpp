// The SCARA draws its slot: every set-point of the tool is where the lines and half circles are, but for the curves at their corners.

#include <cmath>
#include <numbers>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::scara_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

struct Drawn {
    double off = 0, fastest = 0, turned = 0, laps = 0;
    std::vector<double> bits;  // set positions of all axes, each cycle
    std::string alarms;
};

Drawn draw(Duration time) {
    Drawn d;
    ExampleMachine m{"scara"};
    EXPECT_TRUE(m.up());
    double before[2] = {0, 0};
    bool drawing = false;
    m.each_cycle = [&] {
        // By hand: two links of 200 and 150 mm.
        const double degree = std::numbers::pi / 180;
        const double a = m.axis("shoulder").set_position * degree, b = a + m.axis("elbow").set_position * degree;
        const double x = 200 * std::cos(a) + 150 * std::cos(b), y = 200 * std::sin(a) + 150 * std::sin(b);
        for (const char* name : {"shoulder", "elbow", "lift", "wrist"}) d.bits.push_back(m.axis(name).set_position);
        // Of the slot: distance from the line between both centres is 20.
        const double past = std::abs(y) > 60 ? std::hypot(x - 240, std::abs(y) - 60) : std::abs(x - 240);
        drawing = drawing || (std::abs(past - 20) < 1e-6 && m.axis("shoulder").set_velocity != 0);
        if (drawing) {
            d.off = std::max(d.off, std::abs(past - 20));
            d.fastest = std::max(d.fastest, std::hypot(x - before[0], y - before[1]) / 1e-3);
            d.turned = std::max(d.turned, std::abs(std::remainder(b / degree + m.axis("wrist").set_position, 360)));
        }
        before[0] = x;
        before[1] = y;
    };
    m.until([&] { return false; }, time);
    d.laps = m.variable("laps");
    EXPECT_EQ(m.variable("failed"), 0);
    d.alarms = m.alarms();
    return d;
}

TEST(Scara, DrawsItsSlotAndKeepsTheToolsDirection) {
    const auto d = draw(12s);
    EXPECT_EQ(d.alarms, "");
    EXPECT_GE(d.laps, 3);
    EXPECT_LE(d.off, 0.5) << "mm: the curve between a line and the arc of 20 that it touches, 6 mm to either side";
    EXPECT_LE(d.fastest, 200 * (1 + 1e-6));
    EXPECT_GE(d.fastest, 150);
    EXPECT_LE(d.turned, 1e-6) << "degrees";
}

TEST(Scara, GivesTheSameBitsEachTime) {
    const auto first = draw(5s), second = draw(5s);
    ASSERT_EQ(first.bits.size(), second.bits.size());
    EXPECT_TRUE(first.bits == second.bits);
    EXPECT_GT(first.laps, 0);
}

// A person stops it on its way to the slot or in a lap of it: it does not begin again by itself, and does when it is told to.
TEST(Scara, BehindAStopItWaitsForAPerson) {
    for (const bool in_a_lap : {true, false}) {
        ExampleMachine m{"scara"};
        ASSERT_TRUE(m.up());
        const auto moves = [&] { return m.axis("shoulder").set_velocity != 0 || m.axis("elbow").set_velocity != 0; };
        ASSERT_TRUE(
            m.until([&] { return m.variable("laps") >= (in_a_lap ? 1 : 0) && m.snapshot().groups[0].active != 0 && moves(); }, 20s));
        m.run(30ms);
        runtime::OperatorCommand halt;
        halt.action = runtime::OperatorAction::group_halt;
        halt.index = 0;
        EXPECT_EQ(m.command(halt).answer, runtime::Answer::accepted);
        m.run(1s);
        const double stood = m.axis("shoulder").set_position;
        m.run(2s);
        EXPECT_EQ(m.axis("shoulder").set_position, stood) << in_a_lap;
        EXPECT_EQ(m.variable("draws"), 0);
        EXPECT_EQ(m.variable("failed"), 0) << "a stop is no failure";
        const auto& variables = m.machine().layout().variables;
        for (std::size_t i = 0; i < variables.size(); ++i) {
            if (variables[i].name != "draws") continue;
            runtime::OperatorCommand on;
            on.action = runtime::OperatorAction::set_value;
            on.index = static_cast<std::uint16_t>(i);
            on.value = 1;
            on.flag = true;
            EXPECT_EQ(m.command(on).answer, runtime::Answer::accepted);
        }
        const double laps = m.variable("laps");
        EXPECT_TRUE(m.until([&] { return m.variable("laps") > laps; }, 20s)) << m.alarms();
    }
}

}  // namespace
}  // namespace taktwerk::scara_example
