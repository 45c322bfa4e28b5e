#pragma once
// Every kind of motion an axis knows, and every kind of stop: two tables, and the axis (1) with a master (0) that both act on.

#include "tests/axes/axis/coupling_rig.hpp"
#include "tests/axes/axis/walk_axes.hpp"

namespace taktwerk::axes::test {

using namespace std::chrono_literals;

struct SweepTables {
    CamId cam;
    TimeTableRef positions, velocities, accelerations;
};

/// Two axes alike, powered; axis 1 is homed where it stood, at 0.
struct SweptAxis : CouplingRig {
    explicit SweptAxis(AxisConfig config) : CouplingRig(std::vector<AxisConfig>(2, config)) {
        for (auto& drive : drives) {
            drive->switches = true;
            drive->home_low = -90'000;
            drive->home_high = -88'000;
            drive->rated_acceleration = 2e6;
            drive->caps.profile_buffer = 1;
            drive->caps.velocity_limit = true;
        }
        using Rows = std::vector<TimePoint>;
        const auto cam =
            tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0}, {.master = 20, .slave = 12}, {.master = 60, .slave = 0}});
        made.positions = tables.add_time_table(Rows{{400ms, 4.0}, {500ms, 0.0}, {600ms, 6.0}});
        made.velocities = tables.add_time_table(Rows{{100ms, 25.0}, {100ms, 25.0}, {200ms, -20.0}, {400ms, 20.0}});
        made.accelerations = tables.add_time_table(Rows{{100ms, 400.0}, {200ms, 0.0}, {100ms, -280.0}, {400ms, 100.0}});
        start();
        accept(1, {.kind = CommandKind::homing_step, .velocity = 10, .details = HomingStepDetails{.step = HomingStep::direct}});
        EXPECT_TRUE(run_until([&] { return view(1).state == AxisState::Standstill && view(1).homed; }, 50));
        EXPECT_EQ(axes[1].set(SelectCam{cam, true, false, false}, Owner::program), ErrorId::none);
        made.cam = view(1).selected_cam;
        program = [this] { upkeep(); };
    }
    /// What lives by being held or fed.
    void upkeep() {
        const auto& at = view(1);
        if (at.active_kind == CommandKind::jog && jogs) (void)axes[1].renew_jog(at.active, jog_velocity, Owner::program);
        if (at.active_kind != CommandKind::external) return;
        const double period = to_seconds(cycle);
        const double velocity = at.set_velocity + (300 * std::cos(++fed * 0.02) - at.set_velocity) * period;
        (void)axes[1].set(
            SetpointFeed{at.set_position + (at.set_velocity + velocity) / 2 * period, velocity, (velocity - at.set_velocity) / period},
            Owner::program);
    }
    CommandId give(const AxisCommand& command) { return accept(1, command); }
    void override_velocity(double factor) {
        EXPECT_EQ(axes[1].set(Override{.velocity = factor, .acceleration = 1, .jerk = 1}, Owner::program), ErrorId::none);
    }

    SweepTables made;
    bool jogs = true;
    double jog_velocity = 40;
    int fed = 0;
};

[[nodiscard]] inline AxisCommand an_addition(double distance, double velocity) {
    return {.kind = CommandKind::move_superimposed, .position = distance, .velocity = velocity};
}
[[nodiscard]] inline AxisCommand a_profile(CommandKind kind, TimeTableRef table) {
    return {.kind = kind, .details = TimeProfileDetails{.table = table}};
}

struct SweptMotion {
    enum class Made : std::uint8_t { planned, followed, given, by_motor, homing };
    const char* name;
    Made made;
    int from;  ///< cycles from its begin to the first stop that is tried
    void (*act)(SweptAxis&, int cycle);
};

