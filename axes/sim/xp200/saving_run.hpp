#pragma once
// Writing all parameters to the EEPROM takes a while; mains that go meanwhile tear it (manual 6.1, alarm 20; 9.6.6).

#include "core/time.hpp"

namespace taktwerk::axes::sim::xp200 {

class SavingRun {
public:
    void begin(Instant until) noexcept {
        pending_ = true;
        until_ = until;
    }
    [[nodiscard]] bool busy(Instant now) const noexcept { return now < until_; }
    /// True once: the time is over, what was to be saved is saved.
    bool ends(Instant now) noexcept {
        if (!pending_ || now < until_) return false;
        pending_ = false;
        return true;
    }
    void power_off() noexcept {
        torn_ = pending_;
        pending_ = false;
        until_ = {};
    }
    /// The last one was torn; asked at power-on, once.
    bool was_torn() noexcept {
        const bool torn = torn_;
        torn_ = false;
        return torn;
    }

private:
    bool pending_ = false, torn_ = false;
    Instant until_{};
};

}  // namespace taktwerk::axes::sim::xp200
