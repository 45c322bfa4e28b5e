#include "runtime/check/drive_hazards.hpp"

#include <algorithm>
#include <cmath>

#include "axes/drives/cia402/homing_startup.hpp"

namespace taktwerk::runtime {

namespace {

/// Objects of further axes of a drive stand `object_offset` apart; hazards name those of the first.
axes::ParameterAddress of_first_axis(const AxisBinding& axis, std::uint16_t index, std::uint8_t sub) {
    return {static_cast<std::uint16_t>(index - axis.drive_axis * axis.profile->object_offset), sub};
}

void add_mapped(std::vector<axes::ParameterAddress>& into, const AxisBinding& axis, const ecat::PdoSelection& selection,
                const std::vector<ecat::PdoDescription>& available, const std::vector<std::uint16_t>& assigned) {
    const auto add = [&](const ecat::PdoDescription& pdo) {
        for (const auto& entry : pdo.entries)
            if (entry.index != 0) into.push_back(of_first_axis(axis, entry.index, entry.sub));
    };
    for (const auto& pdo : selection.assigned) add(pdo);
    if (!selection.assigned.empty()) return;
    for (const auto& pdo : available)
        if (std::find(assigned.begin(), assigned.end(), pdo.index) != assigned.end()) add(pdo);
}

}  // namespace

axes::DriveUse use_of_drive(const MachineConfig& config, const AxisBinding& axis) {
    axes::DriveUse use;
    const auto& homing = axis.axis.homing;
    use.homed_by_drive = homing.kind == axes::HomingKind::drive;
    use.absolute_homing = homing.kind == axes::HomingKind::absolute;
    use.software_limits = std::isfinite(axis.axis.limits.position_min) && std::isfinite(axis.axis.limits.position_max);
    for (const auto& line : config.serial)
        for (const auto& entry : line.drives) {
            if (axis.drive.empty() || entry.drive.name != axis.drive) continue;
            for (const auto& parameter : entry.drive.parameters) use.written.push_back({{parameter.number, 0}, parameter.value});
        }
    const auto slave =
        std::find_if(config.bus.slaves.begin(), config.bus.slaves.end(), [&](const auto& s) { return s.name == axis.slave; });
    if (slave == config.bus.slaves.end() || !slave->device) return use;
    for (const auto& stored : axis.stored) use.written.push_back({stored.object, stored.value});
    const auto write = [&](const ecat::StartupSdo& sdo) { use.written.push_back({of_first_axis(axis, sdo.index, sdo.sub), sdo.value}); };
    for (const auto& sdo : slave->startup) write(sdo);
    for (const auto& sdo : axes::cia402::homing_startup(axis.axis, *axis.profile, axis.drive_axis)) write(sdo);
    const auto& device = *slave->device;
    add_mapped(use.sent, axis, slave->rx, device.rx_pdos, device.rx_assigned);
    add_mapped(use.received, axis, slave->tx, device.tx_pdos, device.tx_assigned);
    return use;
}

std::vector<AxisHazard> drive_hazards(const MachineConfig& config) {
    std::vector<AxisHazard> out;
    for (const auto& axis : config.axes) {
        if (!axis.profile || axis.axis.disabled) continue;
        for (const auto* hazard : axes::hazards_of(*axis.profile, use_of_drive(config, axis))) out.push_back({axis.axis.name, hazard});
    }
    return out;
}

}  // namespace taktwerk::runtime
