// What a drive that nobody described said of itself while it came up, held against what the axis needs.

#include <utility>

#include <fmt/format.h>

#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/drives/cia402/own_modes.hpp"
#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {

namespace {

constexpr std::uint16_t device_type = 0x1000, mode_of_operation = 0x6060, supported_modes = 0x6502;

}  // namespace

/// 6502h says which of the profile's modes it has. Where 6060h or 6061h cannot be exchanged it stays in the one that it was given by SDO.
Result<void> Cia402Drive::take_own_modes(bool sends, bool shows) {
    if (const auto type = place_.bus().told(place_.number(), device_type, 0))
        if (const auto other = other_device_type(*type))
            return Error{"drive.no_cia402", place_.subject(), fmt::format("its 1000h is {:08X}h, {}: no drive of CiA 402", *type, *other),
                         "check the order of the slaves on the cable; a drive over SoE is not supported"};
    const auto supported = place_.bus().told(place_.number(), supported_modes, 0);
    if (profile_->assumes(AssumedPart::modes) && supported)
        capabilities_.modes = static_cast<std::uint16_t>(capabilities_.modes & modes_of_6502h(*supported));
    capabilities_.drive_homing = capabilities_.drive_homing && capabilities_.has(DriveMode::homing);
    if (sends && shows) return {};

    const auto held = place_.bus().told(place_.number(), mode_of_operation, 0);
    if (!sends && own_.wanted != DriveMode::none && held != static_cast<std::uint8_t>(mode_code(own_.wanted)))
        return Error{"drive.mode_not_taken", place_.subject(),
                     fmt::format("6060h is not in its process data, and written by SDO it {}",
                                 held ? fmt::format("stays at {}", static_cast<std::int8_t>(*held)) : std::string("does not exist")),
                     fmt::format("set the mode {} ({}) at the drive itself, with its maker's tool",
                                 mode_list(static_cast<std::uint16_t>(1u << static_cast<unsigned>(own_.wanted))), mode_code(own_.wanted))};
    own_.fixed = own_.wanted;
    capabilities_.modes = static_cast<std::uint16_t>(capabilities_.modes & 1u << static_cast<unsigned>(own_.wanted));
    capabilities_.drive_homing = false;
    return {};
}

Result<void> Cia402Drive::check_own_mode() const {
    if (own_.wanted == DriveMode::none || capabilities_.has(own_.wanted)) return {};
    if (!profile_->assumes(AssumedPart::modes) && !profile_->assumes(AssumedPart::process_data)) return {};
    const bool asked = profile_->assumes(AssumedPart::modes);
    const auto supported = asked ? place_.bus().told(place_.number(), supported_modes, 0) : std::nullopt;
    const bool loop_here = own_.wanted == DriveMode::cyclic_position && capabilities_.has(DriveMode::cyclic_velocity);
    const auto wanted = mode_list(static_cast<std::uint16_t>(1u << static_cast<unsigned>(own_.wanted)));
    const auto missing = fmt::format("it has no {}, in which its axis is moved; it has {}{}", wanted, mode_list(capabilities_.modes),
                                     supported ? fmt::format(" (6502h = {:04X}h)", *supported) : std::string{});
    std::string remedy = "close the position loop here: `control: {mode: velocity, kv: ...}` of the axis";
    if (!loop_here) {
        remedy =
            "a set-point each cycle needs csp or csv: profile modes alone move no axis over EtherCAT. If the drive's manual says that it "
            "has ";
        remedy += asked ? fmt::format("{0}, and 6502h is wrong, state `modes: [{0}]` at the slave", wanted)
                        : fmt::format("{0}, add {0} to its `modes`", wanted);
    }
    return Error{"drive.no_mode", place_.subject(), missing, std::move(remedy)};
}

}  // namespace taktwerk::axes::cia402
