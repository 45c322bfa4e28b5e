#pragma once
// What must act whatever else happens: stop an axis, let go of a jog, end the run. Levels, not entries of a queue: raising one cannot
// fail, waits for nobody and needs no room. Any thread may raise them, a signal handler too; the cycle takes them in its inbox step,
// before the commands, and records them there like everything that comes from outside.
//
// Each level that is raised gets a number, counted over all of them. A command knows the count at which it reached the process
// (OperatorCommand::after), so the cycle can tell what was given before a stop and came to its turn behind it.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace taktwerk::runtime {

enum class StopLevel : std::uint8_t { stop, release_jog, shutdown };

class StopLevels {
public:
    static constexpr std::uint16_t all_axes = 0xFFFF;

    /// One raised level, for who waits until it was taken.
    struct Ticket {
        std::size_t slot = 0;
        std::uint64_t number = 0;
    };

    explicit StopLevels(std::size_t axes) : axes_(axes), slots_(std::make_unique<Slot[]>(2 * axes + 2)) {}

    // --- any thread; async-signal-safe -----------------------------------------------------------------------------------------
    /// `axis`: below the number of axes, or all_axes.
    Ticket stop(std::uint16_t axis) noexcept { return raise(axis < axes_ ? axis : 2 * axes_); }
    Ticket release_jog(std::uint16_t axis) noexcept { return raise(axes_ + axis); }
    Ticket shutdown() noexcept { return raise(2 * axes_ + 1); }
    [[nodiscard]] std::uint64_t raised() const noexcept { return raised_.load(std::memory_order_acquire); }
    /// From a recording: with the number that it had there.
    void raise_again(StopLevel level, std::uint16_t axis, std::uint64_t number) noexcept {
        const std::size_t all = level == StopLevel::shutdown ? 2 * axes_ + 1 : 2 * axes_;
        const std::size_t slot = axis >= axes_ ? all : level == StopLevel::release_jog ? axes_ + axis : axis;
        slots_[slot].asked.store(number, std::memory_order_release);
        if (raised_.load(std::memory_order_relaxed) < number) raised_.store(number, std::memory_order_release);
    }
    [[nodiscard]] bool taken(Ticket ticket) const noexcept {
        return slots_[ticket.slot].taken.load(std::memory_order_acquire) >= ticket.number;
    }

    // --- cycle thread ------------------------------------------------------------------------------------------------------------
    /// `each(StopLevel, axis, number)` for what was raised since the last call, always in the same order.
    template <class Each>
    void take(Each&& each) noexcept {
        for (std::size_t slot = 0; slot < 2 * axes_ + 2; ++slot) {
            auto& s = slots_[slot];
            const auto number = s.asked.load(std::memory_order_acquire);
            if (number == s.taken.load(std::memory_order_relaxed)) continue;
            if (slot < axes_) each(StopLevel::stop, static_cast<std::uint16_t>(slot), number);
            else if (slot < 2 * axes_) each(StopLevel::release_jog, static_cast<std::uint16_t>(slot - axes_), number);
            else if (slot == 2 * axes_) each(StopLevel::stop, all_axes, number);
            else each(StopLevel::shutdown, all_axes, number);
            s.taken.store(number, std::memory_order_release);
        }
    }

private:
    struct Slot {
        std::atomic<std::uint64_t> asked{0}, taken{0};
    };
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "levels are raised by signal handlers");

    Ticket raise(std::size_t slot) noexcept {
        const auto number = raised_.fetch_add(1, std::memory_order_acq_rel) + 1;
        auto& asked = slots_[slot].asked;
        auto before = asked.load(std::memory_order_relaxed);
        while (before < number && !asked.compare_exchange_weak(before, number, std::memory_order_release, std::memory_order_relaxed)) {}
        return {slot, number};
    }

    std::size_t axes_;
    std::unique_ptr<Slot[]> slots_;
    std::atomic<std::uint64_t> raised_{0};
};

}  // namespace taktwerk::runtime
