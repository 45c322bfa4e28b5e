// The arm of the five drives picks parts from its belt, by what really happens: where the gripper closes, where the parts are then, and where they are laid down.

#include <random>

#include "tests/programs/examples/belt_eye.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::belt_picking_example {
namespace {

using namespace std::chrono_literals;
using testing::BeltEye;
using testing::Events;
using testing::ExampleMachine;
using testing::Place;

// Belt and joints are behind their set-points by the dead time of their drives, which may differ by a cycle: that much of the belt's way, 0.08 mm at
// 80 mm/s. Who took the belt's actual position for the one that the arm follows would be two cycles off. Joints' gears and probe count far finer.
constexpr double period = 1e-3, on_the_part = 0.08, along_with_it = 2;  // s, mm, mm/s

void expect_on_parts(const BeltEye& eye) {
    for (const auto& grip : eye.grips) {
        EXPECT_LE(grip.along, std::max(on_the_part / 2, period * grip.belt)) << "part " << grip.part;
        EXPECT_LE(grip.across, on_the_part) << "part " << grip.part;
        EXPECT_LE(grip.up, on_the_part) << "part " << grip.part;
        if (grip.lifted) {  // else something failed: a drive may have let go of its motor just before the gripper opened
            EXPECT_LE(grip.slip, along_with_it) << "part " << grip.part;
        }
        EXPECT_LE(grip.tilt, 1e-3) << "part " << grip.part;
    }
    for (std::size_t i = 1; i < eye.grips.size(); ++i) EXPECT_GT(eye.grips[i].part, eye.grips[i - 1].part) << "no part twice";
}

// Three columns and two rows, 60 mm apart, from (40, 400, 280) on: by the machine file and the program.
void expect_on_tray(const std::vector<Place>& placed) {
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const double column = static_cast<double>(i % 3), row = static_cast<double>(i / 3 % 2);
        EXPECT_NEAR(placed[i][0], 40 + 60 * column, 0.05) << i;
        EXPECT_NEAR(placed[i][1], 400 + 60 * row, 0.05) << i;
        EXPECT_NEAR(placed[i][2], 280, 0.05) << i;
    }
}

