#pragma once
// What differs in reading the status word of one drive: the pattern of its Fault, and the bits that stand before it may be enabled. Pure logic,
// real-time safe.

#include <cstdint>

#include "axes/drives/cia402/words.hpp"
#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes::cia402 {

class StatusReading {
public:
    explicit StatusReading(const DriveProfile& profile) noexcept : fault_low_nibble_f_(profile.has(Quirk::fault_low_nibble_f)) {}

    /// Bits of 6041h, all set before Enable Operation.
    void await(std::uint16_t bits) noexcept { awaited_ = bits; }
    [[nodiscard]] PowerState power(std::uint16_t status) const noexcept { return power_state(status, fault_low_nibble_f_); }
    /// They are, but for those that the drive's settings hide.
    [[nodiscard]] bool may_enable(std::uint16_t status, std::uint16_t hidden) const noexcept {
        const unsigned awaited = awaited_ & ~unsigned{hidden};
        return (status & awaited) == awaited;
    }

private:
    bool fault_low_nibble_f_;
    std::uint16_t awaited_ = 0;
};

}  // namespace taktwerk::axes::cia402
