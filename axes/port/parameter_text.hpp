#pragma once
// Parameters of a drive as its manual and people write them: names (P05.10, 2005h:0B, Pr098), values with units, bytes on the wire.
// Not real-time.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "core/result.hpp"

namespace taktwerk::axes {

/// "P05.10"; an object of the standard "6084h" or "6099h:02".
[[nodiscard]] std::string name_of(const DriveParameter& parameter);

/// "6084h", "6099h:02".
[[nodiscard]] std::string object_text(const ParameterAddress& address);
/// By the manual's name or by its object, upper or lower case. Error drive.no_parameter, with the nearest names.
[[nodiscard]] Result<const DriveParameter*> find_parameter(const DriveProfile& profile, std::string_view word);

/// "250 ms", "-2", "10.0 %": raw times scale, with as many digits as the scale has.
[[nodiscard]] std::string value_text(const DriveParameter& parameter, std::int64_t raw);
/// "250 ms", "10 (assumed)", "not stated": what is known of the value that the drive leaves the factory with.
[[nodiscard]] std::string factory_text(const DriveParameter& parameter);
/// "stated", "assumed", "unknown".
[[nodiscard]] std::string_view name(FactoryValue factory) noexcept;
/// "0 .. 500 ms"; empty where the manual gives none.
[[nodiscard]] std::string range_text(const DriveParameter& parameter);

/// A number in the parameter's unit, which may stand behind it, as may another unit of the same thing (0.3 s for 300 ms), or a raw
/// one in hexadecimal (0x.. or ..h).
/// Errors: drive.value (no number, another unit, between two steps), drive.out_of_range, drive.read_only, drive.no_address.
[[nodiscard]] Result<std::int64_t> parse_value(const DriveParameter& parameter, std::string_view text);
/// The same for a parameter of this drive, which may document less than the range of its object: homing methods (6098h). 0 is none of them.
[[nodiscard]] Result<std::int64_t> parse_value(const DriveProfile& profile, const DriveParameter& parameter, std::string_view text);
/// 6098h with a method that the drive's manual says does not exist: drive.out_of_range, with those that do.
[[nodiscard]] Result<void> check_homing_method(const DriveProfile& profile, const ParameterAddress& object, std::int64_t raw);

/// As SDOs and registers carry it: little-endian, `bits` wide. Errors of from_bytes: drive.size.
[[nodiscard]] std::vector<std::byte> to_bytes(const DriveParameter& parameter, std::int64_t raw);
[[nodiscard]] Result<std::int64_t> from_bytes(const DriveParameter& parameter, std::span<const std::byte> bytes);

/// Something that a machine sets once and a saved set holds: written and read, no action, no command of the cycle (targets, control
/// word, mode, outputs).
[[nodiscard]] bool is_setting(const DriveParameter& parameter) noexcept;

/// How a value gets into the EEPROM of a drive and counts: the command, or why there is none. `drive` as its user names it, `axis` from 0.
[[nodiscard]] std::string way_to_store(const DriveProfile& profile, std::string_view drive, std::size_t axis,
                                       const DriveParameter& parameter, std::int64_t raw);

}  // namespace taktwerk::axes
