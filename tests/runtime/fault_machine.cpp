// Every fault of the outside world: its documented reaction while the master is alive, no set-point that jumps, and recovery.
// docs/faults.md is the table; this is its proof.

#include "axes/axis/alarms.hpp"
#include "ecat/alarms.hpp"
#include "ecat/sim/sim_slave.hpp"
#include "ecat/wire/sii.hpp"
#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisAlarm;
using axes::AxisState;

/// Two axes, enabled, homed and moving in manual mode: x towards 700 mm at 150 mm/s, y stands.
struct Fault : ::testing::Test {
    std::unique_ptr<TestMachine> machine;

    void start(MachineConfig config = machine_config(2)) {
        machine = std::make_unique<TestMachine>(std::move(config));
        ASSERT_TRUE(machine->up());
        for (std::uint16_t i = 0; i < 2; ++i) machine->enable(i);
        for (std::uint16_t i = 0; i < 2; ++i) machine->home(i);
        ASSERT_EQ(m().command(OperatorAction::move_absolute, 0, false, 700, 150).answer, Answer::accepted);
        ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity > 140; }, 3s));
    }
    TestMachine& m() { return *machine; }

    /// After the cause is gone: reset, enable, move. What a person does.
    void recover(bool home_again = false) {
        EXPECT_TRUE(m().until([&] { return m().command(OperatorAction::reset).answer == Answer::accepted && reset_done(); }, 5s))
            << m().alarms();
        for (std::uint16_t i = 0; i < 2; ++i) m().enable(i);
        if (home_again)
            for (std::uint16_t i = 0; i < 2; ++i)
                if (!m().axis(i).homed) m().home(i);
        EXPECT_EQ(m().command(OperatorAction::move_absolute, 0, false, 100, 150).answer, Answer::accepted) << m().alarms();
        EXPECT_TRUE(m().until([&] { return m().axis(0).in_position && m().axis(0).set_position == 100; }, 15s)) << m().alarms();
    }
    bool reset_done() {
        m().run(500ms);
        return m().axis(0).state != AxisState::ErrorStop && m().axis(1).state != AxisState::ErrorStop;
    }
};

TEST_F(Fault, EmergencyStopRampsDownThenTakesPowerAwayAndNeedsAReset) {
    start();
    m().world.set_input("estop_ok", false);
    m().run(5ms);
    EXPECT_TRUE(m().state().emergency_stop);
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    EXPECT_GT(m().axis(0).set_velocity, 0) << "it ramps, it does not stop dead";
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::emergency_stop)));
    EXPECT_FALSE(m().has_alarm(axes::id(axes::AxisAlarm::emergency_stop))) << "one cause is one alarm";

    EXPECT_TRUE(m().until([&] { return m().axis(0).drive_state != axes::PowerState::enabled; }, 500ms))
        << "power goes within power_off_after";
    EXPECT_TRUE(m().until([&] { return m().axis(1).drive_state != axes::PowerState::enabled; }, 100ms));
    EXPECT_EQ(m().command(OperatorAction::move_absolute, 0, false, 100, 50).answer, Answer::refused_by_axis);

    m().world.set_input("estop_ok", true);
    m().run(20ms);
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop) << "releasing the button starts nothing";
    recover();
    m().expect_no_jump();
}

TEST_F(Fault, ADriveFaultStopsItsAxisAloneAndShowsTheDrivesOwnWords) {
    start();
    m().world.drive("x")->raise(0x3130);
    m().run(100ms);

    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    EXPECT_EQ(m().axis(0).drive_error, 0x3130);
    EXPECT_EQ(m().axis(1).state, AxisState::Standstill) << "the other axis is not concerned";
    EXPECT_TRUE(m().has_alarm(id(AxisAlarm::drive_fault)));
    EXPECT_NE(m().alarms().find("panel E.999: phase failure"), std::string::npos) << m().alarms();

    recover();
    m().expect_no_jump();
}

TEST_F(Fault, ABlockedAxisTripsTheFollowingErrorWatch) {
    start();
    m().world.drive("x")->jam(true);
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 1s));
    EXPECT_TRUE(m().has_alarm(id(AxisAlarm::following_error))) << m().alarms();
    m().run(1s);
    m().world.drive("x")->jam(false);
    m().run(1s);
    recover();
    m().expect_no_jump();
}

