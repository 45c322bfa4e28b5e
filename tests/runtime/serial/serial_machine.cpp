// A machine with a drive on a serial line: blocks move it through the line, and when the line falls silent the output that watches over it
// drops at the terminal and stops the motor.

#include <gmock/gmock.h>

#include "axes/axis/alarms.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/check/machine_check.hpp"
#include "tests/runtime/serial/line_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::AxisState;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

axes::sim::xp200::Servo& servo(TestMachine& m) { return m.world.serial().drive("u")->servo(); }

bool ready(TestMachine& m) {
    return m.up() && m.until([&] { return m.axis(u).online; }, 5s);
}

/// Power, home, a velocity, a jog, a stop, a move: every block that works over such a line, one after the other.
class AllThatWorks final : public Program {
public:
    AxisRef u_axis;
    MC_Power power;
    MC_Home home;
    MC_MoveVelocity run;
    MC_Stop stop;
    MC_Jog jog;
    MC_MoveAbsolute move;
    MC_GearIn gear;
    MC_ReadActualPosition read;
    std::int64_t step = 0, wait = 0;
    double gear_error = 0, position = 0;
    void declare(Declaration& d) override {
        u_axis = d.axis("u");
        d.monitor("step", step);
        d.monitor("gear_error", gear_error);
        d.monitor("position", position, "mm");
        d.task<&AllThatWorks::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = home.Axis = run.Axis = stop.Axis = jog.Axis = move.Axis = gear.Slave = read.Axis = u_axis;
        gear.Master = u_axis;
        power.Enable = read.Enable = true;
        power(ctx);
        read(ctx);
        position = read.Position;
        home.Execute = step >= 1;
        home(ctx);
        run.Velocity = 50;
        run.Execute = step == 2;
        run(ctx);
        stop.Deceleration = 200;
        stop.Execute = step == 3;
        stop(ctx);
        jog.JogBackwards = step == 4;
        jog(ctx);
        move.Position = 10;
        move.Velocity = 50;
        move.Execute = step == 6;
        move(ctx);
        gear.RatioNumerator = gear.RatioDenominator = 1;
        gear.Execute = step == 7;
        gear(ctx);
        ++wait;
        const bool waited = wait > 1500;
        const bool next = (step == 0 && power.Status) || (step == 1 && home.Done) || (step == 2 && run.InVelocity && waited) ||
                          (step == 3 && stop.Done) || (step == 4 && waited) || (step == 5 && waited) || (step == 6 && move.Done) ||
                          (step == 7 && gear.Error);
        if (step == 7 && gear.Error) gear_error = static_cast<double>(gear.ErrorID);
        if (next) {
            ++step;
            wait = 0;
        }
    }
};

TEST(SerialMachine, BlocksMoveADriveOnALine) {
    auto config = with_program(1, &entry_of<AllThatWorks>);
    TestMachine m{with_line(std::move(config))};
    ASSERT_TRUE(m.up());
    const auto at = [&](int step) { return m.until([&] { return variable(m, "step") >= step; }, 15s); };

    ASSERT_TRUE(at(1)) << "MC_Power " << m.alarms();
    EXPECT_TRUE(servo(m).energised());
    EXPECT_EQ(servo(m).enabled_in_motion(), 0u);
    ASSERT_TRUE(at(2)) << "MC_Home " << m.alarms();
    ASSERT_TRUE(at(3)) << "MC_MoveVelocity " << m.alarms();
    EXPECT_NEAR(servo(m).speed(), 300, 10);
    ASSERT_TRUE(at(4)) << "MC_Stop " << m.alarms();
    EXPECT_NEAR(servo(m).speed(), 0, 1);
    m.run(1s);
    EXPECT_NEAR(servo(m).speed(), -30, 6) << "MC_Jog: slow, 5 % of 100 mm/s";
    ASSERT_TRUE(at(6)) << m.alarms();
    EXPECT_NEAR(servo(m).speed(), 0, 1);
    ASSERT_TRUE(at(7)) << "MC_MoveAbsolute " << m.alarms();
    EXPECT_NEAR(variable(m, "position"), 10, 0.06);
    ASSERT_TRUE(at(8));
    EXPECT_EQ(variable(m, "gear_error"), static_cast<double>(axes::ErrorId::not_supported)) << "MC_GearIn";
    EXPECT_EQ(m.axis(u).error, 0);
}

