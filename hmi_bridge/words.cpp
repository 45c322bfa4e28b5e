#include "hmi_bridge/words.hpp"

namespace taktwerk::hmi {

std::string_view word(runtime::MachinePhase value) noexcept {
    switch (value) {
        case runtime::MachinePhase::starting: return "starting";
        case runtime::MachinePhase::running: return "running";
        case runtime::MachinePhase::stopping: return "stopping";
        case runtime::MachinePhase::stopped: return "stopped";
        case runtime::MachinePhase::failed: return "failed";
    }
    return "unknown";
}

std::string_view word(runtime::Mode value) noexcept {
    switch (value) {
        case runtime::Mode::manual: return "manual";
        case runtime::Mode::setup: return "setup";
        case runtime::Mode::automatic: return "automatic";
    }
    return "unknown";
}

std::string_view word(runtime::ProgramState value) noexcept {
    switch (value) {
        case runtime::ProgramState::stopped: return "stopped";
        case runtime::ProgramState::running: return "running";
        case runtime::ProgramState::fault: return "fault";
    }
    return "unknown";
}

std::string_view word(ecat::Master::Phase value) noexcept {
    switch (value) {
        case ecat::Master::Phase::idle: return "idle";
        case ecat::Master::Phase::scanning: return "scanning";
        case ecat::Master::Phase::preop: return "preop";
        case ecat::Master::Phase::configuring: return "configuring";
        case ecat::Master::Phase::safeop: return "safeop";
        case ecat::Master::Phase::operational: return "operational";
        case ecat::Master::Phase::failed: return "failed";
        case ecat::Master::Phase::stopping: return "stopping";
        case ecat::Master::Phase::stopped: return "stopped";
    }
    return "unknown";
}

std::string_view word(axes::VelocityLimiter value) noexcept {
    switch (value) {
        case axes::VelocityLimiter::none: return "none";
        case axes::VelocityLimiter::command: return "command";
        case axes::VelocityLimiter::axis_limit: return "axis_limit";
        case axes::VelocityLimiter::manual_speed: return "manual_speed";
        case axes::VelocityLimiter::override_factor: return "override_factor";
        case axes::VelocityLimiter::software_limit: return "software_limit";
        case axes::VelocityLimiter::stopping: return "stopping";
    }
    return "unknown";
}

std::string_view word(axes::CommandKind value) noexcept {
    switch (value) {
        case axes::CommandKind::none: return "";
        case axes::CommandKind::move_absolute: return "MC_MoveAbsolute";
        case axes::CommandKind::move_relative: return "MC_MoveRelative";
        case axes::CommandKind::move_additive: return "MC_MoveAdditive";
        case axes::CommandKind::halt: return "MC_Halt";
        case axes::CommandKind::move_velocity: return "MC_MoveVelocity";
        case axes::CommandKind::move_continuous_absolute: return "MC_MoveContinuousAbsolute";
        case axes::CommandKind::move_continuous_relative: return "MC_MoveContinuousRelative";
        case axes::CommandKind::move_superimposed: return "MC_MoveSuperimposed";
        case axes::CommandKind::halt_superimposed: return "MC_HaltSuperimposed";
        case axes::CommandKind::stop: return "MC_Stop";
        case axes::CommandKind::home: return "MC_Home";
        case axes::CommandKind::jog: return "MC_Jog";
        case axes::CommandKind::gear_in: return "MC_GearIn";
        case axes::CommandKind::gear_in_pos: return "MC_GearInPos";
        case axes::CommandKind::cam_in: return "MC_CamIn";
        case axes::CommandKind::combine: return "MC_CombineAxes";
        case axes::CommandKind::gear_out: return "MC_GearOut";
        case axes::CommandKind::cam_out: return "MC_CamOut";
        case axes::CommandKind::phasing_absolute: return "MC_PhasingAbsolute";
        case axes::CommandKind::phasing_relative: return "MC_PhasingRelative";
        case axes::CommandKind::position_profile: return "MC_PositionProfile";
        case axes::CommandKind::velocity_profile: return "MC_VelocityProfile";
        case axes::CommandKind::acceleration_profile: return "MC_AccelerationProfile";
        case axes::CommandKind::torque: return "MC_TorqueControl";
        case axes::CommandKind::external: return "MC_ExtSetPointGenEnable";
        case axes::CommandKind::homing_step: return "a homing step";
        case axes::CommandKind::abort_passive_homing: return "MC_AbortPassiveHoming";
        case axes::CommandKind::touch_probe: return "MC_TouchProbe";
        case axes::CommandKind::abort_trigger: return "MC_AbortTrigger";
        case axes::CommandKind::setting: return "a queued setting";
        case axes::CommandKind::set_controller_mode: return "MC_SetControllerMode";
        case axes::CommandKind::drive_move_absolute: return "Drive_MoveAbsolute";
        case axes::CommandKind::drive_move_relative: return "Drive_MoveRelative";
        case axes::CommandKind::drive_move_velocity: return "Drive_MoveVelocity";
        case axes::CommandKind::drive_torque: return "Drive_Torque";
    }
    return "unknown";
}

std::string_view word(AlarmSource value) noexcept {
    switch (value) {
        case AlarmSource::machine: return "machine";
        case AlarmSource::bus: return "bus";
        case AlarmSource::slave: return "slave";
        case AlarmSource::axis: return "axis";
        case AlarmSource::program: return "program";
        case AlarmSource::task: return "task";
        case AlarmSource::io: return "io";
        case AlarmSource::hmi: return "hmi";
    }
    return "unknown";
}

std::string_view word(Reaction value) noexcept {
    switch (value) {
        case Reaction::none: return "none";
        case Reaction::warn: return "warn";
        case Reaction::stop_axis: return "stop_axis";
        case Reaction::stop_machine: return "stop_machine";
        case Reaction::power_off: return "power_off";
    }
    return "unknown";
}

std::string_view word(VariableType value) noexcept {
    switch (value) {
        case VariableType::boolean: return "boolean";
        case VariableType::int32: return "int32";
        case VariableType::int64: return "int64";
        case VariableType::uint16: return "uint16";
        case VariableType::uint32: return "uint32";
        case VariableType::real: return "real";
        case VariableType::duration: return "duration";
    }
    return "unknown";
}

}  // namespace taktwerk::hmi
