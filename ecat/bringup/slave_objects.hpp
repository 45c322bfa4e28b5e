#pragma once
// Numbers in a slave's dictionary, as the steps of the bring-up read and write them: the abort of the last one that was
// refused stays in slave.last_abort, for "why not OP". Service side only.

#include <cstdint>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// An unsigned value of `bytes` bytes (1, 2 or 4). Errors of sdo_download().
[[nodiscard]] Script<Result<void>> write_number(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub, std::uint32_t value,
                                                std::size_t bytes);
/// At most the first four bytes. Errors of sdo_upload().
[[nodiscard]] Script<Result<std::uint32_t>> read_number(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub);

void remember_abort(BusSlave& slave, const Error& error);

/// The slave does not have the object at all (06020000h, or sub-index 06090011h).
[[nodiscard]] bool is_absent(const Error& error) noexcept;
/// It has it and lets nobody write it (06010000h, 06010002h).
[[nodiscard]] bool is_read_only(const Error& error) noexcept;

}  // namespace taktwerk::ecat