// Line silent, PC alive: ErrorStop, and the output falls at the terminal; EMG brakes the motor by Pr063 (200 ms for 1000 r/min).
TEST(SerialMachine, ASilentLineDropsTheOutputAndTheMotorStops) {
    TestMachine m{with_line(machine_config(1))};
    ASSERT_TRUE(ready(m)) << m.alarms();
    EXPECT_TRUE(m.until([&] { return m.world.output("u_stop"); }, 1s));
    m.enable(u);
    ASSERT_EQ(m.command(OperatorAction::jog, u, true, 20).answer, Answer::accepted);
    for (int i = 0; i < 20; ++i) {
        m.run(50ms);
        (void)m.command(OperatorAction::jog, u, true, 20);
    }
    ASSERT_GT(std::abs(servo(m).speed()), 60);
    m.world.serial().line("rs485")->cut(true);
    ASSERT_TRUE(m.until([&] { return !m.world.output("u_stop"); }, 1s));
    ASSERT_TRUE(m.until([&] { return std::abs(servo(m).speed()) < 1; }, 500ms));
    ASSERT_TRUE(m.until([&] { return m.axis(u).state == AxisState::ErrorStop; }, 500ms)) << m.alarms();
    EXPECT_TRUE(m.has_alarm(id(axes::AxisAlarm::axis_feedback_lost)));
    EXPECT_THAT(m.alarms(), AllOf(HasSubstr("axis u: No answer"), HasSubstr("line 'rs485'"), Not(HasSubstr("slave"))));

    // Back again: the output rises only when the drive has been stopped and disabled; nothing moves by itself.
    m.world.serial().line("rs485")->cut(false);
    ASSERT_TRUE(m.until([&] { return m.world.output("u_stop"); }, 3s));
    EXPECT_EQ(servo(m).parameters()[122], 0);
    m.run(1s);
    EXPECT_NEAR(servo(m).speed(), 0, 1);
}

// PC dead: nobody drops the output any more, but the terminal's own SM watchdog (100 ms) does, and the drive stops.
TEST(SerialMachine, ADeadPcStopsTheMotorThroughTheTerminalsWatchdog) {
    TestMachine m{with_line(machine_config(1))};
    ASSERT_TRUE(ready(m)) << m.alarms();
    m.enable(u);
    ASSERT_EQ(m.command(OperatorAction::jog, u, true, 20).answer, Answer::accepted);
    for (int i = 0; i < 20; ++i) {
        m.run(50ms);
        (void)m.command(OperatorAction::jog, u, true, 20);
    }
    ASSERT_GT(std::abs(servo(m).speed()), 60);
    // Only the world lives on: no frame, no request.
    for (int i = 0; i < 600; ++i) {
        m.clock.advance(1ms);
        m.world.network().advance(m.clock.now());
        m.world.apply_events(m.clock.now());
        m.world.serial().line("rs485")->advance(m.clock.now());
    }
    EXPECT_FALSE(m.world.output("u_stop"));
    EXPECT_NEAR(servo(m).speed(), 0, 1);
}