// A part comes each 500 mm: at 80 mm/s each 6.25 s.
TEST(BeltPicking, PicksEachPartWhereTheBeltHasItAndFillsTheTray) {
    ExampleMachine m{"five-drives", Events::left_out};
    ASSERT_TRUE(m.up());
    BeltEye eye{m};
    ASSERT_TRUE(m.until([&] { return m.variable("placed") >= 8; }, 60s))
        << m.variable("step") << ' ' << m.variable("placed") << ' ' << m.variable("missed") << ' ' << m.alarms();
    EXPECT_EQ(m.alarms(), "");
    EXPECT_EQ(m.variable("missed"), 0);
    EXPECT_EQ(eye.grips.size(), m.variable("picked"));
    EXPECT_EQ(eye.placed.size(), 8u);
    expect_on_parts(eye);
    expect_on_tray(eye.placed);
    for (std::size_t i = 0; i < eye.grips.size(); ++i) {
        EXPECT_EQ(eye.grips[i].part, static_cast<long>(i)) << "one after the other, the first one first";
        EXPECT_NEAR(eye.grips[i].belt, 80, 1) << "it ran meanwhile";
    }
    EXPECT_TRUE(eye.clean()) << eye.report();
    EXPECT_GT(eye.compared(), 30'000);
}

// While the arm goes down, grips and lifts: the parts stay where the belt has them. At 120 mm/s they come faster than the arm, and some pass by.
TEST(BeltPicking, TheBeltMayChangeItsSpeedMeanwhile) {
    ExampleMachine m{"five-drives", Events::left_out};
    ASSERT_TRUE(m.up());
    BeltEye eye{m};
    std::mt19937 random{7};
    double least = 1e9, most = 0;
    for (int i = 0; i < 120; ++i) {
        m.set_parameter("belt_speed", 20 + static_cast<double>(random() % 101));
        m.run(1ms * (100 + random() % 800));
    }
    for (const auto& grip : eye.grips) {
        EXPECT_TRUE(grip.lifted) << "part " << grip.part;
        least = std::min(least, grip.belt);
        most = std::max(most, grip.belt);
    }
    expect_on_parts(eye);
    EXPECT_GE(eye.grips.size(), 5u);
    EXPECT_GT(most - least, 20) << "mm/s";
    EXPECT_EQ(m.alarms(), "");
    EXPECT_EQ(m.variable("arm_failures"), 0);
    EXPECT_TRUE(eye.clean()) << eye.report();
}

TEST(BeltPicking, GivesTheSameBitsEachTimeThroughAllFaults) {
    std::vector<double> bits[2];
    for (auto& once : bits) {
        ExampleMachine m{"five-drives"};
        ASSERT_TRUE(m.up());
        BeltEye eye{m};
        eye.keep_bits = true;
        m.run(25s);
        EXPECT_GT(m.variable("picked"), 1);
        EXPECT_EQ(m.variable("arm_failures"), 3);
        once = std::move(eye.bits);
    }
    EXPECT_GE(bits[0].size(), 7u * 25'000u);
    EXPECT_TRUE(bits[0] == bits[1]);
}

/// Of the program: what `step` shows.
enum Step { stand, rise, fold, home, wait, sight, pick, grip, lift, place, let_go, leave };

struct Fault {
    const char* axis;
    std::uint16_t code;
    int at;          ///< a step of the program
    Duration later;  ///< after its beginning
};
std::string words(const ::testing::TestParamInfo<Fault>& info) {
    constexpr std::array names{"stand", "rise", "fold", "home", "wait", "sight", "pick", "grip", "lift", "place", "let_go", "leave"};
    return std::string(info.param.axis) + "_in_" + names[static_cast<std::size_t>(info.param.at)] + "_after_" +
           std::to_string(info.param.later / 1ms) + "ms";
}

class BeltPickingFault : public ::testing::TestWithParam<Fault> {};

// Whatever the arm is at: nothing jumps, a part that is not lifted yet is let go while it is on the belt, one that is held is placed, and it picks on.
TEST_P(BeltPickingFault, NothingJumpsAndItPicksOn) {
    const auto fault = GetParam();
    ExampleMachine m{"five-drives", Events::left_out};
    ASSERT_TRUE(m.up());
    BeltEye eye{m};
    ASSERT_TRUE(m.until([&] { return m.variable("placed") >= 1 && m.variable("step") == fault.at; }, 20s)) << m.alarms();
    m.run(fault.later);
    ASSERT_EQ(m.variable("step"), fault.at) << "the step is shorter than the test thinks";
    const double picked = m.variable("picked"), placed = m.variable("placed");
    const bool held =
        m.output("gripper") && (fault.at == place || (fault.at == lift && eye.tool()[2] > BeltEye::height + BeltEye::off_belt));
    m.world().drive(fault.axis)->raise(fault.code);
    m.run(100ms);
    const bool follows = fault.at >= pick && fault.at <= lift;
    const bool arm_fails = std::string_view(fault.axis) != "belt" || follows;
    EXPECT_EQ(m.variable("arm_failures"), arm_fails ? 1 : 0) << m.alarms();
    if (arm_fails) {
        EXPECT_EQ(m.output("gripper"), held);
    }

    EXPECT_TRUE(m.until([&] { return m.variable("placed") >= placed + 2; }, 40s)) << m.variable("step") << ' ' << m.alarms();
    EXPECT_EQ(m.variable("arm_recoveries"), m.variable("arm_failures"));
    EXPECT_GE(m.variable("picked"), picked + (held ? 1 : 2)) << "what was held is among those placed";
    expect_on_parts(eye);
    EXPECT_EQ(m.alarms(), "");
    EXPECT_TRUE(eye.clean()) << eye.report();
    // What a person is told of the limits is told of set-points: a motor that runs out without power breaks no limit of the path.
    EXPECT_LE(eye.most_used, 1 + 1e-6);
    EXPECT_LE(eye.most_jerk, 1 + 1e-3);
    EXPECT_GT(eye.most_used, 0.1);
    expect_on_tray(eye.placed);
}

INSTANTIATE_TEST_SUITE_P(Moments, BeltPickingFault,
                         ::testing::Values(Fault{"j3", 12, home, 200ms}, Fault{"j3", 12, wait, 100ms}, Fault{"j3", 12, pick, 100ms},
                                           Fault{"j3", 12, pick, 400ms}, Fault{"j3", 12, grip, 50ms}, Fault{"j3", 12, lift, 50ms},
                                           Fault{"j3", 12, lift, 300ms}, Fault{"j3", 12, place, 50ms}, Fault{"j3", 12, leave, 100ms},
                                           Fault{"j1", 72, pick, 400ms}, Fault{"j1", 72, grip, 50ms}, Fault{"j1", 72, home, 100ms},
                                           Fault{"belt", 0x3130, wait, 100ms}, Fault{"belt", 0x3130, pick, 400ms},
                                           Fault{"belt", 0x3130, grip, 50ms}, Fault{"belt", 0x3130, lift, 50ms},
                                           Fault{"belt", 0x3130, lift, 300ms}, Fault{"belt", 0x3130, place, 50ms}),
                         words);

// Drives of arm and belt fail at drawn moments, again and again, also while the machine comes back. TAKTWERK_SOAK_FACTOR=45: half an hour.
TEST(BeltPicking, FaultsAtAnyMoment) {
    std::mt19937 random{2027};
    const auto below = [&](std::uint32_t most) { return random() % most; };
    ExampleMachine m{"five-drives"};
    ASSERT_TRUE(m.up());
    BeltEye eye{m};
    const auto seconds = property_cases(40);
    double placed = 0;
    int faults = 0;
    for (std::size_t second = 0; second < seconds;) {
        const auto pause = 500ms + 1ms * below(9000);
        m.run(pause);
        second += static_cast<std::size_t>(pause / 1s) + 1;
        const auto which = below(8);
        if (which == 7) m.world().drive("belt")->raise(0x3130);
        else if (which == 6) m.world().drive("j1")->raise(72);
        else m.world().drive(BeltEye::axes[which])->raise(12);
        ++faults;
        ASSERT_TRUE(eye.clean()) << eye.report();
        // Where nothing else fails it works again: a part each 6.25 s.
        if (below(4) != 0) continue;
        placed = m.variable("placed");
        ASSERT_TRUE(m.until([&] { return m.variable("placed") > placed; }, 20s))
            << "step " << m.variable("step") << ", " << faults << " faults; " << m.alarms();
        second += 5;
    }
    EXPECT_TRUE(m.until([&] { return m.variable("arm_recoveries") == m.variable("arm_failures"); }, 10s)) << m.alarms();
    EXPECT_GT(m.variable("arm_failures"), 2);
    EXPECT_GT(eye.placed.size(), 1u);
    expect_on_parts(eye);
    expect_on_tray(eye.placed);
}

}  // namespace
}  // namespace taktwerk::belt_picking_example
