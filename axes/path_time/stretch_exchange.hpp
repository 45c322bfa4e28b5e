#pragma once
// From the planner to the cycle: stretches of s(t), each of which ends at rest. A stretch takes the place of what is left of the one before it,
// from a piece on that has not begun yet: whoever runs a stretch that nothing follows comes to a stop inside all limits.

#include <array>
#include <atomic>
#include <cstdint>

#include "axes/path_time/time_piece.hpp"

namespace taktwerk::axes {

struct TimeStretch {
    static constexpr int most_pieces = 4096;

    std::uint32_t id = 0;       ///< counts from 1
    std::uint32_t follows = 0;  ///< the stretch whose piece `at_piece` its first piece replaces; 0: the first of all
    int at_piece = 0;
    int count = 0;
    std::array<TimePiece, most_pieces> pieces{};
};

/// Where the cycle is: on a piece of a stretch; behind the last piece it stands.
struct StretchProgress {
    std::uint32_t stretch = 0;
    int piece = 0;
};

/// One planner, one cycle, any two threads. Wait-free. One stretch runs, one is offered.
class StretchExchange {
public:
    // The planner's side.

    /// A stretch to be filled; nothing while the last one offered was neither taken nor refused.
    [[nodiscard]] TimeStretch* free_stretch() noexcept { return offering() ? nullptr : &stretches_[filled_ ^ 1u]; }
    /// Offers the stretch that free_stretch() gave.
    void offer() noexcept { offer_.store(free_one(), std::memory_order_release); }
    [[nodiscard]] bool offering() const noexcept { return offer_.load(std::memory_order_acquire) != Offer::none; }
    /// The offer is free_stretch() again. False: it was taken or refused, or the cycle is looking at it just now.
    [[nodiscard]] bool take_back() noexcept {
        Offer made = free_one();
        return offer_.compare_exchange_strong(made, Offer::none, std::memory_order_acq_rel, std::memory_order_acquire);
    }
    /// Where the cycle is. Asked for after offering() was false, it says whether the last offer was taken: from then on its stretch runs.
    [[nodiscard]] StretchProgress progress() const noexcept {
        const std::uint64_t both = progress_.load(std::memory_order_acquire);
        return {static_cast<std::uint32_t>(both >> 32), static_cast<int>(both & 0xffffffffu)};
    }
    /// The last offer was taken: what the cycle ran before is the planner's again.
    void was_taken() noexcept { filled_ ^= 1u; }
    /// As new, for another path. While the cycle uses it no more, and not yet again.
    void reset() noexcept {
        filled_ = 0;
        offer_.store(Offer::none, std::memory_order_relaxed);
        progress_.store(0, std::memory_order_release);
    }

    // The cycle's side.

    /// What is offered; nobody takes it back until answer() or leave().
    [[nodiscard]] const TimeStretch* look() noexcept {
        looked_at_ = offer_.load(std::memory_order_acquire);
        const bool mine = looked_at_ != Offer::none && offer_.compare_exchange_strong(looked_at_, Offer::looked_at,
                                                                                      std::memory_order_acq_rel, std::memory_order_acquire);
        return mine ? &stretches_[looked_at_ == Offer::first ? 0 : 1] : nullptr;
    }
    /// It stays an offer: its border has not come.
    void leave() noexcept { offer_.store(looked_at_, std::memory_order_release); }
    /// Takes or refuses the offer; where the cycle is has been told before.
    void answer() noexcept { offer_.store(Offer::none, std::memory_order_release); }
    void tell(const StretchProgress& at) noexcept {
        progress_.store((static_cast<std::uint64_t>(at.stretch) << 32) | static_cast<std::uint32_t>(at.piece), std::memory_order_release);
    }

private:
    enum class Offer : std::uint8_t { none, first, second, looked_at };
    [[nodiscard]] Offer free_one() const noexcept { return (filled_ ^ 1u) == 0 ? Offer::first : Offer::second; }

    std::array<TimeStretch, 2> stretches_{};
    unsigned filled_ = 0;  // the planner's: the other one is free
    std::atomic<Offer> offer_{Offer::none};
    Offer looked_at_ = Offer::none;  // the cycle's
    std::atomic<std::uint64_t> progress_{0};
};

}  // namespace taktwerk::axes
