#pragma once
// The holding brake of an axis, where the controller works it: open while the axis has power, closed otherwise, and what MC_SetBrake makes of it in
// between. A drive that works its own brake needs none of this. Real-time safe.
//
//   power comes    opens as the drive is enabled; motion waits until it has had its time (release)
//   power goes     closes as the axis stands; power stays until it has had its time (engage). Where power goes at once, it closes at once
//   by hand        closed under power at standstill: nothing moves until it is open again. Opened without power, where that is permitted, until
//                  power comes, somebody else takes the axis, an emergency stop, or its drive is not there any more

#include <chrono>

#include "axes/axis/axis_config.hpp"
#include "axes/port/drive_port.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

class HoldingBrake {
public:
    explicit HoldingBrake(const BrakeConfig& config) noexcept
        : controlled_(config.by != BrakeBy::drive), release_(config.release), engage_(config.engage) {}

    [[nodiscard]] bool controlled() const noexcept { return controlled_; }

    /// Once a cycle, where it is controlled. `powered`: the drive holds or brakes the motor. `secure`: nothing forbids that it is open without.
    void step(bool powered, bool secure, Instant now) noexcept {
        now_ = now;
        if (powered != powered_ || (hand_ == Hand::open && !secure)) hand_ = Hand::none;
        powered_ = powered;
        const bool open = powered ? hand_ != Hand::closed : hand_ == Hand::open;
        if (open == open_) return;
        open_ = open;
        since_ = now;
    }
    /// MC_SetBrake, once it was found permitted.
    void by_hand(bool open) noexcept { hand_ = open == powered_ ? Hand::none : open ? Hand::open : Hand::closed; }
    /// Whoever opened it has the axis no more.
    void let_go() noexcept {
        if (hand_ == Hand::open) hand_ = Hand::none;
    }

    /// Closed under power, or on its way to open: nothing may move.
    [[nodiscard]] bool holds() const noexcept { return powered_ && (!open_ || now_ - since_ < release_); }
    /// Of all that was asked for, this was the last; the word has gone, or goes in this cycle.
    [[nodiscard]] BrakeRequest request() const noexcept {
        if (!controlled_) return BrakeRequest::none;
        return open_ ? BrakeRequest::open : BrakeRequest::close;
    }
    /// By the time that it needs: nobody reports it.
    [[nodiscard]] BrakeState state() const noexcept {
        if (!controlled_) return BrakeState::not_controlled;
        if (open_) return now_ - since_ < release_ ? BrakeState::opening : BrakeState::open;
        return now_ - since_ < engage_ ? BrakeState::closing : BrakeState::closed;
    }

private:
    enum class Hand : std::uint8_t { none, closed, open };  // against what power alone would make of it

    bool controlled_;
    Duration release_, engage_;
    Hand hand_ = Hand::none;
    bool powered_ = false, open_ = false;
    Instant since_ = Instant{} - std::chrono::seconds{10}, now_{};  // closed for long
};

}  // namespace taktwerk::axes
