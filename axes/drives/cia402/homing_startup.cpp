#include "axes/drives/cia402/homing_startup.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace taktwerk::axes::cia402 {

std::vector<ecat::StartupSdo> homing_startup(const AxisConfig& axis, const DriveProfile& profile, std::uint8_t drive_axis) {
    if (axis.homing.kind != HomingKind::drive) return {};
    const double scale = std::abs(axis.gearing.counts_per_unit());
    const auto counts = [&](double value) { return std::max<std::int64_t>(1, std::llround(std::abs(value) * scale)); };
    const auto object = [&](std::uint16_t base) { return static_cast<std::uint16_t>(base + drive_axis * profile.object_offset); };
    const auto entry = [&](std::uint16_t index, std::uint8_t sub, ecat::DataType type, std::int64_t value, bool verify = true) {
        ecat::StartupSdo sdo;
        sdo.index = object(index);
        sdo.sub = sub;
        sdo.type = type;
        sdo.value = value;
        sdo.verify = verify;
        sdo.origin = fmt::format("homing of axis {}", axis.name);
        return sdo;
    };
    using ecat::DataType;
    std::vector<ecat::StartupSdo> list{
        // 6098h is write-only on some drives (SE-808X 3.2.7): never read back.
        entry(0x6098, 0, DataType::I8, axis.homing.method, false),
        entry(0x6099, 1, DataType::U32, counts(axis.homing.search_velocity)),
        entry(0x6099, 2, DataType::U32, counts(axis.homing.latch_velocity)),
        entry(0x609A, 0, DataType::U32, counts(axis.homing.acceleration)),
        entry(0x607C, 0, DataType::I32, 0),
    };
    // Left at 1, the reference would keep its old coordinate (SV33-E table 3-75).
    const auto& known = profile.parameters;
    if (std::any_of(known.begin(), known.end(), [](const auto& p) { return p.address.index == 0x60E6; })) {
        list.push_back(entry(0x60E6, 0, DataType::U8, 0));
        list.back().if_changed = true;
    }
    return list;
}

}  // namespace taktwerk::axes::cia402