/// `act` is called before each cycle up to the stop.
inline const std::array swept_motions{
    SweptMotion{"MoveAbsolute", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(absolute(15, 80));
                }},
    SweptMotion{"MoveRelative backwards", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(relative(-15, 80));
                }},
    SweptMotion{"MoveAdditive", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(absolute(8, 60));
                    if (i == 40) it.give({.kind = CommandKind::move_additive, .position = -12, .velocity = 90});
                }},
    SweptMotion{"MoveContinuousAbsolute", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give({.kind = CommandKind::move_continuous_absolute, .position = 6, .velocity = 70, .end_velocity = 20});
                }},
    SweptMotion{"MoveContinuousRelative that returns", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0)
                        it.give({.kind = CommandKind::move_continuous_relative, .position = 4, .velocity = 70, .end_velocity = -30});
                }},
    SweptMotion{"MoveVelocity", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(-90));
                }},
    SweptMotion{"MoveVelocity that turns round", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(40));
                    if (i == 60) it.give(at_velocity(-60));
                    if (i == 190) it.give(at_velocity(60));
                }},
    SweptMotion{"blended moves", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i != 0) return;
                    it.give(absolute(4, 40));
                    it.give(absolute(9, 90, mcBlendingHigh));
                    it.give(absolute(2, 60, mcBuffered));
                }},
    SweptMotion{"jog", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(jog(40));
                    if (i == 120) it.jog_velocity = -50;
                }},
    SweptMotion{"override", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(80));
                    if (i == 50) it.override_velocity(0.2);
                    if (i == 100) it.override_velocity(0);
                    if (i == 170) it.override_velocity(0.7);
                }},
    SweptMotion{"halted", SweptMotion::Made::planned, 61,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(80));
                    if (i == 60) it.give({.kind = CommandKind::halt, .deceleration = 250, .jerk = 4000});
                }},
    SweptMotion{"halted while it speeds up", SweptMotion::Made::planned, 41,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(80));
                    if (i == 40) it.give({.kind = CommandKind::halt, .deceleration = 250});
                }},
    SweptMotion{"MoveSuperimposed alone", SweptMotion::Made::planned, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(an_addition(12, 60));
                }},
    SweptMotion{"MoveVelocity and MoveSuperimposed", SweptMotion::Made::planned, 25,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(30));
                    if (i == 20) it.give(an_addition(-5, 45));
                    if (i == 150) it.give(an_addition(9, 45));
                }},
    SweptMotion{"MoveAbsolute and MoveSuperimposed", SweptMotion::Made::planned, 25,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(absolute(12, 50));
                    if (i == 20) it.give(an_addition(8, 50));
                }},
    SweptMotion{"HaltSuperimposed", SweptMotion::Made::planned, 62,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(30));
                    if (i == 10) it.give(an_addition(-20, 60));
                    if (i == 60) it.give({.kind = CommandKind::halt_superimposed, .deceleration = 200});
                }},
    SweptMotion{"GearIn", SweptMotion::Made::followed, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.accept(0, at_velocity(50));
                    if (i == 10) it.give(gear_in(0, 3, 2));
                    if (i == 160) it.accept(0, at_velocity(10));
                }},
    SweptMotion{"GearIn backwards", SweptMotion::Made::followed, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(gear_in(0, -1, 1));
                    if (i == 1) it.accept(0, at_velocity(90));
                    if (i == 140) it.accept(0, stop());
                }},
    SweptMotion{"GearIn and MoveSuperimposed", SweptMotion::Made::followed, 45,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(gear_in(0));
                    if (i == 1) it.accept(0, at_velocity(40));
                    if (i == 40) it.give(an_addition(-6, 60));
                    if (i == 150) it.accept(0, at_velocity(5));
                }},
    SweptMotion{"GearIn and phasing", SweptMotion::Made::followed, 25,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(gear_in(0));
                    if (i == 1) it.accept(0, at_velocity(40));
                    if (i == 90) it.give(phasing(CommandKind::phasing_relative, 6, 40));
                }},
    SweptMotion{"GearIn and a phasing that is halted", SweptMotion::Made::followed, 25,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(gear_in(0));
                    if (i == 1) it.accept(0, at_velocity(40));
                    if (i == 90) it.give(phasing(CommandKind::phasing_relative, -6, 40));
                    if (i == 120) it.give({.kind = CommandKind::halt_phasing, .deceleration = 400});
                }},
    SweptMotion{"GearInPos", SweptMotion::Made::followed, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.accept(0, at_velocity(40));
                    if (i == 30) it.give(gear_in_pos(0, 12, 6, 9));
                }},
    SweptMotion{"GearInPos that waits in motion", SweptMotion::Made::planned, 25,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(60));
                    if (i == 20) it.give(gear_in_pos(0, 100, 50, 20));
                    if (i == 120) it.override_velocity(0.3);
                }},
    SweptMotion{"an abandoned addition under a coupling that waits", SweptMotion::Made::planned, 72,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(40));
                    if (i == 20) it.give({.kind = CommandKind::move_superimposed, .position = -20, .velocity = 50, .deceleration = 200});
                    if (i == 70) it.give(gear_in_pos(0, 100, 50, 20));
                }},
    SweptMotion{"CamIn", SweptMotion::Made::followed, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.accept(0, at_velocity(60));
                    if (i == 20) it.give(cam_in(0, it.made.cam, mcRelative));
                }},
    SweptMotion{"CombineAxes", SweptMotion::Made::followed, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(combine(0, 0, mcAddAxes, {1, 2}, {1, 3}));
                    if (i == 1) it.accept(0, relative(25, 80));
                }},
    SweptMotion{"GearOut", SweptMotion::Made::planned, 62,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(gear_in(0, 2, 1));
                    if (i == 1) it.accept(0, at_velocity(90));
                    if (i == 60) it.give(gear_out());
                }},
    SweptMotion{"PositionProfile", SweptMotion::Made::given, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(a_profile(CommandKind::position_profile, it.made.positions));
                }},
    SweptMotion{"VelocityProfile", SweptMotion::Made::given, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(a_profile(CommandKind::velocity_profile, it.made.velocities));
                }},
    SweptMotion{"AccelerationProfile", SweptMotion::Made::given, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(a_profile(CommandKind::acceleration_profile, it.made.accelerations));
                }},
    SweptMotion{"fed set-points", SweptMotion::Made::given, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give({.kind = CommandKind::external});
                }},
    SweptMotion{"TorqueControl", SweptMotion::Made::by_motor, 20,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give({.kind = CommandKind::torque, .velocity = 50, .details = TorqueDetails{0.2, 5}});
                }},
    SweptMotion{"profile velocity of the drive", SweptMotion::Made::by_motor, 20,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give({.kind = CommandKind::drive_move_velocity, .velocity = -60});
                }},
    SweptMotion{"profile position of the drive", SweptMotion::Made::by_motor, 20,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give({.kind = CommandKind::drive_move_absolute, .position = 30, .velocity = 60});
                }},
    SweptMotion{"MoveVelocity on the way to the drive's profile", SweptMotion::Made::planned, 42,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(at_velocity(70));
                    if (i == 40) it.give({.kind = CommandKind::drive_move_velocity, .velocity = -60, .deceleration = 300});
                }},
    SweptMotion{"Home by a switch", SweptMotion::Made::homing, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0) it.give(home(0));
                }},
    SweptMotion{"StepAbsoluteSwitch", SweptMotion::Made::homing, 5,
                [](SweptAxis& it, int i) {
                    if (i == 0)
                        it.give({.kind = CommandKind::homing_step,
                                 .velocity = 60,
                                 .details = HomingStepDetails{.step = HomingStep::absolute_switch,
                                                              .direction = MC_HomeDirection::mcNegativeDirection,
                                                              .switch_mode = MC_SwitchMode::mcEdgeSwitchNegative,
                                                              .reference = {.source = TriggerSource::home_switch}}});
                }},
};

