#pragma once
// Waits for something to happen in the rows of a running machine, and looks at every sample for it: one condition, a window around each
// event. In steps of bounded work, beside the cycle.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "runtime/recording/signal_rows.hpp"

namespace taktwerk::runtime {

/// Edges need a sample before; samples that are not a number (NaN) are passed over: an edge across them counts.
struct TriggerCondition {
    enum class Kind : std::uint8_t {
        rising,   ///< from below `level` to it or above
        falling,  ///< from above `level` to it or below
        either,   ///< one of them
        above,    ///< is above `level`: at once where it already is
        below,    ///< is below `level`: likewise
        inside,   ///< `level` <= it <= `level2`: likewise
        outside,  ///< neither: likewise
        bit,      ///< bit `bit` of the whole number goes from 0 to 1
        alarm,    ///< said by offer()
    };
    Kind kind = Kind::rising;
    double level = 0, level2 = 0;
    unsigned bit = 0;  ///< 0 is the lowest one, up to 52
};

/// Whether it happens at this sample; one sample after the other.
class TriggerDetector {
public:
    explicit TriggerDetector(TriggerCondition condition) : condition_(condition) {}
    [[nodiscard]] bool happens(double value) noexcept;

private:
    TriggerCondition condition_;
    std::optional<double> before_;
};

class TriggerHunt {
public:
    enum class Mode : std::uint8_t {
        single,  ///< once
        normal,  ///< again and again
        automatic  ///< again and again; where nothing happens for a window (a tenth of a second at least), a window all the same, which keeps no event away
    };
    struct Request {
        TriggerCondition condition;
        SignalCell cell;                  ///< of the signal; of any for an alarm
        std::uint64_t pre = 0, post = 0;  ///< cycles before and behind the event
        Mode mode = Mode::single;
        std::uint64_t holdoff = 0;  ///< cycles behind an event in which nothing counts; at least `post`
    };
    struct Event {
        std::uint64_t cycle = 0;
        std::uint64_t from = 0, to = 0;  ///< the window [from, to): from is later than cycle - pre where the memory begins there
        bool automatic = false;
    };
    static constexpr std::size_t most_events = 16;  ///< the newest

    /// Begins with the newest row of `rows`, which outlives this.
    TriggerHunt(const SignalRows& rows, Request request);

    /// Looks at no more than about `most_rows` further ones. `told_to`: alarms up to this cycle have been offered; what waits for one goes no further.
    void step(std::size_t most_rows, std::uint64_t told_to = ~std::uint64_t{0});
    /// An alarm was raised in this cycle: what a condition of kind `alarm` waits for.
    void offer(std::uint64_t cycle);

    [[nodiscard]] bool armed() const noexcept { return armed_; }
    /// The first cycle that was not looked at yet.
    [[nodiscard]] std::uint64_t looked_to() const noexcept { return next_; }
    /// Rows that were overwritten before they were looked at.
    [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }
    [[nodiscard]] const std::deque<Event>& events() const noexcept { return events_; }
    [[nodiscard]] const TriggerCondition& condition() const noexcept { return request_.condition; }

private:
    void happened(std::uint64_t cycle, bool automatic);

    const SignalRows& rows_;
    Request request_;
    TriggerDetector detector_;
    bool armed_ = true;
    std::uint64_t next_, quiet_since_, not_before_, skipped_ = 0, patience_ = 0;
    std::deque<Event> events_;
    std::vector<std::uint64_t> buffer_;
};

}  // namespace taktwerk::runtime