TEST_F(Fault, ASilentSlaveStopsTheMachineAndComesBackAfterItsPower) {
    start();
    m().world.set_slave_power("x_drive", false);  // first in the line: everything behind it is gone too
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 100ms));
    m().run(1s);
    EXPECT_FALSE(m().axis(0).online);
    EXPECT_GT(m().state().alarm_count, 0u);

    m().world.set_slave_power("x_drive", true);
    EXPECT_TRUE(m().until([&] { return m().axis(0).online && m().axis(1).online; }, 20s))
        << m().machine->bus_progress() << " " << m().alarms();
    recover(true);
    m().expect_no_jump();
}

// y's drive may be lost: x runs on, y's axis stops. The terminal with the emergency stop stands before it.
TEST_F(Fault, WhoMayDropOutStopsOnlyItsOwnAxes) {
    auto config = machine_config(2);
    config.bus.slaves[1].on_loss = ecat::LossPolicy::stop_own_axes;
    config.bus.slaves[1].position = 2;
    config.bus.slaves[2].position = 1;
    start(std::move(config));
    m().world.set_slave_power("y_drive", false);
    m().run(300ms);
    EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion) << m().alarms();
    EXPECT_EQ(m().axis(1).state, AxisState::ErrorStop);
    EXPECT_TRUE(m().has_alarm(ecat::id(ecat::BusAlarm::slave_dropped_out))) << m().alarms();

    m().world.set_slave_power("y_drive", true);
    EXPECT_TRUE(m().until([&] { return m().axis(1).online; }, 20s)) << m().machine->bus_progress();
    EXPECT_TRUE(m().until([&] { return m().axis(0).in_position; }, 10s)) << "x has gone all its way";
    m().expect_no_jump();
}

// It is missed first, and then known: the list shows one alarm, and what the axes stopped by is explained by it.
TEST_F(Fault, AnotherDeviceInASlavesPlaceIsOneAlarm) {
    auto config = machine_config(2);
    config.bus.slaves[1].position = 2;
    config.bus.slaves[2].position = 1;
    start(std::move(config));
    m().world.set_slave_power("y_drive", false);
    ASSERT_TRUE(m().until([&] { return m().has_alarm(ecat::id(ecat::BusAlarm::slave_lost)); }, 100ms));
    m().run(200ms);
    auto& network = m().world.network();
    std::size_t y = 0;
    while (network.slave(y).options().name != "y_drive") ++y;
    network.slave(y).controller().eeprom().image()[std::size_t{2} * ecat::sii_word::product] ^= std::byte{0x55};
    m().world.set_slave_power("y_drive", true);
    ASSERT_TRUE(m().until([&] { return m().has_alarm(ecat::id(ecat::BusAlarm::other_device)); }, 2s)) << m().alarms();
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    m().run(3s);
    EXPECT_EQ(m().state().alarm_count, 1u) << m().alarms();
    EXPECT_TRUE(m().has_alarm(ecat::id(ecat::BusAlarm::other_device))) << m().alarms();
    m().expect_no_jump();
}

TEST_F(Fault, TwoLostFramesMakeNoDifferenceButAreCounted) {
    start();
    const auto lost = m().state().bus.frames_lost;
    m().world.transport().faults.drop_answers = 2;
    m().run(50ms);
    EXPECT_GT(m().state().bus.frames_lost, lost);
    EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion) << m().alarms();
    EXPECT_TRUE(m().until([&] { return m().axis(0).in_position; }, 10s));
    m().expect_no_jump();
}

TEST_F(Fault, ADeadLineStopsTheAxes) {
    start();
    m().world.set_cable("x_drive", false);
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop && m().axis(1).state == AxisState::ErrorStop; }, 200ms))
        << m().alarms();
    EXPECT_TRUE(m().has_alarm(ecat::id(ecat::BusAlarm::frames_lost)) || m().has_alarm(ecat::id(ecat::BusAlarm::slave_lost)))
        << m().alarms();
    m().run(500ms);
    m().world.set_cable("x_drive", true);
    EXPECT_TRUE(m().until([&] { return m().axis(0).online && m().axis(1).online; }, 20s))
        << m().machine->bus_progress() << " " << m().alarms();
    recover(true);
    m().expect_no_jump();
}

