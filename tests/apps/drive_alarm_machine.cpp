// A drive's alarm as a person reads it in the machine log, in `taktwerk monitor` and over LCM: axis, drive, panel, name in English and
// Chinese, cause, remedy, and what a person does to clear it.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/machine/machine_log.hpp"
#include "apps/machine/monitor_screen.hpp"
#include "hmi_bridge/lcm/memory_bus.hpp"
#include "hmi_bridge/lcm/publisher.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "taktwerk_lcm/alarm_list_v1_t.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using runtime::testing::machine_config;
using runtime::testing::TestMachine;
using testing::Contains;
using testing::HasSubstr;

// The test drive with one more alarm, that only a power cycle clears.
runtime::MachineConfig config() {
    auto out = machine_config(1);
    auto profile = std::make_shared<axes::DriveProfile>(*out.axes[0].profile);
    profile->name = "servo-7";
    axes::DriveAlarmText storage;
    storage.code = 0x5530, storage.panel = "E.017", storage.english = "parameter storage", storage.chinese = "参数存储故障";
    storage.cause = "EEPROM damaged", storage.remedy = "restore the parameters", storage.resettable = false;
    profile->alarms.push_back(storage);
    axes::DriveAlarmText frames;
    frames.code = 0x8700, frames.english = "no frame came", frames.cause = "the master is late",
    frames.kind = axes::DriveAlarmKind::sync_lost;
    profile->alarms.push_back(frames);
    out.axes[0].profile = profile;
    return out;
}

struct DriveAlarm : testing::Test {
    TestMachine m{config()};
    void SetUp() override {
        ASSERT_TRUE(m.up());
        m.enable(0);
    }
    void raise(std::uint16_t code, bool resettable) {
        m.world.drive("x")->raise(code, resettable);
        m.run(100ms);
    }
};

TEST_F(DriveAlarm, IsCompleteInTheMachineLog) {
    MachineLog log(*m.machine, m.clock.now(), false);
    raise(0x3130, true);
    testing::internal::CaptureStdout();
    log.step(m.clock.now(), &m.state());
    const auto said = testing::internal::GetCapturedStdout();
    EXPECT_THAT(said, HasSubstr("axis x: servo-7 'x_drive' reports fault 3130h, panel E.999: phase failure [the axis stops]\n"));
    EXPECT_THAT(said, HasSubstr("servo-7 'x_drive' 报告故障 3130h,面板 E.999:缺相\n"));
    EXPECT_THAT(said, HasSubstr("why: a phase is missing\n"));
    EXPECT_THAT(said,
                HasSubstr("-> check the supply (once its cause is gone: press reset or `taktwerk reset x`, in a program MC_Reset)\n"));
}

