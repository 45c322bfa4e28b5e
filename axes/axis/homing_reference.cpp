#include "axes/axis/homing_reference.hpp"

#include "axes/axis/axis_probes.hpp"

namespace taktwerk::axes {

namespace {

/// A latch may serve the index pulse alone (XP200).
bool has_edge(const DriveCapabilities& drive, unsigned probe, bool falling) noexcept {
    return ((drive.probe_edges >> (2 * probe + (falling ? 1 : 0))) & 1u) != 0;
}

}  // namespace

ErrorId HomingReference::refuse(const TriggerRef& reference) const noexcept {
    const auto& drive = body_.port.capabilities();
    switch (reference.source) {
        case TriggerSource::home_switch: return drive.digital_inputs ? ErrorId::none : ErrorId::not_supported;
        case TriggerSource::input:
            return reference.point < body_.scene.inputs.size() && reference.bit < 64 ? ErrorId::none : ErrorId::invalid_parameter;
        case TriggerSource::index_pulse:
            if (drive.probes < 1) return ErrorId::no_such_probe;
            break;
        case TriggerSource::probe1:
            if (drive.probes < 1 || !has_edge(drive, 0, reference.falling)) return ErrorId::no_such_probe;
            break;
        case TriggerSource::probe2:
            if (drive.probes < 2 || !has_edge(drive, 1, reference.falling)) return ErrorId::no_such_probe;
            break;
    }
    return probes_.any() ? ErrorId::probe_busy : ErrorId::none;
}

bool HomingReference::level(const TriggerRef& reference) const noexcept {
    bool level = false;
    if (reference.source == TriggerSource::home_switch) level = measured_.feedback.home_switch;
    else if (reference.source == TriggerSource::input && reference.point < body_.scene.inputs.size())
        level = ((body_.scene.inputs[reference.point] >> reference.bit) & 1) != 0;
    else return false;
    return level != reference.falling;
}

void HomingReference::arm(const TriggerRef& reference, bool continuous) noexcept {
    if (!latched_by_drive(reference)) return;
    runs_.latch.arm(reference.source == TriggerSource::probe2 ? 1 : 0,
                    {.continuous = continuous,
                     .index_pulse = reference.source == TriggerSource::index_pulse,
                     .edge = reference.falling ? ProbeEdge::falling : ProbeEdge::rising});
}

void HomingReference::set_coordinate(std::int64_t at, double coordinate) noexcept {
    body_.units.set_program(at, coordinate + measured_.compensation.offset());
}

}  // namespace taktwerk::axes