// One cable, one alarm: not one for each slave that falls by its watchdog and each axis that stops by it, and nothing new while it is reset.
// What a drive itself has in its display (its watchdog has stopped it) is said in its words, behind that.
TEST_F(Fault, ALostLineIsOneAlarmUntilItIsReset) {
    start();
    std::vector<std::string> seen;
    m().on_cycle = [&] {
        const auto& s = m().state();
        for (std::size_t i = 0; i < s.alarm_count; ++i) {
            const auto name = m().machine->describe(s.alarms[i].fact).name;
            if (name == "drive_fault") {
                for (std::size_t k = i + 1; k < s.alarm_count; ++k)
                    EXPECT_NE(s.alarms[k].fact.id, ecat::id(ecat::BusAlarm::link_down)) << "the cause stands first";
                continue;
            }
            if (name != "emergency_stop" && name != "dc_not_locked" && std::find(seen.begin(), seen.end(), name) == seen.end())
                seen.push_back(name);
        }
    };
    m().world.transport().faults.link_down = true;
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop && m().axis(1).state == AxisState::ErrorStop; }, 200ms));
    m().run(300ms);
    ASSERT_EQ(seen, std::vector<std::string>{"link_down"}) << m().alarms();
    m().world.transport().faults.link_down = false;
    ASSERT_TRUE(m().until([&] { return m().axis(0).online && m().axis(1).online; }, 20s)) << m().alarms();
    recover(true);
    m().run(1500ms);
    EXPECT_EQ(seen, std::vector<std::string>{"link_down"}) << m().alarms();
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
}

// The message that the error is gone comes some milliseconds behind the reset; the one with the error some before the status word.
TEST_F(Fault, AnEmergencyThatTheAxisTellsIsNotToldAgain) {
    start();
    bool drive = false, emergency = false;
    m().on_cycle = [&] {
        drive = drive || m().has_alarm(axes::id(axes::AxisAlarm::drive_fault));
        emergency = emergency || m().has_alarm(ecat::id(ecat::BusAlarm::slave_emergency));
    };
    m().world.drive("x")->raise(0x3130, true);
    m().run(300ms);
    EXPECT_TRUE(drive);
    m().command(OperatorAction::reset);
    m().run(300ms);
    EXPECT_FALSE(emergency);
    EXPECT_FALSE(m().has_alarm(axes::id(axes::AxisAlarm::drive_fault)));
}

struct Voice : ecat::sim::DeviceModel {
    static constexpr auto says = &Voice::send_emergency;
};

// A drive need not show in its status word what it says in an emergency. Whatever it says is an alarm once, however short it is.
TEST_F(Fault, AnEmergencyThatIsOverBeforeItsAxisTellsItIsSaidOnce) {
    for (const Duration length : {10ms, 90ms, 400ms}) {
        start();
        int times = 0;
        bool before = false, drive = false;
        std::string said;
        m().on_cycle = [&] {
            const bool now = m().has_alarm(ecat::id(ecat::BusAlarm::slave_emergency));
            if (now && !before) ++times, said = m().alarms();
            before = now;
            drive = drive || m().has_alarm(axes::id(axes::AxisAlarm::drive_fault));
        };
        auto& model = m().world.network().slave(0).model();
        (model.*Voice::says)({0xFF01, 0x81, {}});
        m().run(length);
        (model.*Voice::says)({});
        m().run(3s);
        EXPECT_EQ(times, 1) << length.count();
        EXPECT_NE(said.find("slave 'x_drive': The slave sent emergency FF01h (error register 81h)"), std::string::npos) << said;
        EXPECT_FALSE(before) << "it goes by itself";
        EXPECT_FALSE(drive);
        EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion);
    }
}

