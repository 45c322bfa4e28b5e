#include "axes/words/types.hpp"

namespace taktwerk::axes {

std::string_view name(AxisState state) noexcept {
    switch (state) {
        case AxisState::Disabled: return "Disabled";
        case AxisState::Standstill: return "Standstill";
        case AxisState::Homing: return "Homing";
        case AxisState::DiscreteMotion: return "DiscreteMotion";
        case AxisState::ContinuousMotion: return "ContinuousMotion";
        case AxisState::SynchronizedMotion: return "SynchronizedMotion";
        case AxisState::Stopping: return "Stopping";
        case AxisState::ErrorStop: return "ErrorStop";
    }
    return "?";
}

std::string_view name(Owner owner) noexcept {
    switch (owner) {
        case Owner::none: return "nobody";
        case Owner::program: return "program";
        case Owner::operator_panel: return "operator";
        case Owner::commissioning: return "commissioning";
    }
    return "?";
}

std::string_view name(Presence presence) noexcept {
    switch (presence) {
        case Presence::always: return "always";
        case Presence::absent: return "absent";
        case Presence::joining: return "joining";
        case Presence::present: return "present";
    }
    return "?";
}

}  // namespace taktwerk::axes
