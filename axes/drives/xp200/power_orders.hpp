#pragma once
// Orders to enable and to disable one drive by its port (9.6.7), and what RUN means among them. RUN alone does not say whose power it shows: after
// a disabling order the current stays for the brake (Pr166) and for the ramp (Pr063), so a RUN from before it would pass for the answer to the
// next enabling order, and its end for a loss of power. Therefore
//
//   * an enabling order goes to a drive that has been seen off since the last disabling one, and only RUN seen after that order is its power;
//   * a disabling order is repeated until the drive has confirmed it, and only RUN off that was asked for after that is off;
//   * what has power without such an order, or has lost it, is disabled before it is enabled again.
//
//   off --enabling order--> enabling --RUN--> on --wish ends, RUN off--> unclear --disabled, then RUN off--> off
//                           enabling --wish ends--> unclear               off --RUN--> unclear
//
// Assumed: RUN shows what an order did before the next question is answered (not stated). Pure; service side.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes::xp200 {

class PowerOrders {
public:
    /// None more often than RUN needs to follow (Pr169, Pr166), unless it was not answered.
    static constexpr Duration again = std::chrono::seconds{1};
    enum class Heard : std::uint8_t { nothing, refused, done };

    /// Whether power is wanted, and by which wish (Wish::power_turn). A drive that never heard of a pause between two wishes had none.
    void want(bool wanted, std::uint16_t turn) noexcept {
        if (state_ != State::enabling && state_ != State::on) return;
        if (!wanted) revoke();
        else turn_ = turn;
    }
    /// True: order it now.
    [[nodiscard]] bool enable(std::uint16_t turn, Instant now) noexcept {
        if (state_ != State::off && (state_ != State::enabling || waits(now))) return false;
        turn_ = turn;
        has_power_ = false;
        return ordered(State::enabling, now);
    }
    [[nodiscard]] bool disable(Instant now) noexcept { return state_ == State::unclear && !waits(now) && ordered(State::unclear, now); }
    /// To the order that was given last.
    void answered(Heard heard) noexcept {
        heard_ = heard;
        if (state_ == State::unclear) disabled_ = heard == Heard::done;
    }
    /// Disabled whatever was before: the line has been opened.
    void opened(Instant now) noexcept {
        (void)ordered(State::unclear, now);
        answered(Heard::done);
    }
    void forget() noexcept {
        state_ = State::off;
        has_power_ = false;
    }

    /// RUN, asked for after the last order.
    void seen(bool running) noexcept {
        if (!running) has_power_ = false;
        if (running && state_ == State::enabling) {
            state_ = State::on;
            has_power_ = true;
        } else if (running && state_ == State::off) revoke();  // somebody else's
        else if (!running && state_ == State::on) revoke();
        else if (!running && state_ == State::unclear && disabled_) state_ = State::off;
    }

    [[nodiscard]] bool on() const noexcept { return state_ == State::on; }
    /// Neither power nor an order that could give it.
    [[nodiscard]] bool off() const noexcept { return state_ == State::off; }
    /// It has to be disabled before anything else.
    [[nodiscard]] bool unclear() const noexcept { return state_ == State::unclear; }
    /// The wish that it has got its power by, and still has it, also if that is to go; 0: none of them.
    [[nodiscard]] std::uint16_t power_of() const noexcept { return has_power_ ? turn_ : std::uint16_t{0}; }

private:
    enum class State : std::uint8_t { off, enabling, on, unclear };

    [[nodiscard]] bool waits(Instant now) const noexcept { return heard_ != Heard::nothing && now - ordered_at_ < again; }
    [[nodiscard]] bool ordered(State state, Instant now) noexcept {
        state_ = state;
        ordered_at_ = now;
        heard_ = Heard::nothing;
        disabled_ = false;
        return true;
    }
    void revoke() noexcept {
        state_ = State::unclear;
        heard_ = Heard::nothing;  // the next order waits for nobody
        disabled_ = false;
    }

    State state_ = State::off;
    Heard heard_ = Heard::nothing;
    bool disabled_ = false;   // the drive has confirmed it
    bool has_power_ = false;  // RUN, by the last enabling order
    std::uint16_t turn_ = 0;
    Instant ordered_at_{};
};

}  // namespace taktwerk::axes::xp200
