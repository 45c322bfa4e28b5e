#include "axes/drives/cia402/own_modes.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {

namespace {

struct ModeBit {
    DriveMode mode;
    unsigned bit;  ///< of 6502h
    std::string_view name;
};
constexpr std::array mode_bits{ModeBit{DriveMode::cyclic_position, 7, "csp"}, ModeBit{DriveMode::cyclic_velocity, 8, "csv"},
                               ModeBit{DriveMode::cyclic_torque, 9, "cst"},   ModeBit{DriveMode::homing, 5, "hm"},
                               ModeBit{DriveMode::profile_position, 0, "pp"}, ModeBit{DriveMode::profile_velocity, 2, "pv"},
                               ModeBit{DriveMode::profile_torque, 3, "pt"}};

constexpr std::uint16_t bit_of(DriveMode mode) noexcept { return static_cast<std::uint16_t>(1u << static_cast<unsigned>(mode)); }

/// A number of at most 255 and a power of ten, in seconds: as 60C2h wants it.
std::pair<std::int64_t, std::int64_t> period_and_index(Duration cycle) noexcept {
    constexpr std::int64_t most = 255, nanoseconds = -9;
    std::int64_t period = cycle.count(), index = nanoseconds;
    while (period > most || (period % 10 == 0 && index < -3)) period /= 10, ++index;
    return {period, index};
}

/// One with modules says elsewhere (F010h) what they are: ETG.5001.
constexpr std::uint32_t profile_of_type = 0xFFFF, cia402_profile = 402, modular_profile = 5001;

}  // namespace

DriveMode own_mode(const AxisConfig& axis) noexcept {
    if (axis.encoder) return DriveMode::none;
    return axis.control.mode == ControlMode::position ? DriveMode::cyclic_position : DriveMode::cyclic_velocity;
}

std::uint16_t modes_of_6502h(std::uint32_t supported) noexcept {
    unsigned modes = 0;
    for (const auto& row : mode_bits)
        if ((supported >> row.bit & 1u) != 0) modes |= bit_of(row.mode);
    return static_cast<std::uint16_t>(modes);
}

std::string mode_list(std::uint16_t modes) {
    std::string out;
    for (const auto& row : mode_bits)
        if ((modes & bit_of(row.mode)) != 0) out += fmt::format("{}{}", out.empty() ? "" : ", ", row.name);
    return out.empty() ? "none" : out;
}

std::vector<ecat::AskedObject> asked_of(const DriveProfile& profile) {
    if (!profile.assumes(AssumedPart::process_data) && !profile.assumes(AssumedPart::modes)) return {};
    return {{0x1000, 0}, {0x6502, 0}, {0x6060, 0}};
}

std::vector<ecat::StartupSdo> given_to(const AxisConfig& axis, const DriveProfile& profile, Duration cycle) {
    if (!profile.assumes(AssumedPart::process_data) && !profile.assumes(AssumedPart::modes)) return {};
    using ecat::DataType;
    std::vector<ecat::StartupSdo> list;
    const auto add = [&](std::uint16_t index, std::uint8_t sub, DataType type, std::int64_t value, const char* what) {
        ecat::StartupSdo sdo;
        sdo.index = index;
        sdo.sub = sub;
        sdo.type = type;
        sdo.value = value;
        sdo.verify = false;
        sdo.if_there = true;
        sdo.origin = fmt::format("{} of axis {}", what, axis.name);
        list.push_back(std::move(sdo));
    };
    if (const auto mode = own_mode(axis); mode != DriveMode::none) add(0x6060, 0, DataType::I8, mode_code(mode), "mode");
    const auto [period, index] = period_and_index(cycle);
    add(0x60C2, 1, DataType::U8, period, "interpolation time");
    add(0x60C2, 2, DataType::I8, index, "interpolation time");
    return list;
}

std::optional<std::string> other_device_type(std::uint32_t device_type) {
    const auto profile = device_type & profile_of_type;
    if (profile == cia402_profile || profile == modular_profile) return std::nullopt;
    return profile == 0 ? std::string("no device profile") : fmt::format("device profile {}", profile);
}

}  // namespace taktwerk::axes::cia402
