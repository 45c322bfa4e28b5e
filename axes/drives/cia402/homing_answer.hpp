#pragma once
// What bits 12 and 13 of the status word say of the homing that was started, and not of one before it. Pure logic, real-time safe.

#include <cstdint>
#include <optional>

#include "axes/drives/cia402/words.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::cia402 {

class HomingAnswer {
public:
    /// Attained bits count only after the drive has shown that it took the new start, or after this long: methods such as 35 are over
    /// before a frame has passed.
    static constexpr Duration settle = std::chrono::milliseconds{50};
    struct Bits {
        bool attained = false, error = false;
    };

    /// Bit 4 of the control word in homing mode, each cycle.
    void started(bool runs, Instant now) noexcept {
        if (!runs) {
            since_.reset();
            cleared_ = false;
        } else if (!since_) {
            since_ = now;
        }
    }
    /// The status of a cycle in which the drive is in homing mode.
    [[nodiscard]] Bits read(std::uint16_t status, Instant now) noexcept {
        if (!since_) return {};
        const bool attained = (status & bit_homing_attained) != 0;
        const bool error = (status & bit_homing_error) != 0;
        if (!attained && !error) cleared_ = true;
        if (!cleared_ && now - *since_ < settle) return {};
        return {attained && !error && (status & bit_target_reached) != 0, error};
    }

private:
    std::optional<Instant> since_;  // bit 4 was set; attained bits of an earlier homing are ignored
    bool cleared_ = false;
};

}  // namespace taktwerk::axes::cia402
