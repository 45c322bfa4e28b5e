// Chosen reactions on simulated drives, over real frames: what the drive is told, what the machine does, what people read. A jog at 50 mm/s that nobody
// renews stands for any alarm.

#include "axes/axis/alarms.hpp"
#include "axes/drives/cia402/words.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisAlarm;
using axes::AxisState;
using axes::ErrorReaction;

struct Reacting : ::testing::Test {
    std::unique_ptr<TestMachine> machine;
    bool told_quick_stop = false, in_quick_stop = false, let_go_in_motion = false;
    double fastest_let_go = 0;

    void jog_until_it_fails(ErrorReaction reaction) {
        auto config = machine_config(2);
        config.axes[0].axis.reactions.choose(AxisAlarm::jog_lease_expired, reaction);
        machine = std::make_unique<TestMachine>(std::move(config));
        ASSERT_TRUE(m().up());
        for (std::uint16_t i = 0; i < 2; ++i) m().enable(i);
        for (std::uint16_t i = 0; i < 2; ++i) m().home(i);
        ASSERT_EQ(m().command(OperatorAction::jog, 0, true, 50).answer, Answer::accepted);
        ASSERT_TRUE(m().until([&] { return m().axis(0).actual_velocity > 45; }, 150ms));
        m().on_cycle = [this] {
            const auto word = m().told(0).control;
            told_quick_stop = told_quick_stop || (word & 0x86u) == axes::cia402::quick_stop;
            in_quick_stop = in_quick_stop || m().axis(0).drive_state == axes::PowerState::quick_stop;
            const bool off = m().axis(0).drive_state == axes::PowerState::disabled || m().axis(0).drive_state == axes::PowerState::ready;
            if (off) fastest_let_go = std::max(fastest_let_go, std::abs(m().axis(0).actual_velocity));
        };
        ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 1s));
    }
    TestMachine& m() { return *machine; }
    std::string reaction() {
        const auto& s = m().state();
        for (std::size_t i = 0; i < s.alarm_count; ++i)
            if (s.alarms[i].fact.id == id(AxisAlarm::jog_lease_expired)) {
                const auto words = m().machine->describe(s.alarms[i].fact);
                return words.reaction + " (" + words.reset + ")";
            }
        return {};
    }
    /// It is reset, gets power and moves again.
    void recover() {
        m().on_cycle = {};
        EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
        EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled || m().axis(0).state == AxisState::Standstill; }, 3s));
        m().enable(0);
        EXPECT_EQ(m().command(OperatorAction::move_absolute, 0, false, 100, 150).answer, Answer::accepted) << m().alarms();
        EXPECT_TRUE(m().until([&] { return m().axis(0).in_position && m().axis(0).set_position == 100; }, 15s)) << m().alarms();
        m().expect_no_jump();
    }
};

TEST_F(Reacting, QuickStopIsTheDrivesOwn) {
    jog_until_it_fails(ErrorReaction::quick_stop);
    EXPECT_EQ(reaction(), "the drive stops the axis by its quick stop, then its power goes off, as `reactions` of the axis says (reset)");
    ASSERT_TRUE(m().until([&] { return m().axis(0).drive_state == axes::PowerState::disabled; }, 1s));
    EXPECT_TRUE(told_quick_stop);
    EXPECT_TRUE(in_quick_stop);
    EXPECT_LT(fastest_let_go, 5) << "it stood before its power went";
    EXPECT_EQ(m().axis(1).state, AxisState::Standstill) << "the other axis is not concerned";
    m().run(500ms);
    recover();
}

TEST_F(Reacting, PowerOffIsAtOnce) {
    jog_until_it_fails(ErrorReaction::power_off);
    EXPECT_EQ(reaction(), "the power of the axis goes off at once, as `reactions` of the axis says (reset)");
    m().run(5ms);
    EXPECT_FALSE(told_quick_stop);
    EXPECT_GT(fastest_let_go, 30) << "it coasts";
    EXPECT_EQ(m().axis(1).state, AxisState::Standstill);
    ASSERT_TRUE(m().until([&] { return std::abs(m().axis(0).actual_velocity) < 0.1; }, 20s));
    recover();
}

TEST_F(Reacting, StopMachineTakesTheOthersWithIt) {
    jog_until_it_fails(ErrorReaction::stop_machine);
    EXPECT_EQ(reaction(), "all axes stop, as `reactions` of the axis says (reset)");
    m().run(3ms);
    EXPECT_EQ(m().axis(1).state, AxisState::ErrorStop);
    EXPECT_FALSE(told_quick_stop);
    m().run(500ms);
    EXPECT_EQ(m().axis(0).drive_state, axes::PowerState::enabled);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
