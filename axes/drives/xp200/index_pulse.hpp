#pragma once
// Where the encoder's index pulses lie, without a latch: at rest, position and single-turn value (status 0005h and 0014h, 0 at the pulse: 3.3 note 6)
// are read of the same place, and the pulses are a turn apart. From then on a pulse is passed when the position passes its place, however late
// that is heard of: exact to the count. Whether the single-turn value is right before the first pulse is not stated, so it counts only after a
// full turn. Pure; line side.

#include <algorithm>
#include <cstdint>
#include <optional>

namespace taktwerk::axes::xp200 {

class IndexPulse {
public:
    /// `turn`: counts, > 0.
    explicit IndexPulse(std::int64_t turn) noexcept : turn_(turn) {}

    /// The position's zero may be another one.
    void forget() noexcept {
        pulse_.reset();
        seen_ = latched_ = false;
    }
    /// Each position, in order. True: the motor has not moved since the one before.
    bool at(std::int64_t position) noexcept {
        const bool rests = seen_ && position == position_;
        if (!seen_) lowest_ = highest_ = position_ = position;
        seen_ = true;
        if (armed_ && pulse_ && !latched_) latched_ = passes(position_, position);
        position_ = position;
        lowest_ = std::min(lowest_, position);
        highest_ = std::max(highest_, position);
        return rests;
    }
    /// The single-turn value at `position`.
    void measured(std::int64_t position, std::int64_t single_turn) noexcept { pulse_ = position - single_turn; }
    /// A full turn since forget(): the single-turn value means something.
    [[nodiscard]] bool turned() const noexcept { return highest_ - lowest_ >= turn_; }
    [[nodiscard]] bool known() const noexcept { return pulse_.has_value(); }

    void arm(bool armed) noexcept {
        armed_ = armed;
        latched_ = false;
    }
    /// Waits for a pulse, and will notice it.
    [[nodiscard]] bool waits() const noexcept { return armed_ && known(); }
    [[nodiscard]] bool latched() const noexcept { return latched_; }
    [[nodiscard]] std::int64_t place() const noexcept { return place_; }

private:
    /// The first pulse on the way; that it began on does not count.
    bool passes(std::int64_t from, std::int64_t to) noexcept {
        const auto below = [&](std::int64_t position) {  // the highest pulse that is not above it
            const auto way = position - *pulse_;
            return *pulse_ + (way >= 0 ? way / turn_ : (way - turn_ + 1) / turn_) * turn_;
        };
        place_ = to > from ? below(from) + turn_ : below(from - 1);
        return to > from ? place_ <= to : to < from && place_ >= to;
    }

    std::int64_t turn_;
    std::optional<std::int64_t> pulse_;  // one of them
    bool seen_ = false, armed_ = false, latched_ = false;
    std::int64_t position_ = 0, lowest_ = 0, highest_ = 0, place_ = 0;
};

}  // namespace taktwerk::axes::xp200
