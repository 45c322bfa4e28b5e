// Each box lies on the pallet where the pattern has it, turned as it should be, and was let down between its neighbours without touching them. Positions
// come from the motors of the simulated drives, through two
// links by hand; of the program nothing is asked but its output for the gripper.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/programs/examples/watched_machine.hpp"

namespace taktwerk::palletizer_example {
namespace {

using namespace std::chrono_literals;
using testing::WatchedMachine;

constexpr double degree = std::numbers::pi / 180;

struct Tool {
    double x, y, z, turned;  ///< mm, deg
};
/// Links of 325 and 275 mm, the flange at 400 mm where the lift is at 0; the tool is 30 mm in front of it and 80 mm below.
Tool forward(double shoulder, double elbow, double lift, double wrist) {
    const double a = shoulder * degree, b = a + elbow * degree, c = b + wrist * degree;
    return {325 * std::cos(a) + 275 * std::cos(b) + 30 * std::cos(c), 325 * std::sin(a) + 275 * std::sin(b) + 30 * std::sin(c),
            400 + lift - 80, shoulder + elbow + wrist};
}
/// Of a point in the machine: in the pallet's frame, which is at (260, 130, 50), turned by 15 degrees.
Tool on_pallet(const Tool& t) {
    const double x = t.x - 260, y = t.y - 130, c = std::cos(15 * degree), s = std::sin(15 * degree);
    return {c * x + s * y, -s * x + c * y, t.z - 50, t.turned - 15};
}
/// The drawing of the two layers, written down box by box: 60 x 40 mm, middle and turn.
struct Drawn {
    double x, y, turned;
};
constexpr std::array<std::array<Drawn, 6>, 2> layers{{
    {{{30, 20, 0}, {90, 20, 0}, {30, 60, 0}, {90, 60, 0}, {30, 100, 0}, {90, 100, 0}}},
    {{{20, 30, 90}, {60, 30, 90}, {100, 30, 90}, {20, 90, 90}, {60, 90, 90}, {100, 90, 90}}},
}};

struct Stack {
    std::vector<Tool> taken, laid;  ///< in the machine; on the pallet
    std::vector<double> rubbed;     ///< mm, of each box: how far it came into a neighbour at the worst
    std::vector<double> bits;
    std::string alarms;
    double pallets = 0;
};

class Arm {
public:
    Arm() { EXPECT_TRUE(m.up()); }
    Tool at() { return forward(m.place("shoulder"), m.place("elbow"), m.place("lift"), m.place("wrist")); }
    void look(Stack& stack) {
        for (const char* name : {"shoulder", "elbow", "lift", "wrist"}) stack.bits.push_back(m.view(name).set_position);
        const bool holds = m.output("grip");
        const auto now = on_pallet(at());
        if (holds && !held_) {
            stack.taken.push_back(at());
            stack.rubbed.push_back(0);
        }
        if (!holds && held_) stack.laid.push_back(now);
        // While its bottom is lower than a neighbour's top it is at its place or on the free side of it, which is where X and Y are greater: the pattern
        // is filled that way.
        if (const auto box = stack.laid.size(); holds && box < 18) {
            const auto& place = layers[box / 6 % 2][box % 6];
            const double top = 30.0 * static_cast<double>(box / 6 + 1);
            const bool over_pallet = std::hypot(now.x - place.x, now.y - place.y) < 60;
            if (over_pallet && now.z < top + 30) stack.rubbed.back() = std::max({stack.rubbed.back(), place.x - now.x, place.y - now.y});
        }
        held_ = holds;
    }
    Stack work(Duration time) {
        Stack stack;
        m.until([&] { return look(stack), false; }, time);
        stack.alarms = m.alarms();
        stack.pallets = m.variable("pallets");
        return stack;
    }

