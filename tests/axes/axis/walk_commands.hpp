#pragma once
// Every kind of command with any numbers: what a program, a person or a mistake may ask of an axis. Most can be done, some cannot, a few are
// hostile; an axis answers each of them.

#include <array>
#include <functional>
#include <string_view>
#include <utility>

#include "axes/axis/parameters.hpp"
#include "tests/axes/axis/walk_axes.hpp"

namespace taktwerk::axes::test {

/// Each kind once, and how often it is drawn.
struct WalkKind {
    CommandKind kind;
    std::string_view name;
    unsigned weight;
};
inline constexpr std::array walk_kinds{
    WalkKind{CommandKind::move_absolute, "move_absolute", 8},
    WalkKind{CommandKind::move_relative, "move_relative", 6},
    WalkKind{CommandKind::move_additive, "move_additive", 4},
    WalkKind{CommandKind::halt, "halt", 3},
    WalkKind{CommandKind::move_velocity, "move_velocity", 10},
    WalkKind{CommandKind::move_continuous_absolute, "move_continuous_absolute", 3},
    WalkKind{CommandKind::move_continuous_relative, "move_continuous_relative", 3},
    WalkKind{CommandKind::move_superimposed, "move_superimposed", 12},
    WalkKind{CommandKind::halt_superimposed, "halt_superimposed", 3},
    WalkKind{CommandKind::stop, "stop", 2},
    WalkKind{CommandKind::home, "home", 3},
    WalkKind{CommandKind::jog, "jog", 4},
    WalkKind{CommandKind::gear_in, "gear_in", 8},
    WalkKind{CommandKind::gear_in_pos, "gear_in_pos", 10},
    WalkKind{CommandKind::cam_in, "cam_in", 12},
    WalkKind{CommandKind::combine, "combine", 4},
    WalkKind{CommandKind::gear_out, "gear_out", 3},
    WalkKind{CommandKind::cam_out, "cam_out", 2},
    WalkKind{CommandKind::phasing_absolute, "phasing_absolute", 6},
    WalkKind{CommandKind::phasing_relative, "phasing_relative", 4},
    WalkKind{CommandKind::halt_phasing, "halt_phasing", 2},
    WalkKind{CommandKind::position_profile, "position_profile", 4},
    WalkKind{CommandKind::velocity_profile, "velocity_profile", 3},
    WalkKind{CommandKind::acceleration_profile, "acceleration_profile", 3},
    WalkKind{CommandKind::torque, "torque", 3},
    WalkKind{CommandKind::external, "external", 3},
    WalkKind{CommandKind::homing_step, "homing_step", 5},
    WalkKind{CommandKind::abort_passive_homing, "abort_passive_homing", 1},
    WalkKind{CommandKind::touch_probe, "touch_probe", 3},
    WalkKind{CommandKind::abort_trigger, "abort_trigger", 2},
    WalkKind{CommandKind::setting, "setting", 4},
    WalkKind{CommandKind::set_controller_mode, "set_controller_mode", 1},
    WalkKind{CommandKind::drive_move_absolute, "drive_move_absolute", 2},
    WalkKind{CommandKind::drive_move_relative, "drive_move_relative", 2},
    WalkKind{CommandKind::drive_move_velocity, "drive_move_velocity", 2},
    WalkKind{CommandKind::drive_torque, "drive_torque", 1},
};
static_assert(walk_kinds.size() == static_cast<std::size_t>(CommandKind::drive_torque), "each kind but none");

[[nodiscard]] inline CommandKind any_kind(Dice& dice) {
    unsigned all = 0;
    for (const auto& kind : walk_kinds) all += kind.weight;
    unsigned at = dice.below(all);
    for (const auto& kind : walk_kinds) {
        if (at < kind.weight) return kind.kind;
        at -= kind.weight;
    }
    return CommandKind::halt;
}
[[nodiscard]] inline std::string_view walk_name(CommandKind kind) {
    for (const auto& known : walk_kinds)
        if (known.kind == kind) return known.name;
    return "none";
}

class AnyCommand {
public:
    using Views = std::function<const AxisView&(std::size_t)>;
    AnyCommand(Dice& dice, std::size_t axes, Views views, const WalkTables& tables)
        : dice_(dice), axes_(static_cast<unsigned>(axes)), views_(std::move(views)), tables_(tables) {}

