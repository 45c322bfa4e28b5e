// The engraver makes its plate from G-code: every set-point below the plate's surface is where the drawing has a line, worked out here by hand from the drawing.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::engraver_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

using Flat = std::array<double, 2>;

double off_line(const Flat& p, const Flat& a, const Flat& b) {
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double t = std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

/// On the plate, whose lower left corner is at (40, 30) of the machine: 60 x 40 mm with corners of 5, a ring of 8 about (44, 20), an M.
double off_drawing(const Flat& p) {
    // A rounded rectangle is what is 5 away from the rectangle inside it.
    const double out_x = std::max(std::fabs(p[0] - 30) - 25, 0.0), out_y = std::max(std::fabs(p[1] - 20) - 15, 0.0);
    double off = std::fabs(std::hypot(out_x, out_y) - 5);
    if (out_x == 0 && out_y == 0) off = 1e9;
    off = std::min(off, std::fabs(std::hypot(p[0] - 44, p[1] - 20) - 8));
    const std::array<Flat, 5> letter{{{10, 12}, {10, 28}, {16, 20}, {22, 28}, {22, 12}}};
    for (std::size_t i = 0; i + 1 < letter.size(); ++i) off = std::min(off, off_line(p, letter[i], letter[i + 1]));
    return off;
}

struct Engraved {
    double off = 0, fastest = 0, plates = 0, failed = 0;
    bool always_turning = true, always_blown = true;
    std::vector<Flat> below;   // set-points under the surface
    std::vector<double> bits;  // of all axes, each cycle
    std::string alarms;
};

Engraved engrave(Duration time) {
    Engraved e;
    ExampleMachine m{"engraver"};
    EXPECT_TRUE(m.up());
    Flat before{};
    m.each_cycle = [&] {
        const double x = m.axis("x").set_position, y = m.axis("y").set_position, z = m.axis("z").set_position;
        e.bits.insert(e.bits.end(), {x, y, z});
        // The needle of 30 mm is on the surface (Z0) where the spindle's nose is at -60 + 30.
        if (z < -30.05) {
            const Flat p{x - 40, y - 30};
            e.off = std::max(e.off, off_drawing(p));
            e.below.push_back(p);
            e.always_turning = e.always_turning && m.output("spindle");
            e.always_blown = e.always_blown && m.output("air");
        }
        e.fastest = std::max(e.fastest, std::hypot(x - before[0], y - before[1]) / 1e-3);
        before = {x, y};
    };
    m.until([&] { return false; }, time);
    e.plates = m.variable("plates");
    e.failed = m.variable("failed");
    e.alarms = m.alarms();
    return e;
}

TEST(Engraver, MakesItsPlateFromTheFile) {
    const auto e = engrave(25s);
    EXPECT_EQ(e.alarms, "");
    EXPECT_EQ(e.failed, 0);
    EXPECT_GE(e.plates, 1);
    EXPECT_LE(e.off, 0.02) << "mm: G64 P0.02";
    EXPECT_TRUE(e.always_turning) << "M3 was answered before the needle went down";
    EXPECT_TRUE(e.always_blown);
    // All of it is there: places all around, by hand.
    for (const Flat place :
         {Flat{30, 0}, Flat{60, 20}, Flat{30, 40}, Flat{0, 20}, Flat{30 + 25 + 5 * std::sqrt(0.5), 20 - 15 - 5 * std::sqrt(0.5)},
          Flat{52, 20}, Flat{44, 28}, Flat{36, 20}, Flat{44, 12}}) {
        double nearest = 1e9;
        for (const auto& p : e.below) nearest = std::min(nearest, std::hypot(p[0] - place[0], p[1] - place[1]));
        EXPECT_LT(nearest, 0.05) << place[0] << ' ' << place[1] << ": at 40 mm/s a set-point each 0.04 mm, and P";
    }
    // G61: the corners of the letter are stood at.
    for (const Flat place : {Flat{10, 12}, Flat{10, 28}, Flat{16, 20}, Flat{22, 28}, Flat{22, 12}}) {
        double nearest = 1e9;
        for (const auto& p : e.below) nearest = std::min(nearest, std::hypot(p[0] - place[0], p[1] - place[1]));
        EXPECT_LT(nearest, 1e-9) << place[0] << ' ' << place[1];
    }
}

TEST(Engraver, GivesTheSameBitsEachTime) {
    const auto first = engrave(8s), second = engrave(8s);
    ASSERT_EQ(first.bits.size(), second.bits.size());
    EXPECT_TRUE(first.bits == second.bits);
    EXPECT_FALSE(first.below.empty());
}

// A person stops it, on its way and while it stands at what the path asks for (M3, which the spindle does not answer): it does not begin again by
// itself, and does when it is told to.
TEST(Engraver, BehindAStopItWaitsForAPerson) {
    for (const bool on_its_way : {true, false}) {
        ExampleMachine m{"engraver"};
        ASSERT_TRUE(m.up());
        m.world().set_input("spindle_turns", on_its_way);
        const auto moves = [&] { return m.axis("x").set_velocity != 0 || m.axis("y").set_velocity != 0 || m.axis("z").set_velocity != 0; };
        if (on_its_way) ASSERT_TRUE(m.until([&] { return m.variable("line") > 15 && moves(); }, 20s));
        else ASSERT_TRUE(m.until([&] { return m.output("spindle") && m.variable("waits") != 0; }, 20s));
        m.run(100ms);
        runtime::OperatorCommand halt;
        halt.action = runtime::OperatorAction::group_halt;
        halt.index = 0;
        EXPECT_EQ(m.command(halt).answer, runtime::Answer::accepted);
        m.run(2s);
        EXPECT_FALSE(moves()) << on_its_way;
        EXPECT_EQ(m.variable("engraves"), 0);
        EXPECT_FALSE(m.output("spindle"));
        EXPECT_FALSE(m.output("air"));
        m.world().set_input("spindle_turns", true);
        const auto& variables = m.machine().layout().variables;
        for (std::size_t i = 0; i < variables.size(); ++i) {
            if (variables[i].name != "engraves") continue;
            runtime::OperatorCommand on;
            on.action = runtime::OperatorAction::set_value;
            on.index = static_cast<std::uint16_t>(i);
            on.value = 1;
            on.flag = true;
            EXPECT_EQ(m.command(on).answer, runtime::Answer::accepted);
        }
        EXPECT_TRUE(m.until([&] { return m.variable("plates") >= 1; }, 40s))
            << on_its_way << ' ' << m.variable("line") << ' ' << m.alarms();
    }
}

/// What a person does beside the program's own switches.
struct Hand {
    ExampleMachine& m;
    runtime::Answer order(runtime::OperatorAction action) {
        runtime::OperatorCommand command;
        command.action = action;
        command.index = 0;
        return m.command(command).answer;
    }
    void set(const std::string& name, bool on) {
        const auto& variables = m.machine().layout().variables;
        for (std::size_t i = 0; i < variables.size(); ++i) {
            if (variables[i].name != name) continue;
            runtime::OperatorCommand command;
            command.action = runtime::OperatorAction::set_value;
            command.index = static_cast<std::uint16_t>(i);
            command.value = on ? 1 : 0;
            command.flag = true;
            EXPECT_EQ(m.command(command).answer, runtime::Answer::accepted);
        }
    }
    bool moves() { return m.axis("x").set_velocity != 0 || m.axis("y").set_velocity != 0 || m.axis("z").set_velocity != 0; }
    const runtime::SeenGroup& group() { return m.snapshot().groups[0]; }
};

// The program holds by MC_GroupInterrupt, then a person interrupts, too: MC_GroupContinue does not go on behind him. When he lets it go the program does.
TEST(Engraver, AProgramDoesNotGoOnBehindAPersonsInterruption) {
    ExampleMachine m{"engraver"};
    Hand hand{m};
    ASSERT_TRUE(m.up());
    m.world().set_input("spindle_turns", true);
    ASSERT_TRUE(m.until([&] { return m.variable("line") > 15 && hand.moves(); }, 20s));
    hand.set("holds", true);
    ASSERT_TRUE(m.until([&] { return hand.group().interrupted; }, 2s));
    EXPECT_FALSE(hand.group().held);
    EXPECT_EQ(hand.order(runtime::OperatorAction::group_interrupt), runtime::Answer::accepted);
    EXPECT_TRUE(m.until([&] { return hand.group().held; }, 100ms));
    hand.set("holds", false);
    const double stood = m.axis("x").set_position;
    m.run(1s);
    EXPECT_FALSE(hand.moves());
    EXPECT_EQ(m.axis("x").set_position, stood);
    EXPECT_TRUE(hand.group().interrupted);
    EXPECT_EQ(m.variable("failed"), 0);

    EXPECT_EQ(hand.order(runtime::OperatorAction::group_continue), runtime::Answer::accepted);
    EXPECT_TRUE(m.until([&] { return hand.moves(); }, 1s));
    EXPECT_TRUE(m.until([&] { return m.variable("plates") >= 1; }, 40s)) << m.alarms();
}

// The same while the program still holds: a person who lets go does not go on for it.
TEST(Engraver, APersonWhoLetsGoLeavesTheProgramsInterruption) {
    ExampleMachine m{"engraver"};
    Hand hand{m};
    ASSERT_TRUE(m.up());
    m.world().set_input("spindle_turns", true);
    ASSERT_TRUE(m.until([&] { return m.variable("line") > 15 && hand.moves(); }, 20s));
    hand.set("holds", true);
    ASSERT_TRUE(m.until([&] { return hand.group().interrupted; }, 2s));
    EXPECT_EQ(hand.order(runtime::OperatorAction::group_interrupt), runtime::Answer::accepted);
    EXPECT_EQ(hand.order(runtime::OperatorAction::group_continue), runtime::Answer::accepted);
    m.run(1s);
    EXPECT_FALSE(hand.moves());
    EXPECT_TRUE(hand.group().interrupted);
    EXPECT_FALSE(hand.group().held);
    EXPECT_EQ(hand.order(runtime::OperatorAction::group_continue), runtime::Answer::refused_by_axis) << "it is the program's";
    hand.set("holds", false);
    EXPECT_TRUE(m.until([&] { return hand.moves(); }, 1s));
}

// A person stops it while its program holds it: MC_GroupContinue finds nothing to go on with.
TEST(Engraver, AProgramDoesNotGoOnBehindAPersonsStop) {
    for (const bool stands : {true, false}) {
        ExampleMachine m{"engraver"};
        Hand hand{m};
        ASSERT_TRUE(m.up());
        m.world().set_input("spindle_turns", true);
        ASSERT_TRUE(m.until([&] { return m.variable("line") > 15 && hand.moves(); }, 20s));
        hand.set("holds", true);
        if (stands) ASSERT_TRUE(m.until([&] { return hand.group().interrupted; }, 2s));
        else m.run(3ms);
        EXPECT_EQ(hand.order(runtime::OperatorAction::group_halt), runtime::Answer::accepted);
        m.run(1s);
        hand.set("holds", false);
        const double stood = m.axis("x").set_position;
        m.run(2s);
        EXPECT_FALSE(hand.moves()) << stands;
        EXPECT_EQ(m.axis("x").set_position, stood) << stands;
        EXPECT_FALSE(hand.group().interrupted);
        EXPECT_EQ(m.variable("engraves"), 0) << "it waits for a person";
    }
}

}  // namespace
}  // namespace taktwerk::engraver_example