TEST_F(DriveAlarm, IsCompleteInTheMachineLogForScripts) {
    MachineLog log(*m.machine, m.clock.now(), true);
    raise(0x5530, false);
    testing::internal::CaptureStdout();
    log.step(m.clock.now(), &m.state());
    const auto said = testing::internal::GetCapturedStdout();
    EXPECT_THAT(said,
                HasSubstr(R"("event":"ALARM","text":"axis x: servo-7 'x_drive' reports fault 5530h, panel E.017: parameter storage )"));
    EXPECT_THAT(said, HasSubstr(R"("chinese":"servo-7 'x_drive' 报告故障 5530h,面板 E.017:参数存储故障")"));
    EXPECT_THAT(said, HasSubstr(R"("cause":"EEPROM damaged","remedy":"restore the parameters")"));
    EXPECT_THAT(
        said,
        HasSubstr(
            R"("reset":"no reset clears it: switch the drive off and on, then press reset or `taktwerk reset x`, in a program MC_Reset")"));
}

// Reaction::none is information only, but it is what explains the alarms that follow: a computer that stalls makes drives fall.
TEST_F(DriveAlarm, NoReactionIsALineInTheMachineLogAllTheSame) {
    MachineLog log(*m.machine, m.clock.now(), false);
    log.step(m.clock.now(), &m.state());
    testing::internal::CaptureStdout();
    const auto late = [&](Duration by) {
        m.clock.advance(m.machine->config().cycle);
        const auto due = m.clock.now();
        m.machine->cycle({due, due + by, 0});
        m.machine->service(due);
        log.step(due, &m.state());
    };
    late(700us);
    m.run(20ms);
    log.step(m.clock.now(), &m.state());
    late(900us);
    late(20ms);
    const auto said = testing::internal::GetCapturedStdout();
    EXPECT_THAT(said, HasSubstr("note      machine: The cycle woke 700 us late"));
    EXPECT_EQ(said.find("900 us"), std::string::npos) << "a moment later, and not twice as late";
    EXPECT_THAT(said, HasSubstr("note      machine: The cycle woke 20000 us late")) << "far worse than what was said";
    EXPECT_EQ(said.find("[none]"), std::string::npos);
}

// What stopped the axes stands before the axes that stopped.
TEST_F(DriveAlarm, StandsBeforeWhatFollowsFromIt) {
    MachineLog log(*m.machine, m.clock.now(), false);
    log.step(m.clock.now(), &m.state());
    raise(0x3130, true);
    testing::internal::CaptureStdout();
    log.step(m.clock.now(), &m.state());
    const auto said = testing::internal::GetCapturedStdout();
    const auto alarm = said.find("reports fault 3130h"), state = said.find("-> ErrorStop");
    ASSERT_NE(alarm, std::string::npos);
    ASSERT_NE(state, std::string::npos);
    EXPECT_LT(alarm, state);
}

// Five cycles without a frame, then the drive complains: who was late stands in the alarm (IsCompleteInTheMachineLog: nobody was).
TEST_F(DriveAlarm, RightAfterOurOwnStallSaysWhoWasLate) {
    MachineLog log(*m.machine, m.clock.now(), false);
    log.step(m.clock.now(), &m.state());
    m.clock.advance(6 * m.machine->config().cycle);
    m.machine->cycle({m.clock.now(), m.clock.now(), 5});
    m.machine->service(m.clock.now());
    raise(0x8700, true);
    testing::internal::CaptureStdout();
    log.step(m.clock.now(), &m.state());
    const auto said = testing::internal::GetCapturedStdout();
    EXPECT_THAT(said, HasSubstr("no frame came; right before, this computer sent nothing for 6 ms [the axis stops]"));
    EXPECT_THAT(said, HasSubstr("why: Probably this computer was late, not the drive (see late_wakeups)"));
}

// As a real computer does it: a thread that sleeps too long runs the cycle that was due, its frames leave late, and the grid points that it
// missed show with the next cycle only. The first answer with the fault comes in that cycle.
TEST_F(DriveAlarm, WithTheFirstAnswerBehindAStallSaysWhoWasLate) {
    MachineLog log(*m.machine, m.clock.now(), false);
    log.step(m.clock.now(), &m.state());
    m.run(1s);
    const auto cycle = m.machine->config().cycle;
    m.clock.advance(cycle);
    m.world.drive("x")->raise(0x8700, true);
    m.machine->cycle({m.clock.now(), m.clock.now() + 19 * cycle, 0});
    m.clock.advance(20 * cycle);
    m.machine->cycle({m.clock.now(), m.clock.now(), 19});
    m.machine->service(m.clock.now());
    m.run(20ms);
    testing::internal::CaptureStdout();
    log.step(m.clock.now(), &m.state());
    const auto said = testing::internal::GetCapturedStdout();
    EXPECT_THAT(said, HasSubstr("no frame came; right before, this computer sent nothing for 20 ms [the axis stops]"));
    EXPECT_THAT(said, HasSubstr("why: Probably this computer was late, not the drive (see late_wakeups)"));
}

// No frame of ours feeds the mains: who was late a moment before has not taken a phase away.
TEST_F(DriveAlarm, OfTheMainsRightAfterAStallAccusesNobody) {
    MachineLog log(*m.machine, m.clock.now(), false);
    log.step(m.clock.now(), &m.state());
    m.clock.advance(6 * m.machine->config().cycle);
    m.machine->cycle({m.clock.now(), m.clock.now(), 5});
    m.machine->service(m.clock.now());
    raise(0x3130, true);
    testing::internal::CaptureStdout();
    log.step(m.clock.now(), &m.state());
    const auto said = testing::internal::GetCapturedStdout();
    EXPECT_THAT(said, HasSubstr("phase failure [the axis stops]"));
    EXPECT_THAT(said, HasSubstr("why: a phase is missing\n"));
}

// An input that nobody could read was not pressed, and whoever mends its cable has not released it.
TEST_F(DriveAlarm, AnEmergencyStopThatCouldNotBeReadIsNeverSaidToBeReleased) {
    MachineLog log(*m.machine, m.clock.now(), false);
    const auto said_while = [&](auto what) {
        testing::internal::CaptureStdout();
        what();
        m.run(1s);
        log.step(m.clock.now(), &m.state());
        return testing::internal::GetCapturedStdout();
    };
    log.step(m.clock.now(), &m.state());
    EXPECT_THAT(said_while([&] { m.world.set_slave_power("io", false); }), HasSubstr("E-STOP    cannot be read: counts as pressed\n"));
    const auto back = said_while([&] {
        m.world.set_slave_power("io", true);
        ASSERT_TRUE(m.until([&] { return !m.state().emergency_stop; }, 10s));
    });
    EXPECT_THAT(back, HasSubstr("E-STOP    can be read again: it is not pressed\n"));
    EXPECT_EQ(back.find("released\n"), std::string::npos);
    EXPECT_THAT(said_while([&] { m.world.set_input("estop_ok", false); }), HasSubstr("E-STOP    pressed\n"));
    EXPECT_THAT(said_while([&] { m.world.set_input("estop_ok", true); }), HasSubstr("E-STOP    released\n"));
}

// Who fell and who is back, without a look at another screen.
TEST_F(DriveAlarm, WhatTheBusDidIsInTheMachineLog) {
    MachineLog log(*m.machine, m.clock.now(), false);
    log.step(m.clock.now(), &m.state());
    m.world.network().set_power(0, false);
    m.run(100ms);
    m.world.network().set_power(0, true);
    m.run(3s);
    testing::internal::CaptureStdout();
    log.step(m.clock.now(), &m.state());
    log.step(m.clock.now(), &m.state());
    const auto said = testing::internal::GetCapturedStdout();
    constexpr std::string_view returned = "slave 0 'x_drive' (test servo) is back in OP";
    const auto back = said.find(returned);
    ASSERT_NE(back, std::string::npos) << said;
    EXPECT_EQ(said.find(returned, back + 1), std::string::npos) << "once:\n" << said;
}

TEST_F(DriveAlarm, IsCompleteOnTheMonitor) {
    raise(0x5530, false);
    const hmi::RuntimeLink link(*m.machine);
    const auto state = nlohmann::ordered_json::parse(hmi::state_json(m.state(), link));
    const auto lines = monitor_screen(state, nlohmann::ordered_json{{"cycle_ns", 1000000}}, {120, 50, false});
    EXPECT_THAT(lines, Contains(HasSubstr("axis x: servo-7 'x_drive' reports fault 5530h, panel E.017: parameter storage")));
    EXPECT_THAT(lines, Contains(HasSubstr("报告故障 5530h,面板 E.017:参数存储故障")));
    EXPECT_THAT(lines, Contains(HasSubstr("why: EEPROM damaged")));
    EXPECT_THAT(lines, Contains(HasSubstr("-> restore the parameters (no reset clears it: switch the drive off and on, then press reset")));
}

TEST_F(DriveAlarm, IsCompleteOverLcm) {
    raise(0x3130, true);
    const hmi::RuntimeLink link(*m.machine);
    hmi::MemoryBus bus;
    hmi::Publisher publisher(bus, link, 50.0, false, [] { return std::int64_t{1}; });
    publisher.step(&m.state(), m.clock.now());

    taktwerk_lcm::alarm_list_v1_t list;
    for (const auto& message : bus.published)
        if (message.channel == "TAKTWERK_TEST_ALARM_LIST") {
            ASSERT_GT(list.decode(message.bytes.data(), 0, static_cast<int>(message.bytes.size())), 0);
        }
    const auto found = std::find_if(list.alarm.begin(), list.alarm.end(), [](const auto& a) { return a.source_text == "axis x"; });
    ASSERT_NE(found, list.alarm.end());  // the slave's emergency may stand beside it
    const auto& alarm = *found;
    EXPECT_EQ(alarm.source_text, "axis x");
    EXPECT_EQ(alarm.english, "servo-7 'x_drive' reports fault 3130h, panel E.999: phase failure");
    EXPECT_EQ(alarm.chinese, "servo-7 'x_drive' 报告故障 3130h,面板 E.999:缺相");
    EXPECT_EQ(alarm.cause, "a phase is missing");
    EXPECT_EQ(alarm.remedy, "check the supply");
    EXPECT_EQ(alarm.reset, "once its cause is gone: press reset or `taktwerk reset x`, in a program MC_Reset");
}

}  // namespace
}  // namespace taktwerk::apps