    [[nodiscard]] AxisCommand operator()(std::size_t axis) { return of(axis, any_kind(dice_)); }

    [[nodiscard]] AxisCommand of(std::size_t axis, CommandKind kind) {
        AxisCommand command = plain(kind);
        fill(axis, command);
        if (dice_.once_in(80)) spoil(command);
        return command;
    }
    [[nodiscard]] AxisSetting any_setting(std::size_t axis) {
        switch (dice_.below(8)) {
            case 0:
            case 1: return SetPosition{dice_.between(-20, 20), dice_.once_in(2)};
            case 2:
            case 3: return parameter(axis);
            case 4: return WriteOutput{static_cast<std::int32_t>(dice_.below(32)), dice_.once_in(2)};
            case 5: return SelectCam{tables_.cams[dice_.below(3)], dice_.once_in(2), dice_.once_in(2), dice_.once_in(2)};
            default: return any_override();
        }
    }
    [[nodiscard]] Override any_override() {
        if (dice_.once_in(3)) return {};
        return {dice_.once_in(4) ? 0 : dice_.between(0.1, 1), dice_.between(0.3, 1), dice_.between(0.3, 1)};
    }

private:
    [[nodiscard]] AxisCommand plain(CommandKind kind) {
        AxisCommand command{.kind = kind};
        command.position = dice_.between(-60, 60);
        command.velocity = dice_.between(8, 120);
        command.end_velocity = dice_.between(-60, 60);
        command.direction = static_cast<MC_Direction>(dice_.below(4));
        if (dice_.once_in(2)) command.buffer_mode = static_cast<MC_BufferMode>(dice_.below(6));
        if (dice_.once_in(3)) command.acceleration = dice_.between(100, 1200);
        if (dice_.once_in(3)) command.deceleration = dice_.between(100, 1200);
        if (dice_.once_in(3)) command.jerk = dice_.between(3000, 25'000);
        return command;
    }
    [[nodiscard]] AxisRef other() { return CouplingRig::ref(dice_.below(axes_)); }
    [[nodiscard]] GearRatio ratio() {
        return {static_cast<std::int32_t>(dice_.below(7)) - 3, static_cast<std::int32_t>(dice_.below(4)) + 1};
    }
    [[nodiscard]] MC_Source source() { return dice_.once_in(4) ? mcActualValue : mcSetValue; }
    /// Half of them near the master, so that waiting ends.
    [[nodiscard]] double near(AxisRef master) {
        const auto& view = views_(master.index);
        const double there = dice_.once_in(2) ? view.set_position + dice_.between(-25, 25) : dice_.between(-60, 60);
        return view.modulo > 0 ? there - view.modulo * std::floor(there / view.modulo) : there;
    }
    void fill(std::size_t axis, AxisCommand& command) {
        const auto& view = views_(axis);
        const bool stands = view.state == AxisState::Standstill;
        using enum CommandKind;
        switch (command.kind) {
            case move_absolute:
            case move_continuous_absolute:
            case drive_move_absolute:
                if (view.modulo > 0) {
                    command.position = dice_.between(0, view.modulo * 0.999);
                    if (command.kind == move_absolute && dice_.once_in(4)) {
                        command.position += view.modulo * dice_.below(3);
                        command.details = WholeTurns{};
                    }
                }
                break;
            case move_relative:
            case move_additive:
            case move_continuous_relative:
            case drive_move_relative: command.position = dice_.between(-30, 30); break;
            case move_velocity:
            case drive_move_velocity:
                command.velocity = dice_.between(-90, 90);
                if (command.direction == mcShortestWay) command.direction = mcPositiveDirection;
                break;
            case move_superimposed:
                command.position = dice_.between(-10, 10);
                command.velocity = dice_.once_in(4) ? 0 : dice_.between(2, 50);
                command.buffer_mode = mcAborting;
                break;
            case halt_superimposed:
            case halt_phasing:
            case stop:
            case gear_out:
            case cam_out: command.buffer_mode = mcAborting; break;
            case jog:
                command.velocity = dice_.between(-60, 60);
                command.buffer_mode = mcAborting;
                break;
            case home: command.position = dice_.once_in(4) ? std::nan("") : dice_.between(-10, 10); break;
            case gear_in: command.details = GearDetails{other(), ratio(), source()}; break;
            case gear_in_pos: {
                const auto master = other();
                command.details = GearInPosDetails{.master = master,
                                                   .ratio = ratio(),
                                                   .source = source(),
                                                   .mode = static_cast<MC_SyncMode>(dice_.below(3)),
                                                   .master_sync_position = near(master),
                                                   .slave_sync_position = view.set_position + dice_.between(-10, 10),
                                                   .master_start_distance = dice_.once_in(3) ? 0 : dice_.between(-20, 20)};
                if (dice_.once_in(2)) command.velocity = 0;
                break;
            }
            case cam_in: {
                const auto master = other();
                command.details = CamDetails{.master = master,
                                             .table = view.selected_cam,
                                             .start = static_cast<MC_StartMode>(dice_.below(3)),
                                             .source = source(),
                                             .master_offset = dice_.once_in(3) ? dice_.between(-10, 10) : 0,
                                             .slave_offset = dice_.once_in(3) ? dice_.between(-10, 10) : 0,
                                             .master_scaling = dice_.once_in(3) ? dice_.between(-2, 2) : 1,
                                             .slave_scaling = dice_.once_in(3) ? dice_.between(-2, 2) : 1,
                                             .master_start_distance = dice_.once_in(2) ? 0 : dice_.between(-20, 20),
                                             .master_sync_position = near(master)};
                break;
            }
            case combine:
                command.details = CombineDetails{.master1 = other(),
                                                 .master2 = other(),
                                                 .ratio1 = ratio(),
                                                 .ratio2 = ratio(),
                                                 .source1 = source(),
                                                 .source2 = source(),
                                                 .mode = dice_.once_in(2) ? mcAddAxes : mcSubAxes};
                break;
            case phasing_absolute:
            case phasing_relative:
                command.position = dice_.between(-8, 8);
                command.velocity = dice_.between(1, 40);
                command.buffer_mode = dice_.once_in(2) ? mcBuffered : mcAborting;
                break;
            case position_profile: {  // begins where the axis is, mostly
                const double offset = dice_.once_in(4) ? dice_.between(-5, 5) : view.set_position;
                command.details =
                    TimeProfileDetails{tables_.positions[dice_.below(2)], dice_.between(0.7, 2), dice_.between(-1, 1), offset};
                break;
            }
            case velocity_profile:
                command.details =
                    TimeProfileDetails{tables_.velocities[dice_.below(2)], dice_.between(0.7, 2), dice_.between(-1, 1), view.set_velocity};
                break;
            case acceleration_profile:
                command.details =
                    TimeProfileDetails{tables_.accelerations[dice_.below(2)], dice_.between(0.7, 1.5), dice_.between(-1, 1), 0};
                break;
            case torque:
            case drive_torque:
                command.velocity = dice_.once_in(2) ? 0 : dice_.between(5, 60);
                command.details = TorqueDetails{dice_.between(-0.5, 0.5), dice_.once_in(2) ? 0 : dice_.between(0.5, 5)};
                break;
            case homing_step: step(command, stands); break;
            case touch_probe:
                last_trigger_ = trigger();
                command.details = ProbeDetails{.trigger = last_trigger_, .window_only = dice_.once_in(3), .first = -50, .last = 50};
                break;
            case abort_trigger:  // mostly one that may still wait
                command.details = ProbeDetails{.trigger = dice_.once_in(4) ? trigger() : last_trigger_};
                break;
            case setting:
                command.details = any_setting(axis);
                command.buffer_mode = mcBuffered;
                break;
            case set_controller_mode:
                command.position = static_cast<double>(dice_.one_of(
                    {DriveMode::cyclic_position, DriveMode::cyclic_velocity, DriveMode::cyclic_position, DriveMode::cyclic_torque}));
                break;
            default: break;
        }
    }
    [[nodiscard]] TriggerRef trigger() {
        return {
            .source = dice_.one_of({TriggerSource::probe1, TriggerSource::probe2, TriggerSource::index_pulse, TriggerSource::home_switch}),
            .falling = dice_.once_in(3)};
    }
    void step(AxisCommand& command, bool stands) {
        HomingStepDetails step;
        step.step = static_cast<HomingStep>(dice_.below(10));
        if (!stands && dice_.once_in(2)) step.step = dice_.one_of({HomingStep::flying_switch, HomingStep::finish, HomingStep::direct});
        step.direction = static_cast<MC_HomeDirection>(dice_.below(4));
        step.switch_mode = static_cast<MC_SwitchMode>(dice_.below(6));
        const bool pulse = step.step == HomingStep::reference_pulse || step.step == HomingStep::flying_reference_pulse;
        step.reference.source = pulse ? TriggerSource::index_pulse : TriggerSource::home_switch;
        step.set_position = dice_.once_in(4) ? std::nan("") : dice_.between(-10, 10);
        step.torque_limit = step.step == HomingStep::block ? 0.2 : 0;
        step.detection_velocity_limit = step.step == HomingStep::block ? 1 : 0;
        step.detection_velocity_time = 20ms;
        step.time_limit = 2s;
        if (dice_.once_in(2)) step.distance_limit = dice_.between(5, 60);
        command.position = dice_.between(-3, 3);
        command.velocity = dice_.between(3, 40);
        command.details = step;
    }
    [[nodiscard]] WriteParameter parameter(std::size_t axis) {
        const auto& view = views_(axis);
        switch (dice_.below(10)) {
            case 0: return {software_limit_positive, dice_.between(30, 90)};
            case 1: return {software_limit_negative, dice_.between(-90, -30)};
            case 2: return {enable_limit_positive, static_cast<double>(dice_.below(2))};
            case 3: return {enable_limit_negative, static_cast<double>(dice_.below(2))};
            case 4:
            case 5:
                return {velocity_of_application, dice_.once_in(2) ? view.parameters[place_of(velocity_of_system)] : dice_.between(20, 100)};
            case 6:
                return {acceleration_of_application,
                        dice_.once_in(2) ? view.parameters[place_of(acceleration_of_system)] : dice_.between(300, 1000)};
            case 7:
                return {deceleration_of_application,
                        dice_.once_in(2) ? view.parameters[place_of(deceleration_of_system)] : dice_.between(300, 1000)};
            case 8:
                return {jerk_of_application, dice_.once_in(2) ? view.parameters[place_of(jerk_of_system)] : dice_.between(5000, 20'000)};
            default: return {jog_velocity_slow, dice_.between(1, 20)};
        }
    }
    /// Numbers that no axis can do.
    void spoil(AxisCommand& command) {
        const double bad = dice_.one_of({std::nan(""), std::numeric_limits<double>::infinity(), -1.0, 1e300, -0.0});
        switch (dice_.below(5)) {
            case 0: command.position = bad; break;
            case 1: command.velocity = bad; break;
            case 2: command.acceleration = bad; break;
            case 3: command.jerk = bad; break;
            default: command.details = TorqueDetails{bad, bad}; break;
        }
    }

    Dice& dice_;
    TriggerRef last_trigger_{};
    unsigned axes_;
    Views views_;
    const WalkTables& tables_;
};

}  // namespace taktwerk::axes::test