    WatchedMachine m{"palletizer"};

private:
    bool held_ = false;
};

void expect_laid(const Tool& box, std::size_t n) {
    const auto& place = layers[n / 6 % 2][n % 6];
    const double top = 30.0 * static_cast<double>(n / 6 + 1);
    EXPECT_NEAR(box.x, place.x, 0.1) << "mm, box " << n;
    EXPECT_NEAR(box.y, place.y, 0.1) << "mm, box " << n;
    EXPECT_NEAR(box.z, top + 0.5, 0.1) << "mm, box " << n << " falls the last half millimetre";
    EXPECT_NEAR(std::remainder(box.turned - place.turned, 360), 0, 0.05) << "deg, box " << n;
}

TEST(Palletizer, StacksThreeLayersWhereThePatternHasThem) {
    Arm arm;
    const auto stack = arm.work(90s);
    EXPECT_EQ(stack.alarms, "");
    EXPECT_GE(stack.pallets, 1);
    ASSERT_GE(stack.laid.size(), 18u);
    for (std::size_t i = 0; i < 18; ++i) {
        expect_laid(stack.laid[i], i);
        EXPECT_LE(stack.rubbed[i], 0.1) << "mm, box " << i;
    }
    for (const auto& box : stack.taken) {
        EXPECT_NEAR(box.x, 250, 0.1);
        EXPECT_NEAR(box.y, -320, 0.1);
        EXPECT_NEAR(box.z, 130, 0.1);
        EXPECT_NEAR(std::remainder(box.turned, 360), 0, 0.05);
    }
}

TEST(Palletizer, GivesTheSameBitsEachTime) {
    const auto first = Arm{}.work(10s), second = Arm{}.work(10s);
    ASSERT_EQ(first.bits.size(), second.bits.size());
    EXPECT_TRUE(first.bits == second.bits);
    EXPECT_GE(first.laid.size(), 1u);
}

// The pallet stands somewhere else than the file says: somebody measures it and writes it down, and the pattern goes with it.
TEST(Palletizer, ThePatternGoesWithThePallet) {
    Arm arm;
    const auto& parameters = arm.m.machine->layout().parameters;
    for (const auto& [name, value] : {std::pair<std::string, double>{"pallet_x", 270}, {"pallet_turned", 15}})
        for (std::size_t i = 0; i < parameters.size(); ++i)
            if (parameters[i].name == name) {
                EXPECT_EQ(arm.m.command(runtime::OperatorAction::set_parameter, static_cast<std::uint16_t>(i), false, value).answer,
                          runtime::Answer::accepted);
            }
    const auto stack = arm.work(12s);
    ASSERT_GE(stack.laid.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        auto moved = stack.laid[i];
        moved.x -= 10 * std::cos(15 * degree);  // 10 mm along X of the machine, seen from the pallet's frame
        moved.y += 10 * std::sin(15 * degree);
        expect_laid(moved, i);
    }
}

// An axis fails while a box hangs on the gripper: it is not let go, and after a reset it comes where it was meant to.
TEST(Palletizer, AFaultWithABoxInTheAirEndsInItsPlace) {
    Arm arm;
    auto& m = arm.m;
    Stack stack;
    ASSERT_TRUE(m.until([&] { return arm.look(stack), stack.taken.size() == 3 && arm.at().y > -50; }, 30s));
    m.world.drive("elbow")->raise(0x2310);
    m.until([&] { return arm.look(stack), false; }, 2s);
    EXPECT_EQ(m.group().state, axes::GroupState::GroupErrorStop);
    EXPECT_TRUE(m.output("grip"));
    EXPECT_NE(m.alarms().find("waits for a person"), std::string::npos) << m.alarms();

    ASSERT_TRUE(m.reset_until([&] { return m.group().state == axes::GroupState::GroupStandby; }, 10s)) << m.alarms();
    m.set_switch("works", true);
    ASSERT_TRUE(m.until([&] { return arm.look(stack), stack.laid.size() == 5; }, 40s)) << m.alarms();
    EXPECT_EQ(stack.taken.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) expect_laid(stack.laid[i], i);
    EXPECT_EQ(m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::palletizer_example