// Nobody asks a drive that does not answer for half a second at a time: its motor coasts on meanwhile, cycle by cycle, because the service
// looks at the line. Who runs the cycle, in virtual time or a thread, need not know of serial lines.
TEST(SerialMachine, AMotorWithoutMainsCoastsOnWhileNobodyAsks) {
    auto config = with_line(machine_config(1));
    config.axes[u].simulation.viscous_friction = config.axes[u].simulation.coulomb_friction = 0;
    TestMachine m{config};
    ASSERT_TRUE(ready(m)) << m.alarms();
    m.enable(u);
    ASSERT_EQ(m.command(OperatorAction::jog, u, true, 20).answer, Answer::accepted);
    for (int i = 0; i < 10; ++i) {
        m.run(50ms);
        (void)m.command(OperatorAction::jog, u, true, 20);
    }
    ASSERT_GT(std::abs(servo(m).speed()), 20);
    servo(m).power_off();
    int still = 0, longest = 0;
    double before = servo(m).plant().position();
    for (int i = 0; i < 1500; ++i) {
        m.run(1ms);
        still = servo(m).plant().position() == before ? still + 1 : 0;
        longest = std::max(longest, still);
        before = servo(m).plant().position();
    }
    EXPECT_GT(std::abs(servo(m).speed()), 20) << "nothing brakes it";
    EXPECT_EQ(longest, 0) << "cycles without motion while the motor turned";
}

// The same run twice gives the same numbers: the line's times are computed, not measured.
TEST(SerialMachine, RunsAreBitIdentical) {
    const auto run = [] {
        TestMachine m{with_line(machine_config(1))};
        EXPECT_TRUE(ready(m));
        m.enable(u);
        (void)m.command(OperatorAction::jog, u, true, 20);
        m.run(2s);
        return std::tuple{servo(m).plant().position(), m.axis(u).actual_position, m.world.serial().line("rs485")->frames()};
    };
    EXPECT_EQ(run(), run());
}

// --- a line that nobody opened ------------------------------------------------------------------------------------------------------

// The axis must not become a virtual one that moves on the screen only.
TEST(SerialLines, AnAxisWhoseLineNobodyOpenedIsRefused) {
    VirtualClock clock{Instant{}};
    const auto config = with_line(machine_config(1));
    World world{config, clock.now()};
    for (const auto& lines : {std::vector<modbus::SerialLine*>{}, std::vector<modbus::SerialLine*>{nullptr}}) {
        const auto built = Machine::build(config, world.transport(), lines);
        ASSERT_EQ(built.index(), 1u);
        const auto& errors = std::get<1>(built);
        ASSERT_EQ(errors.size(), 1u);
        EXPECT_EQ(errors[0].code, "serial.no_line");
        EXPECT_NE(errors[0].text().find("serial.rs485"), std::string::npos) << "where: " << errors[0].text();
        EXPECT_NE(errors[0].text().find("axis 'u'"), std::string::npos) << "what: " << errors[0].text();
        EXPECT_NE(errors[0].text().find("`device`"), std::string::npos) << "what to do: " << errors[0].text();
    }
}

TEST(SerialLines, ASimulatedAxisNeedsNone) {
    VirtualClock clock{Instant{}};
    auto config = with_line(machine_config(1));
    config.axes[u].axis.simulated = true;
    World world{config, clock.now()};
    EXPECT_EQ(Machine::build(config, world.transport()).index(), 0u);
}

// --- what a configuration must say -------------------------------------------------------------------------------------------------

std::vector<std::string> codes(const MachineConfig& config) {
    std::vector<std::string> out;
    for (const auto& error : check(config)) out.push_back(error.code);
    return out;
}
bool complains(const MachineConfig& config, std::string_view code) {
    const auto all = codes(config);
    return std::find(all.begin(), all.end(), code) != all.end();
}

TEST(SerialCheck, AGoodMachineHasNoProblems) { EXPECT_TRUE(codes(with_line(machine_config(1))).empty()); }

TEST(SerialCheck, ALineWithoutSupervisionMustBeAccepted) {
    auto config = with_line(machine_config(1));
    config.serial[0].drives[0].watchdog_output.clear();
    EXPECT_TRUE(complains(config, "serial.unsupervised"));
    config.serial[0].drives[0].unsupervised_line = UnsupervisedLine::accepted;
    EXPECT_TRUE(codes(config).empty());
    config.serial[0].drives[0].watchdog_output = "u_stpo";
    EXPECT_TRUE(complains(config, "serial.unknown_output"));
}

