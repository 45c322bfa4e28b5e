#pragma once
// From when on a simulated drive listens: it starts, and after enabling it takes no set-point until its brake is open (SV33-E P05.13, TSVM
// 5.3.1). Set-points and homing starts that come before are lost.

#include <cstdint>
#include <optional>

#include "core/time.hpp"

namespace taktwerk::axes::sim {

class CommandGate {
public:
    /// The drive tests itself until then; power_off(): it has no power.
    void power_on(Instant tested) noexcept { self_test_ends_ = tested; }
    void power_off() noexcept { self_test_ends_.reset(); }
    /// The self-test is over: true once.
    bool starts(Instant now) noexcept {
        if (!self_test_ends_ || now < *self_test_ends_) return false;
        self_test_ends_.reset();
        return true;
    }

    void open_at(Instant from) noexcept { open_from_ = from; }
    /// The drive does not listen yet. What it was told is lost, if it was told `anything`.
    bool loses(bool anything, Instant now) noexcept {
        if (now >= open_from_) return false;
        if (anything) ++lost_;
        return true;
    }
    [[nodiscard]] std::uint32_t lost() const noexcept { return lost_; }

private:
    std::optional<Instant> self_test_ends_;
    Instant open_from_{};
    std::uint32_t lost_ = 0;
};

}  // namespace taktwerk::axes::sim
