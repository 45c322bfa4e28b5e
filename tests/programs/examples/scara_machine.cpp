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

}  // namespace
}  // namespace taktwerk::scara_example