TEST(SerialCheck, ALineAloneIsNoMachine) {
    auto config = with_line(machine_config(0));
    EXPECT_FALSE(complains(config, "serial.no_bus"));
    config.bus.slaves.clear();
    EXPECT_TRUE(complains(config, "serial.no_bus"));
}

TEST(SerialCheck, NamesStationsAndParametersMustMeet) {
    const auto good = with_line(machine_config(1));
    auto twice = good;
    twice.serial[0].drives.push_back(twice.serial[0].drives[0]);
    EXPECT_TRUE(complains(twice, "serial.station_taken"));
    EXPECT_TRUE(complains(twice, "config.duplicate_name"));
    auto unknown = good;
    unknown.axes[1].drive = "v_drive";
    EXPECT_TRUE(complains(unknown, "axis.unknown_drive"));
    auto limits = good;
    limits.serial[0].drives[0].drive.parameters.erase(limits.serial[0].drives[0].drive.parameters.begin());
    EXPECT_TRUE(complains(limits, "serial.limit_policy"));
    auto reserved = good;
    reserved.serial[0].drives[0].drive.parameters.push_back({13, 1});
    EXPECT_TRUE(complains(reserved, "serial.unknown_parameter"));
    auto range = good;
    range.serial[0].drives[0].drive.parameters.push_back({136, 2});
    EXPECT_TRUE(complains(range, "serial.parameter_range"));
    // Pr098 enables by itself, Pr120 forces SON; Pr137 is the speed that the runtime commands (5.4.1, 5.4.2).
    for (const auto& [number, value] : {std::pair{98, 1}, {120, 10}, {137, 100}}) {
        auto ours = good;
        ours.serial[0].drives[0].drive.parameters.push_back({static_cast<std::uint16_t>(number), value});
        EXPECT_TRUE(complains(ours, "serial.parameter_owned")) << number;
    }
    auto zero = good;
    zero.serial[0].drives[0].drive.parameters.push_back({98, 0});
    EXPECT_FALSE(complains(zero, "serial.parameter_owned")) << "as the runtime wants it";
    auto baud = good;
    baud.serial[0].settings.baud = 115200;
    EXPECT_TRUE(complains(baud, "serial.baud"));
}

TEST(SerialCheck, AnAxisOverALineNeedsAPositionLoopHere) {
    const auto good = with_line(machine_config(1));
    auto csp = good;
    csp.axes[1].axis.control = {};
    EXPECT_TRUE(complains(csp, "axis.control"));
    auto hard = good;
    hard.axes[1].axis.control.kv = 50;
    EXPECT_TRUE(complains(hard, "axis.control"));
    auto narrow = good;  // half a r/min at kv 3: 0.5 / 60 * 10 mm / 3 = 0.028 mm
    narrow.axes[1].axis.windows.in_position = 0.02;
    EXPECT_TRUE(complains(narrow, "axis.in_position"));
    auto homing = good;
    homing.axes[1].axis.homing.kind = axes::HomingKind::drive;
    EXPECT_TRUE(complains(homing, "axis.homing"));
}

// Torque control (Pr004 = 5) ends by EMG and Pr063: 200 ms for 1000 r/min are 833 mm/s2 here, 10 mm a turn; the axis counts on 400.
TEST(SerialCheck, TorqueControlNeedsAWayOut) {
    auto good = with_line(machine_config(1));
    auto& parameters = good.serial[0].drives[0].drive.parameters;
    parameters.push_back({4, 5});
    EXPECT_TRUE(codes(good).empty());
    auto coasts = good;
    std::erase_if(coasts.serial[0].drives[0].drive.parameters, [](const auto& p) { return p.number == 164; });
    EXPECT_TRUE(complains(coasts, "serial.torque_stop"));
    auto soft = good;
    std::erase_if(soft.serial[0].drives[0].drive.parameters, [](const auto& p) { return p.number == 63; });
    soft.serial[0].drives[0].drive.parameters.push_back({63, 420});  // 397 mm/s2
    EXPECT_TRUE(complains(soft, "serial.torque_ramp"));
}

}  // namespace
}  // namespace taktwerk::runtime::testing