/// What has become of it when it is over.
struct SweptStop {
    enum class Sense : std::uint8_t { kept, any };  ///< any: the motion goes on until it comes to the limit
    const char* name;
    AxisState ends_in;
    Sense sense;
    bool (*begin)(SweptAxis&);  ///< false: not for this motion
    bool homing = true;         ///< ends a homing too
};

inline bool given(SweptAxis& it, const AxisCommand& command) { return it.axes[1].submit(command, Owner::program).error == ErrorId::none; }

/// Software limits `share` times the way ahead, and behind, that the axis needs to stop in; false where it could not.
inline bool limited_ahead(SweptAxis& it, double share) {
    const auto& view = it.view(1);
    const auto& limits = it.axes[1].config().limits;
    const double ease = 1 / limits.jerk, a = std::abs(view.set_acceleration);
    const double speed = std::abs(view.set_velocity) + a * a * ease / 2;
    const double way = share * speed * (a * ease + speed / limits.deceleration / 2 + limits.deceleration * ease / 2) + 0.5;
    const auto write = [&](std::int32_t number, double value) {
        return it.axes[1].set(WriteParameter{number, value}, Owner::program) == ErrorId::none;
    };
    return write(software_limit_positive, view.set_position + way) && write(software_limit_negative, view.set_position - way) &&
           write(enable_limit_positive, 1) && write(enable_limit_negative, 1);
}

