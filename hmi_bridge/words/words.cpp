#include "hmi_bridge/words/words.hpp"

#include "axes/axis/command_kinds.hpp"

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

std::string_view word(axes::CommandKind value) noexcept { return axes::name(value); }

std::string_view word(axes::BrakeState value) noexcept {
    switch (value) {
        case axes::BrakeState::not_controlled: return "not_controlled";
        case axes::BrakeState::closed: return "closed";
        case axes::BrakeState::opening: return "opening";
        case axes::BrakeState::open: return "open";
        case axes::BrakeState::closing: return "closing";
    }
    return "unknown";
}

std::string_view word(axes::HomingKind value) noexcept {
    switch (value) {
        case axes::HomingKind::none: return "none";
        case axes::HomingKind::drive: return "drive";
        case axes::HomingKind::home_switch: return "home_switch";
        case axes::HomingKind::set_here: return "set_here";
        case axes::HomingKind::limit_switch: return "limit_switch";
        case axes::HomingKind::block: return "block";
        case axes::HomingKind::reference_pulse: return "reference_pulse";
        case axes::HomingKind::absolute: return "absolute";
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
