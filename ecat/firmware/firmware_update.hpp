#pragma once
// New firmware into a slave, from the first look to the last: who it is, BOOT, the file, INIT, its restart, who it is then. Service side.
//
// Where it breaks off nothing is guessed: the slave is asked what state it is in (slave_left.hpp). Before it took the request for the
// file its old firmware is as it was, and it is taken back to INIT. From then on it stays in BOOT, where it takes the file again:
// leaving BOOT lets its boot loader start half an image.
//
// Errors: those of enter_boot(), write_file(), leave_boot().

#include <cstddef>
#include <functional>
#include <optional>

#include "ecat/firmware/device_version.hpp"
#include "ecat/firmware/slave_left.hpp"
#include "ecat/foe/file_transfer.hpp"

namespace taktwerk::ecat {

enum class FirmwareStage : std::uint8_t { looking, entering_boot, writing, leaving_boot, comparing, done };

struct FirmwareSettings {
    FoeSettings foe{};
    Duration restart_patience = std::chrono::seconds{60};  ///< until it answers again
    std::function<void(FirmwareStage)> stage{};            ///< told as each begins; may be empty
};

struct FirmwareOutcome {
    FirmwareStage reached = FirmwareStage::looking;
    bool begun = false;            ///< it took the request for the file, or may have: what it held may be gone
    std::size_t acknowledged = 0;  ///< bytes
    std::optional<DeviceVersion> before, after;
    std::optional<Error> failure;  ///< none: all of it is in the slave, and it is back
    SlaveLeft left;                ///< what it is left in

    [[nodiscard]] FirmwareLeft firmware() const noexcept {
        if (reached > FirmwareStage::writing) return FirmwareLeft::complete;
        return begun ? FirmwareLeft::broken : FirmwareLeft::untouched;
    }
};

/// Never throws anything away silently: what went wrong is in the outcome.
[[nodiscard]] Script<Result<FirmwareOutcome>> update_firmware(Bus& bus, BusSlave& slave, FoeFile file, std::vector<std::byte> content,
                                                              FirmwareSettings settings);

}  // namespace taktwerk::ecat
