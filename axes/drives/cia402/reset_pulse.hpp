#pragma once
// The edge that resets a fault: bit 7 of the control word is held a while, then taken back as long, then tried again while it is still asked
// for. TSVM and SV33-E ignore every other command while bit 7 stands. Pure logic, real-time safe.

#include <cstdint>

#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {

class ResetPulse {
public:
    /// `due`: the drive's data are exchanged in this cycle. A slower sync unit carries each level as often.
    [[nodiscard]] std::uint16_t word(bool due) noexcept {
        const auto phase = exchange_ % (reset_low_cycles + reset_high_cycles + reset_wait_cycles);
        if (due) ++exchange_;
        return phase >= reset_low_cycles && phase < reset_low_cycles + reset_high_cycles ? fault_reset : disable_voltage;
    }
    void end() noexcept { exchange_ = 0; }

private:
    static constexpr std::uint32_t reset_low_cycles = 4, reset_high_cycles = 4, reset_wait_cycles = 100;
    std::uint32_t exchange_ = 0;
};

}  // namespace taktwerk::axes::cia402
