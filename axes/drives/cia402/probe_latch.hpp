#pragma once
// One touch probe: the bits of 60B8h that arm it and those of 60B9h that answer. Pure logic over 8 bits (probe 2 has the upper
// byte of both objects). Sources: CiA 402-2; SV33-E 3.4.4(1), SV-DA200 3.8. Real-time safe.
//
// Re-arming waits until the drive has shown that the old arming is gone: within the dead time of the bus its latch would else
// pass for a new one. Mode, source and edge are written a cycle before the enable bit (SV33-E 3.4.4(1)).

#include <cstdint>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::cia402 {

class ProbeLatch {
public:
    /// Bits 6 and 7 of the status change with each latch of the continuous mode (SV-DA200 3.8.3).
    void use_toggle_bits() noexcept { toggles_ = true; }

    /// Bits 0..7 of 60B8h for this cycle.
    [[nodiscard]] std::uint8_t function(const ProbeCommand& wanted) noexcept {
        const auto setting = setting_of(wanted);
        if (!wanted.armed) phase_ = Phase::off;
        else if (phase_ == Phase::off || setting != setting_) phase_ = Phase::clearing;
        setting_ = setting;
        rising_ = (setting & rising_edge) != 0;
        switch (phase_) {
            case Phase::off: return 0;
            case Phase::clearing:
                if (drive_enabled_) return 0;
                phase_ = Phase::set;
                return setting;
            case Phase::set: phase_ = Phase::armed; return setting | enable;
            case Phase::armed: return setting | enable;
        }
        return 0;
    }

    /// Which of the two latched positions counts now.
    [[nodiscard]] bool rising() const noexcept { return rising_; }

    /// `status`: bits 0..7 of 60B9h. `raw`: the latched position of the edge that counts. True for a latch that was not there before.
    bool take(std::uint8_t status, std::int64_t raw, ProbeFeedback& out) noexcept {
        drive_enabled_ = (status & enable) != 0;
        out.armed = phase_ == Phase::armed && drive_enabled_;
        if (!out.armed) {
            out.latched = false;
            out.count = 0;
            return false;
        }
        const bool latched = (status & (rising_ ? 2u : 4u)) != 0;
        // In continuous mode the bit stays: the next latch shows by its toggle bit where the drive has one, else by its position alone.
        const bool toggle = toggles_ && (status & (rising_ ? 64u : 128u)) != 0;
        const bool another = latched && (!out.latched || raw != raw_ || toggle != toggle_);
        toggle_ = toggle;
        out.latched = latched;
        raw_ = raw;
        if (another) ++out.count;
        return another;
    }

private:
    static constexpr std::uint8_t enable = 1, continuous = 2, index_pulse = 4, rising_edge = 16, falling_edge = 32;
    enum class Phase : std::uint8_t { off, clearing, set, armed };

    static std::uint8_t setting_of(const ProbeCommand& wanted) noexcept {
        std::uint8_t bits = 0;
        if (wanted.continuous) bits |= continuous;
        // The index has no falling edge to wait for (SV-DA200 3.8: rising only, and bit 4 is needed for it).
        if (wanted.index_pulse) bits |= index_pulse | rising_edge;
        else bits |= wanted.edge == ProbeEdge::rising ? rising_edge : falling_edge;
        return bits;
    }

    Phase phase_ = Phase::off;
    std::uint8_t setting_ = 0;
    bool rising_ = true, drive_enabled_ = false, toggles_ = false, toggle_ = false;
    std::int64_t raw_ = 0;
};

}  // namespace taktwerk::axes::cia402
