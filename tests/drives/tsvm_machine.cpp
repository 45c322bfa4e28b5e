// Six axes behind one TSVM-D6, in a whole machine: real frames, blocks of PLCopen, the drive made from its file. Sections of the TSVM manual V1.1:
// 5.3 six state machines, 5.4.1 changes of mode, 7.1 alarms of the whole drive, 7.2 those of one axis.

#include <array>

#include "config/machine_file/machine_loader.hpp"
#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"
#include "tests/machines/add_program.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk {
namespace {

using namespace std::chrono_literals;
using axes::AxisState;
using runtime::testing::TestMachine;

constexpr std::array names{"j1", "j2", "j3", "j4", "j5", "j6"};

/// Its blocks are called each scan; what they are told is the test's business.
struct Joint {
    AxisRef axis;
    fb::MC_Power power;
    fb::MC_Reset reset;
    fb::MC_Home home;
    fb::MC_MoveAbsolute move;
    fb::MC_TorqueControl push;
    fb::MC_Halt halt;
};

class Robot final : public Program {
public:
    static inline Robot* running = nullptr;
    std::array<Joint, 6> joints;

    Robot() { running = this; }
    void declare(Declaration& d) override {
        for (std::size_t i = 0; i < joints.size(); ++i) joints[i].axis = d.axis(names[i]);
        d.task<&Robot::scan>("main");
    }
    void scan(TaskContext& ctx) {
        for (auto& j : joints) {
            j.power.Axis = j.reset.Axis = j.home.Axis = j.move.Axis = j.push.Axis = j.halt.Axis = j.axis;
            j.power(ctx);
            j.reset(ctx);
            j.home(ctx);
            j.move(ctx);
            j.push(ctx);
            j.halt(ctx);
        }
    }
};

const ProgramEntry* robot_entry() {
    static const ProgramEntry entry{program_magic,
                                    sizeof(ProgramEntry),
                                    abi_hash(),
                                    sdk_version,
                                    "robot",
                                    []() -> Program* { return new Robot; },
                                    [](Program* p) { delete p; }};
    return &entry;
}

std::string machine_file() {
    std::string text =
        "version: 1\nname: robot\ncycle: 1 ms\nstart_mode: automatic\nbus:\n  interface: simulated\n  slaves:\n"
        "    - { name: robot, profile: tsvm-d6 }\naxes:\n";
    for (std::size_t i = 0; i < names.size(); ++i)
        text += std::string("  ") + names[i] + ": { slave: robot, axis: " + std::to_string(i + 1) +
                ", unit: deg, gearing: { counts_per_revolution: 131072, gear: 80/1, feed: 360 deg }, "
                "limits: { velocity: 180 deg/s, acceleration: 900 deg/s2, jerk: 18000 deg/s3, position: [-185 deg, 185 deg] }, "
                "following_error: { window: 2 deg, time: 10 ms }, homing: { kind: set_here }, "
                // 1.27 N m / 2e-4 kg m2 at the motor, behind the gear
                "control: { rated_acceleration: 4548 deg/s2 } }\n";
    return text;
}

/// A change of mode that 5.4.1 forbids ("abnormality", which one is not stated) is an alarm here, so that none stays unseen.
constexpr std::uint16_t mode_abnormality = 48;

runtime::MachineConfig machine() {
    config::LoadOptions options;
    options.simulate = true;
    options.drive_dirs.emplace_back(TAKTWERK_SOURCE_DIR "/config/drives");
    auto loaded = config::load_machine_text("robot.yaml", machine_file(), options);
    if (const auto* errors = std::get_if<1>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    auto config = std::move(std::get<0>(loaded).machine);
    auto strict = *config.axes.front().profile;
    strict.mode_rules.violation = axes::ModeViolation::alarm;
    axes::DriveAlarmText abnormality;
    abnormality.code = mode_abnormality;
    abnormality.kind = axes::DriveAlarmKind::mode_change;
    strict.alarms.push_back(abnormality);
    const auto shared = std::make_shared<const axes::DriveProfile>(strict);
    for (auto& binding : config.axes) binding.profile = shared;
    runtime::testing::add_program(config, "p", robot_entry);
    return config;
}

class TsvmMachine : public ::testing::Test {
protected:
    TestMachine m{machine()};

    void SetUp() override {
        m.replayed.leave_out();  // the test works the blocks of its robot
        ASSERT_TRUE(m.up());
        ASSERT_NE(Robot::running, nullptr);
        for (auto& j : Robot::running->joints) j.power.Enable = true;
        ASSERT_TRUE(m.until([&] { return all([](const Joint& j) { return j.power.Status; }); }, 3s)) << m.alarms();
        for (auto& j : Robot::running->joints) j.home.Execute = true;
        ASSERT_TRUE(m.until([&] { return all([](const Joint& j) { return j.home.Done; }); }, 1s)) << m.alarms();
    }
    void TearDown() override {
        m.expect_no_jump();
        m.on_cycle = {};  // what it watches has gone with the test's body
        m.runner->shut_down();
        Robot::running = nullptr;
    }

    template <class Condition>
    static bool all(Condition condition) {
        for (const auto& j : Robot::running->joints)
            if (!condition(j)) return false;
        return true;
    }
    static Joint& joint(std::size_t number) { return Robot::running->joints[number - 1]; }
    /// As the manual counts, from 1.
    const axes::AxisView& axis(std::size_t number) { return m.axis(number - 1); }
    axes::sim::Cia402Axis& drive(std::size_t number) { return *m.world.drive(names[number - 1]); }
    /// Object of an axis: 800h further for each [5.2.5].
    std::int64_t object(std::size_t number, std::uint16_t index) {
        return m.world.network().slave(0).dictionary().value(static_cast<std::uint16_t>(index + 0x800 * (number - 1)), 0);
    }
    static void go(Joint& j, double position, double velocity) {
        j.move.Execute = true;
        j.move.Position = position;
        j.move.Velocity = velocity;
    }
    /// All six under way, each somewhere else.
    void send_all() {
        for (std::size_t n = 1; n <= 6; ++n) go(joint(n), 20.0 * static_cast<double>(n), 30);
        m.run(300ms);
        for (std::size_t n = 1; n <= 6; ++n) EXPECT_EQ(axis(n).state, AxisState::DiscreteMotion) << n;
    }
    /// MC_Reset until it has an answer.
    void reset(std::size_t number) {
        auto& j = joint(number);
        j.reset.Execute = true;
        EXPECT_TRUE(m.until([&] { return j.reset.Done || j.reset.Error; }, 11s)) << number;
    }
    void drop_reset(std::size_t number) {
        joint(number).reset.Execute = false;
        joint(number).move.Execute = false;
        m.run(5ms);
    }
    /// It has power again and moves.
    void expect_moves(std::size_t number, double to) {
        EXPECT_TRUE(m.until([&] { return joint(number).power.Status && axis(number).powered; }, 2s)) << number << ": " << m.alarms();
        go(joint(number), to, 60);
        EXPECT_TRUE(m.until([&] { return joint(number).move.Done; }, 6s)) << number << ": " << m.alarms();
        EXPECT_NEAR(axis(number).actual_position, to, 0.05) << number;
    }
};

// 5.3: "each axis has its own state machine": powered, homed and moved one by one, with one slave behind all.
TEST_F(TsvmMachine, SixAxesOfOneSlaveArePoweredHomedAndMoved) {
    EXPECT_EQ(m.machine->config().axes.size(), 6u);
    send_all();
    ASSERT_TRUE(m.until([&] { return all([](const Joint& j) { return j.move.Done; }); }, 10s)) << m.alarms();
    for (std::size_t n = 1; n <= 6; ++n) {
        EXPECT_NEAR(axis(n).actual_position, 20.0 * static_cast<double>(n), 0.05) << n;
        EXPECT_EQ(drive(n).early_commands(), 0u) << n << ": 5.3.1, the first 100 ms after enabling";
        EXPECT_EQ(object(n, 0x6041) & 0x6F, 0x27) << n;
    }
    joint(2).power.Enable = false;
    ASSERT_TRUE(m.until([&] { return axis(2).state == AxisState::Disabled; }, 1s));
    for (const std::size_t n : {1u, 3u, 4u, 5u, 6u}) EXPECT_EQ(axis(n).state, AxisState::Standstill) << n;
}

// 7.2: alarm 12, over-current, of axis 3. It clears by a reset; the axis kept its place.
TEST_F(TsvmMachine, AnAlarmOfOneAxisStopsThatAxisAlone) {
    send_all();
    drive(3).raise(12);
    m.run(10ms);
    EXPECT_EQ(axis(3).state, AxisState::ErrorStop);
    EXPECT_EQ(object(3, 0x603F), 12);
    EXPECT_EQ(axis(3).drive_error, 12);
    for (const std::size_t n : {1u, 2u, 4u, 5u, 6u}) {
        EXPECT_EQ(axis(n).state, AxisState::DiscreteMotion) << n;
        EXPECT_EQ(object(n, 0x603F), 0) << n;
    }
    for (const std::size_t n : {1u, 2u, 4u, 5u, 6u})
        EXPECT_TRUE(m.until([&] { return joint(n).move.Done; }, 10s)) << n << ": " << m.alarms();

    reset(3);
    EXPECT_TRUE(joint(3).reset.Done);
    drop_reset(3);
    EXPECT_TRUE(axis(3).homed);
    expect_moves(3, -15);
}

// 7.1: "common" alarms have no axis. 603Fh of every axis shows the number plus 70: over-voltage, 2, is 72.
TEST_F(TsvmMachine, AnAlarmOfTheWholeDriveStopsAllSixAndEachIsReset) {
    send_all();
    drive(5).raise(72);
    m.run(20ms);
    for (std::size_t n = 1; n <= 6; ++n) {
        EXPECT_EQ(axis(n).state, AxisState::ErrorStop) << n;
        EXPECT_EQ(object(n, 0x603F), 72) << n;
    }
    m.run(500ms);
    for (std::size_t n = 1; n <= 6; ++n) EXPECT_TRUE(drive(n).stands()) << n;
    for (std::size_t n = 1; n <= 6; ++n) joint(n).reset.Execute = true;
    ASSERT_TRUE(m.until([&] { return all([](const Joint& j) { return j.reset.Done; }); }, 5s)) << m.alarms();
    for (std::size_t n = 1; n <= 6; ++n) drop_reset(n);
    for (std::size_t n = 1; n <= 6; ++n) expect_moves(n, 5);
}

// 7.1: "when both occur, the drive can only upload the common one": once that is reset, axis 4 still shows its own.
TEST_F(TsvmMachine, BehindACommonAlarmAnAxisKeepsItsOwn) {
    drive(4).raise(12);
    m.run(10ms);
    drive(1).raise(72);
    m.run(20ms);
    EXPECT_EQ(object(4, 0x603F), 72);
    bool own_shown = false;
    m.on_cycle = [&] { own_shown |= object(4, 0x603F) == 12; };
    for (std::size_t n = 1; n <= 6; ++n) joint(n).reset.Execute = true;
    ASSERT_TRUE(m.until([&] { return all([](const Joint& j) { return j.reset.Done; }); }, 5s)) << m.alarms();
    m.on_cycle = {};
    EXPECT_TRUE(own_shown) << "MC_Reset goes on with a second edge";
    EXPECT_EQ(object(4, 0x603F), 0);
    for (std::size_t n = 1; n <= 6; ++n) drop_reset(n);
    expect_moves(4, 5);
    expect_moves(6, 5);
}

// 7.2.1, the note on the star: alarm 2 "cannot be reset by software". No edge of bit 7 is even tried.
TEST_F(TsvmMachine, AStarredAlarmIsNotReset) {
    drive(2).raise(2, false);
    m.run(10ms);
    bool tried = false;
    m.on_cycle = [&] { tried |= (object(2, 0x6040) & 0x80) != 0; };
    reset(2);
    EXPECT_TRUE(joint(2).reset.Error);
    EXPECT_EQ(joint(2).reset.ErrorID, axes::ErrorId::reset_failed);
    EXPECT_FALSE(tried);
    EXPECT_EQ(axis(2).state, AxisState::ErrorStop);
    EXPECT_EQ(object(2, 0x603F), 2);
    m.on_cycle = {};
    expect_moves(1, 5);
}

// 7.1, common alarm 3: while the main power is away no reset helps, afterwards each does.
TEST_F(TsvmMachine, MainPowerMustBeBackBeforeAReset) {
    for (std::size_t n = 1; n <= 6; ++n) drive(n).main_power(false);
    m.run(20ms);
    for (std::size_t n = 1; n <= 6; ++n) EXPECT_EQ(object(n, 0x603F), 73) << n;
    reset(1);
    EXPECT_TRUE(joint(1).reset.Error);
    drop_reset(1);
    for (std::size_t n = 1; n <= 6; ++n) drive(n).main_power(true);
    for (std::size_t n = 1; n <= 6; ++n) joint(n).reset.Execute = true;
    ASSERT_TRUE(m.until([&] { return all([](const Joint& j) { return j.reset.Done; }); }, 5s)) << m.alarms();
    for (std::size_t n = 1; n <= 6; ++n) drop_reset(n);
    expect_moves(1, 5);
}

/// What the drive gets of 6040h and 6060h, against the rules of 5.4.1 and alarm 43.
struct ModeWatch {
    std::int64_t mode = 0;
    Instant changed{};
    Duration least_distance = 1h;
    int changes = 0;
    bool enabled_without_mode = false, changed_in_motion = false;

    void look(std::int64_t wanted, std::int64_t display, std::int64_t control, bool stands, bool powered, Instant now) {
        enabled_without_mode |= (control & 0x0F) == 0x0F && display == 0 && !powered;
        if (wanted == mode) return;
        if (changes++ > 0) least_distance = std::min(least_distance, now - changed);
        changed_in_motion |= !stands;
        changed = now;
        mode = wanted;
    }
};

// 5.4.1: modes change at standstill, 20 ms apart; 6061h and the actual values mean nothing for 2 ms. Into torque mode and back, twice.
TEST_F(TsvmMachine, ModesChangeAtStandstillAndTwentyMillisecondsApart) {
    ModeWatch watch;
    watch.mode = object(2, 0x6060);
    ASSERT_EQ(watch.mode, 8);
    double fastest_seen = 0;
    m.on_cycle = [&] {
        watch.look(object(2, 0x6060), object(2, 0x6061), object(2, 0x6040), drive(2).stands(), drive(2).powered(), m.clock.now());
        fastest_seen = std::max(fastest_seen, std::abs(axis(2).actual_velocity));
    };
    for (int round = 0; round < 2; ++round) {
        auto& j = joint(2);
        j.push.Torque = 0.01;  // less than friction: it stays where it is
        j.push.Execute = true;
        ASSERT_TRUE(m.until([&] { return j.push.InTorque || j.push.Error; }, 1s)) << m.alarms();
        EXPECT_FALSE(j.push.Error);
        EXPECT_EQ(object(2, 0x6061), 10);
        j.push.Execute = false;
        j.halt.Execute = true;
        ASSERT_TRUE(m.until([&] { return j.halt.Done || j.halt.Error; }, 1s)) << m.alarms();
        j.halt.Execute = false;
        m.run(5ms);
        go(j, round == 0 ? 3 : 0, 60);
        ASSERT_TRUE(m.until([&] { return j.move.Done; }, 3s)) << m.alarms();
        j.move.Execute = false;
        m.run(5ms);
        EXPECT_EQ(object(2, 0x6061), 8);
    }
    EXPECT_GE(watch.changes, 4);
    EXPECT_GE(watch.least_distance, 20ms);
    EXPECT_FALSE(watch.changed_in_motion);
    EXPECT_LE(fastest_seen, 90) << "the indeterminate values of a change were believed";
    EXPECT_EQ(object(2, 0x603F), 0) << "no abnormality";
}

// 5.4.1: a command that needs another mode is refused while the axis moves; the motion goes on.
TEST_F(TsvmMachine, NoModeIsChangedInMotion) {
    go(joint(2), 90, 60);
    m.run(500ms);
    joint(2).push.Torque = 0.01;
    joint(2).push.Execute = true;
    ASSERT_TRUE(m.until([&] { return joint(2).push.Error; }, 1s));
    EXPECT_EQ(joint(2).push.ErrorID, axes::ErrorId::not_at_standstill);
    EXPECT_EQ(object(2, 0x6060), 8);
    EXPECT_TRUE(m.until([&] { return joint(2).move.Done; }, 5s)) << m.alarms();
    EXPECT_EQ(object(2, 0x603F), 0);
}

// 7.2, alarm 43: enabled while the mode is 0. The mode is set and confirmed by 6061h before 000Fh, on each of the six.
TEST(TsvmBringUp, TheModeIsConfirmedBeforeEachAxisIsEnabled) {
    TestMachine m{machine()};
    m.replayed.leave_out();  // likewise
    ASSERT_TRUE(m.up());
    std::array<ModeWatch, 6> watch;
    auto& dictionary = m.world.network().slave(0).dictionary();
    int enabled = 0;
    m.on_cycle = [&] {
        enabled = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            const auto at = [&](unsigned index) { return dictionary.value(static_cast<std::uint16_t>(index + 0x800 * i), 0); };
            auto& axis = *m.world.drive(names[i]);
            watch[i].look(at(0x6060), at(0x6061), at(0x6040), axis.stands(), axis.powered(), m.clock.now());
            enabled += (at(0x6041) & 0x6F) == 0x27;
        }
    };
    for (auto& j : Robot::running->joints) j.power.Enable = true;
    EXPECT_TRUE(m.until([&] { return enabled == 6; }, 3s)) << m.alarms();
    for (const auto& one : watch) {
        EXPECT_FALSE(one.enabled_without_mode);
        EXPECT_LE(one.changes, 1);
    }
    m.on_cycle = {};
    m.runner->shut_down();
    Robot::running = nullptr;
}

}  // namespace
}  // namespace taktwerk
