#pragma once
// A drive file as it is loaded, for tests that hold it up against literals from the drive's manual.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "config/drive_file/drive_loader.hpp"

namespace taktwerk::config {

inline LoadedDrive drive(const std::string& name) {
    auto loaded = load_drive(std::string(TAKTWERK_SOURCE_DIR) + "/config/drives/" + name + ".yaml");
    if (const auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {std::make_shared<ecat::DeviceDescription>(), std::make_shared<axes::DriveProfile>(), {}, {}, {}};
    }
    return std::get<LoadedDrive>(loaded);
}

inline std::size_t bytes(const std::vector<ecat::PdoDescription>& pdos, std::uint16_t index) {
    std::size_t bits = 0;
    for (const auto& pdo : pdos)
        if (pdo.index == index)
            for (const auto& entry : pdo.entries) bits += entry.bits;
    return bits / 8;
}

inline std::size_t bytes(const ecat::PdoSelection& selection) {
    std::size_t bits = 0;
    for (const auto& pdo : selection.assigned)
        for (const auto& entry : pdo.entries) bits += entry.bits;
    return bits / 8;
}

inline std::set<std::uint16_t> objects(const ecat::PdoSelection& selection) {
    std::set<std::uint16_t> out;
    for (const auto& pdo : selection.assigned)
        for (const auto& entry : pdo.entries) out.insert(entry.index);
    return out;
}

inline std::int64_t default_of(const ecat::DeviceDescription& device, std::uint16_t index, std::uint8_t sub = 0) {
    for (const auto& object : device.objects)
        if (object.index == index && object.sub == sub) return object.value;
    ADD_FAILURE() << std::hex << index << ":" << int{sub} << " is not listed";
    return -1;
}

inline const axes::DriveAlarmText* alarm(const axes::DriveProfile& profile, std::string_view panel) {
    for (const auto& row : profile.alarms)
        if (row.panel == panel) return &row;
    return nullptr;
}

/// The parameter at an address; one that is not listed fails the test.
inline axes::DriveParameter parameter(const axes::DriveProfile& profile, std::uint16_t index, std::uint8_t sub = 0) {
    for (const auto& row : profile.parameters)
        if (row.address.index == index && row.address.sub == sub) return row;
    ADD_FAILURE() << std::hex << index << ":" << int{sub} << " is not listed";
    return {};
}

}  // namespace taktwerk::config