/// Relaxed: 300 cycles may be lost. The drive has a watchdog of its own of 100 ms.
MachineConfig watchful_drives() {
    auto config = machine_config(2);
    config.simulation.supervision = Supervision::relaxed;
    auto device = std::make_shared<ecat::DeviceDescription>(*config.bus.slaves[0].device);
    ecat::ObjectEntry time = device->objects.front();
    time.index = 0x2009;
    time.type = ecat::DataType::U16;
    time.access = ecat::Access::rw;
    time.value = 100;
    device->objects.push_back(time);
    auto profile = std::make_shared<axes::DriveProfile>(*config.axes[0].profile);
    profile->behaviour.lost_data_time = {0x2009, 0};
    for (std::size_t i = 0; i < 2; ++i) {
        config.bus.slaves[i].device = device;
        config.axes[i].profile = profile;
    }
    return config;
}

// What the machine bears stops nothing and accuses nobody, although the watch of the bus hears nothing from anybody meanwhile.
TEST_F(Fault, LostFramesShortOfTheLimitAreOnlyCounted) {
    auto config = machine_config(2);
    config.simulation.supervision = Supervision::relaxed;
    start(std::move(config));
    ASSERT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Standstill; }, 3s));
    bool alarm = false;
    m().on_cycle = [&] { alarm = alarm || m().state().alarm_count > 0; };
    m().world.transport().faults.drop_requests = 200;
    m().run(1s);
    EXPECT_GE(m().state().bus.frames_lost, 200u);
    EXPECT_FALSE(alarm) << m().alarms();
    EXPECT_TRUE(m().axis(0).powered);
    m().expect_no_jump();

    // An axis in motion is left behind by its set-point: that is said, and by what.
    m().on_cycle = nullptr;
    ASSERT_EQ(m().command(OperatorAction::move_absolute, 0, false, 700, 150).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity > 140; }, 3s));
    m().world.transport().faults.drop_requests = 200;
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 1s));
    ASSERT_EQ(m().state().alarm_count, 1u) << m().alarms();
    const auto words = m().machine->describe(m().state().alarms[0].fact);
    EXPECT_EQ(words.name, "following_error");
    EXPECT_NE(words.english.find(" mm is beyond the window of "), std::string::npos) << words.english;
    EXPECT_NE(words.english.find(" bus cycles in a row were not answered"), std::string::npos) << words.english;
    EXPECT_EQ(words.cause.find("Probably frames were lost"), 0u) << words.cause;
}

TEST_F(Fault, AFollowingErrorWithoutLostFramesDoesNotNameThem) {
    start();
    m().world.drive("x")->jam(true);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 1s));
    EXPECT_EQ(m().alarms().find("not answered"), std::string::npos) << m().alarms();
}

// The drive's own watchdog is shorter than the limit: it is the drive that stops, and what it says names the lost frames.
TEST_F(Fault, ADriveThatStopsByLostFramesIsNotBlamed) {
    start(watchful_drives());
    m().world.transport().faults.drop_requests = 250;
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 400ms));
    m().run(20ms);
    const auto& s = m().state();
    ASSERT_EQ(s.alarm_count, 2u) << "one for each drive: " << m().alarms();
    for (std::size_t i = 0; i < s.alarm_count; ++i) {
        const auto words = m().machine->describe(s.alarms[i].fact);
        EXPECT_EQ(words.name, "drive_fault");
        EXPECT_NE(words.english.find("; right before, "), std::string::npos) << words.english;
        EXPECT_NE(words.english.find(" bus cycles in a row were not answered"), std::string::npos) << words.english;
        EXPECT_EQ(words.cause.find("Probably frames were lost, and not by the drive (this computer too late"), 0u) << words.cause;
    }
    m().run(1s);
    recover();
    // A drive that is left behind by its set-point says so in its own words, too: 8611h (IEC 61800-7-201, 603Fh).
    m().world.transport().faults.drop_requests = 50;
    m().run(60ms);
    m().world.drive("x")->raise(0x8611);
    m().run(20ms);
    EXPECT_NE(m().alarms().find("bus cycles in a row were not answered"), std::string::npos) << m().alarms();
    recover();
    // Long after it, or when the drive complains of something else, lost frames explain nothing.
    m().run(1s);
    m().world.drive("x")->raise(0x7500);
    m().run(20ms);
    EXPECT_EQ(m().alarms().find("not answered"), std::string::npos) << m().alarms();
    recover();
    m().world.transport().faults.drop_requests = 20;
    m().run(30ms);
    m().world.drive("x")->raise(0x3130);
    m().run(20ms);
    EXPECT_TRUE(m().has_alarm(id(AxisAlarm::drive_fault)));
    EXPECT_EQ(m().alarms().find("not answered"), std::string::npos) << m().alarms();
}

