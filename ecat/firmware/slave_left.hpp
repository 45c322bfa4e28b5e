#pragma once
// What state a slave is left in when an update is over or broke off, and the way back, in words.

#include <cstdint>
#include <string>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

struct SlaveLeft {
    bool silent = true;  ///< it does not answer: nobody knows
    AlState state = AlState::unknown;
    bool error = false;
    std::uint16_t code = 0;  ///< AL status code
    friend bool operator==(const SlaveLeft&, const SlaveLeft&) = default;
};

/// Asks it.
[[nodiscard]] Script<Result<SlaveLeft>> look_at_left(Bus& bus, BusSlave& slave);

/// What firmware it can have: by how far the update came.
enum class FirmwareLeft : std::uint8_t {
    untouched,  ///< the file was never taken
    broken,     ///< part of a file was taken, or all of it and no answer came
    complete,   ///< the slave said that it has all of it
};

/// "it is in BOOT and waits for the file".
[[nodiscard]] std::string left_text(const SlaveLeft& left, FirmwareLeft firmware);
/// What to do then.
[[nodiscard]] std::string way_back(const SlaveLeft& left, FirmwareLeft firmware);

}  // namespace taktwerk::ecat
