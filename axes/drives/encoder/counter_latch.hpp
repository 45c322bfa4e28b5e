#pragma once
// The latch of a counter terminal as a touch probe: which way to arm it, and which latch is a new one. Pure logic; real-time safe.
//
// Such a terminal latches once: its bit stands until the arming is taken back (EL5101: "in order to activate the latch again, the bit must first
// be cancelled"). So a new arming waits until the terminal has shown that the old one is gone, else its latch would pass for a new one.

#include <cstdint>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::encoder {

enum class LatchWay : std::uint8_t { none, index, rising, falling };

class CounterLatch {
public:
    /// What is armed in this cycle. `gone`: the terminal shows no latch, and knows that none is armed.
    [[nodiscard]] LatchWay arm(const ProbeCommand& wanted, bool gone) noexcept {
        const auto way = !wanted.armed                      ? LatchWay::none
                         : wanted.index_pulse               ? LatchWay::index
                         : wanted.edge == ProbeEdge::rising ? LatchWay::rising
                                                            : LatchWay::falling;
        if (way != way_) {
            phase_ = way == LatchWay::none ? Phase::off : Phase::clearing;
            begins_ = true;
        }
        way_ = way;
        again_ = wanted.continuous;
        if (phase_ == Phase::clearing && gone) phase_ = Phase::armed;
        return phase_ == Phase::armed || phase_ == Phase::latched ? way_ : LatchWay::none;
    }

    /// `latched`: the bit of that way; `known`: the terminal knows of the arming. True for a latch that was not there before.
    bool take(bool latched, bool known, ProbeFeedback& out) noexcept {
        if (begins_) out.count = 0;
        begins_ = false;
        out.armed = (phase_ == Phase::armed || phase_ == Phase::latched) && known;
        if (!out.armed) out.latched = false;
        if (!out.armed || !latched || phase_ == Phase::latched) return false;
        phase_ = again_ ? Phase::clearing : Phase::latched;
        out.latched = true;
        ++out.count;
        return true;
    }

    /// The terminal was away: whatever it was told is gone.
    void forget() noexcept {
        if (phase_ != Phase::off) phase_ = Phase::clearing;
    }

private:
    enum class Phase : std::uint8_t { off, clearing, armed, latched };
    Phase phase_ = Phase::off;
    LatchWay way_ = LatchWay::none;
    bool again_ = false, begins_ = false;
};

}  // namespace taktwerk::axes::encoder