TEST_F(Fault, LateFramesAreDiscardedAndCounted) {
    start();
    auto& faults = m().world.transport().faults;
    faults.delay = 1500us;
    faults.delay_answers = 1;
    m().run(50ms);
    EXPECT_GT(m().state().bus.frames_late + m().state().bus.frames_lost, 0u);
    EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion) << m().alarms();
    m().expect_no_jump();
}

TEST_F(Fault, AJogEndsWhenItsClientFallsSilent) {
    start();
    ASSERT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Standstill; }, 3s));
    ASSERT_EQ(m().command(OperatorAction::jog, 0, true, 100).answer, Answer::accepted);
    for (int i = 0; i < 10; ++i) {
        m().run(50ms);
        EXPECT_EQ(m().command(OperatorAction::jog, 0, false, 100).answer, Answer::accepted);
    }
    EXPECT_NEAR(m().axis(0).set_velocity, 100, 1e-6);

    EXPECT_TRUE(m().until([&] { return m().axis(0).set_velocity == 0; }, 200ms + 100ms)) << "lease 200 ms, then the ramp";
    EXPECT_TRUE(m().has_alarm(id(AxisAlarm::jog_lease_expired)));
    EXPECT_EQ(m().command(OperatorAction::jog, 0, false, 100).answer, Answer::stale) << "a late heartbeat does not start it anew";
    m().expect_no_jump();
}

TEST_F(Fault, AStopRequestEndsTheRunWithTheDrivesOff) {
    start();
    m().machine->request_shutdown();
    EXPECT_TRUE(m().until([&] { return m().machine->phase() == MachinePhase::stopped; }, 3s));
    EXPECT_NE(m().axis(0).drive_state, axes::PowerState::enabled);
    EXPECT_EQ(m().axis(0).set_velocity, 0.0);
    m().machine->stop_bus();
    EXPECT_TRUE(m().until([&] { return m().machine->bus().phase() == ecat::Master::Phase::stopped; }, 5s));
    m().expect_no_jump();
}

TEST_F(Fault, MissedTicksDelayTheMotionAndNeverMakeItJump) {
    start();
    // The host stalls for 20 ms: nineteen grid points are skipped, motion time advances by one period only.
    m().clock.advance(20ms);
    const auto now = m().clock.now();
    const double before = m().axis(0).set_position;
    m().machine->cycle({now, now, 19});
    m().machine->service(now);
    EXPECT_NEAR(m().axis(0).set_position - before, 150.0 * 0.001, 0.01);
    m().run(50ms);
    EXPECT_EQ(m().state().statistics.missed_ticks, 19u);
    m().expect_no_jump();
}

// The master's column of docs/faults.md "master gone": nobody sends any more, the SM watchdog expires, the drive stops by itself.
TEST_F(Fault, WhenTheMasterDiesTheSlavesWatchdogStopsTheDrive) {
    start();
    auto& network = m().world.network();
    for (int i = 0; i < 400; ++i) {  // time goes on, no cycle runs
        m().clock.advance(1ms);
        network.advance(m().clock.now());
    }
    EXPECT_NE(m().world.drive("x")->state(), axes::sim::Cia402Axis::State::enabled);
    EXPECT_NEAR(m().world.drive("x")->plant().velocity(), 0, 100);
    EXPECT_NE(network.slave(0).state(), ecat::sim::EsmState::op);
    EXPECT_FALSE(m().world.output("lamp"));
}

TEST_F(Fault, LosingMainPowerIsReportedAndResetOnceItIsBack) {
    start();
    m().world.drive("x")->main_power(false);
    m().run(200ms);
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    m().world.drive("x")->main_power(true);
    m().run(100ms);
    recover();
    m().expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::runtime::testing
