#include "axes/port/drive_hazard.hpp"

#include <algorithm>
#include <optional>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes {

namespace {

bool contains(const std::vector<ParameterAddress>& list, const ParameterAddress& address) {
    return std::find(list.begin(), list.end(), address) != list.end();
}

/// The last entry counts, else the factory's value. Nothing: sent cyclically, or nobody knows.
std::optional<std::int64_t> effective(const DriveProfile& profile, const DriveUse& use, const ParameterAddress& address) {
    if (contains(use.sent, address)) return std::nullopt;
    for (auto entry = use.written.rbegin(); entry != use.written.rend(); ++entry)
        if (entry->address == address) return entry->value;
    for (const auto& parameter : profile.parameters)
        if (parameter.address == address && parameter.factory != FactoryValue::unknown) return parameter.value;
    return std::nullopt;
}

/// Where the target of a mode stands.
ParameterAddress target_of(DriveMode mode) {
    switch (mode) {
        case DriveMode::profile_position:
        case DriveMode::cyclic_position: return {0x607A, 0};
        case DriveMode::profile_velocity:
        case DriveMode::cyclic_velocity: return {0x60FF, 0};
        case DriveMode::profile_torque:
        case DriveMode::cyclic_torque: return {0x6071, 0};
        case DriveMode::homing:
        case DriveMode::none: break;
    }
    return {};
}

bool applies(const DriveProfile& profile, const DriveUse& use, const DriveHazard& hazard) {
    const auto any = [&](auto&& says) { return std::any_of(hazard.objects.begin(), hazard.objects.end(), says); };
    const auto written = [&](const ParameterAddress& address) {
        return std::any_of(use.written.begin(), use.written.end(), [&](const auto& entry) { return entry.address == address; });
    };
    const auto is_one_of = [&](std::int64_t value) {
        return std::find(hazard.values.begin(), hazard.values.end(), value) != hazard.values.end();
    };
    switch (hazard.when) {
        case HazardCondition::always: return true;
        case HazardCondition::not_written: return any([&](const auto& object) { return !written(object) && !contains(use.sent, object); });
        case HazardCondition::not_set_to:
            return any([&](const auto& object) {
                const auto value = effective(profile, use, object);
                return value ? !is_one_of(*value) : !contains(use.sent, object);  // what nobody knows may be the wrong one
            });
        case HazardCondition::set_to:
            return any([&](const auto& object) {
                const auto value = effective(profile, use, object);
                return value && is_one_of(*value);
            });
        case HazardCondition::mapped:
            return any([&](const auto& object) { return contains(use.sent, object) || contains(use.received, object); });
        case HazardCondition::not_mapped:
            return any([&](const auto& object) { return !contains(use.sent, object) && !contains(use.received, object); });
        case HazardCondition::mode_mapped: return contains(use.sent, target_of(hazard.mode));
        case HazardCondition::homed_by_drive: return use.homed_by_drive;
        case HazardCondition::no_software_limits: return !use.software_limits;
        case HazardCondition::absolute_homing: return use.absolute_homing;
    }
    return false;
}

}  // namespace

std::vector<const DriveHazard*> hazards_of(const DriveProfile& profile, const DriveUse& use) {
    std::vector<const DriveHazard*> out;
    for (const auto& hazard : profile.hazards)
        if (applies(profile, use, hazard)) out.push_back(&hazard);
    return out;
}

}  // namespace taktwerk::axes