inline const std::array swept_stops{
    SweptStop{"MC_Stop", AxisState::Stopping, SweptStop::Sense::kept, [](SweptAxis& it) { return given(it, stop()); }},
    SweptStop{"soft MC_Stop", AxisState::Stopping, SweptStop::Sense::kept,
              [](SweptAxis& it) { return given(it, {.kind = CommandKind::stop, .deceleration = 250, .jerk = 1500}); }},
    SweptStop{"MC_Halt", AxisState::Standstill, SweptStop::Sense::kept, [](SweptAxis& it) { return given(it, halt()); }, false},
    SweptStop{"soft MC_Halt", AxisState::Standstill, SweptStop::Sense::kept,
              [](SweptAxis& it) { return given(it, {.kind = CommandKind::halt, .deceleration = 250, .jerk = 1500}); }, false},
    SweptStop{"two stops in a cycle", AxisState::ErrorStop, SweptStop::Sense::kept,
              [](SweptAxis& it) {
                  it.axes[1].set_mode(OperatingMode::manual);
                  it.axes[1].stop_for_error(AlarmId{4711}, false);
                  return true;
              }},
    SweptStop{"emergency stop", AxisState::ErrorStop, SweptStop::Sense::kept,
              [](SweptAxis& it) {
                  it.axes[1].demand_emergency_stop(EmergencyStop::stop);
                  return true;
              }},
    SweptStop{"emergency stop and power off", AxisState::ErrorStop, SweptStop::Sense::kept,
              [](SweptAxis& it) {
                  it.axes[1].demand_emergency_stop(EmergencyStop::stop_and_power_off);
                  return true;
              }},
    SweptStop{"axis error", AxisState::ErrorStop, SweptStop::Sense::kept,
              [](SweptAxis& it) {
                  it.axes[1].stop_for_error(AlarmId{4711}, false);
                  return true;
              }},
    SweptStop{"power off", AxisState::Disabled, SweptStop::Sense::kept,
              [](SweptAxis& it) {
                  it.enabled[1] = false;
                  return true;
              }},
    SweptStop{"change of hands", AxisState::Standstill, SweptStop::Sense::kept,
              [](SweptAxis& it) {
                  it.axes[1].take_control(Owner::operator_panel);
                  return true;
              }},
    SweptStop{"limit switch", AxisState::ErrorStop, SweptStop::Sense::any,
              [](SweptAxis& it) {
                  const auto counts = static_cast<std::int64_t>(it.drives[1]->position);
                  (it.view(1).set_velocity > 0 ? it.drives[1]->positive_end : it.drives[1]->negative_end) = counts;
                  return std::abs(it.view(1).set_velocity) > 1 && it.view(1).set_velocity * it.view(1).set_acceleration >= 0;
              },
              false},
    SweptStop{"barred direction", AxisState::Standstill, SweptStop::Sense::any,
              [](SweptAxis& it) {
                  it.permits[1] = 0;
                  return it.view(1).set_velocity != 0;
              },
              false},
    SweptStop{"bus lost", AxisState::ErrorStop, SweptStop::Sense::any,
              [](SweptAxis& it) {
                  it.drives[1]->offline = true;
                  return true;
              }},
    SweptStop{"feedback lost", AxisState::ErrorStop, SweptStop::Sense::any,
              [](SweptAxis& it) {
                  it.drives[1]->silent = true;
                  return true;
              }},
    SweptStop{"MC_MoveVelocity 0", AxisState::ContinuousMotion, SweptStop::Sense::kept,
              [](SweptAxis& it) { return given(it, at_velocity(0)); }, false},
    SweptStop{"software limit", AxisState::Standstill, SweptStop::Sense::any, [](SweptAxis& it) { return limited_ahead(it, 1.5); }, false},
    SweptStop{
        "soft MC_Stop before a software limit", AxisState::Stopping, SweptStop::Sense::kept,
        [](SweptAxis& it) { return limited_ahead(it, 1.1) && given(it, {.kind = CommandKind::stop, .deceleration = 250, .jerk = 1500}); },
        false},
};

}  // namespace taktwerk::axes::test
