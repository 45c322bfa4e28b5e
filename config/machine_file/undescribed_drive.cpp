#include "config/machine_file/undescribed_drive.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::config {

namespace {

using axes::AssumedPart;

constexpr std::uint16_t target_position = 0x607A, target_velocity = 0x60FF;

}  // namespace

StatedDrive with_statements(const LoadedDrive& drive, Reader& reader, const std::string& here,
                            const std::optional<ecat::Identity>& identity, const std::vector<axes::DriveMode>& modes) {
    const auto& known = *drive.profile;
    const auto stated_already = [&](const char* key, const char* what) {
        reader.problem(reader.find(here + "." + key), "config.drive_stated", fmt::format("the drive file of {} says {}", known.name, what),
                       fmt::format("remove `{}`, or correct the drive file", key));
    };
    if (identity && !known.assumes(AssumedPart::identity)) stated_already("identity", "who it is");
    if (!modes.empty() && !known.assumes(AssumedPart::modes)) stated_already("modes", "which modes it has");
    if (known.assumptions.empty()) return {drive.device, drive.profile};

    auto device = std::make_shared<ecat::DeviceDescription>(*drive.device);
    auto profile = std::make_shared<axes::DriveProfile>(known);
    if (identity && known.assumes(AssumedPart::identity)) device->identity = *identity;
    if (!modes.empty() && known.assumes(AssumedPart::modes)) profile->modes = modes;
    std::erase_if(profile->assumptions, [&](const axes::DriveAssumption& assumption) {
        return std::ranges::any_of(assumption.unless, [&](const auto& key) { return reader.has(here + "." + key); });
    });
    device->stated.identity = !profile->assumes(AssumedPart::identity);
    return {std::move(device), std::move(profile)};
}

void suit_to_axes(ecat::SlaveConfig& slave, const std::vector<runtime::AxisBinding>& axes) {
    if (slave.rx.required.empty() || slave.rx.assigned.empty()) return;
    for (const auto& binding : axes) {
        if (binding.slave != slave.name && binding.follower.slave != slave.name) continue;
        if (binding.encoder) continue;  // it reads an object, and is no axis of the drive
        const bool measures = binding.axis.encoder;
        if (!measures && binding.axis.control.mode == axes::ControlMode::position) continue;
        auto& wished = slave.rx.assigned.front().entries;
        const auto is = [](std::uint16_t index) { return [index](const ecat::PdoEntry& entry) { return entry.index == index; }; };
        std::erase_if(slave.rx.required, is(target_position));
        const auto velocity = std::ranges::find_if(wished, is(target_velocity));
        if (measures || velocity == wished.end()) continue;
        slave.rx.required.push_back(*velocity);
        if (const auto position = std::ranges::find_if(wished, is(target_position)); position < velocity)
            std::iter_swap(position, velocity);
    }
}

}  // namespace taktwerk::config
