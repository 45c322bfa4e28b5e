#pragma once
// Counts what lets the error counters of ports rise although no cable is bad: slaves that come, go or begin anew, and a ring that opens or
// closes. Whoever reads those counters asks before and after: a look at the state of the bus alone misses what is over again.

#include <cstdint>

#include "ecat/ring/ring_state.hpp"
#include "ecat/wire/al_status.hpp"

namespace taktwerk::ecat {

/// Of the cycle, real-time safe.
class Upheavals {
public:
    /// Of each frame that came back from all who are there. `states`: OR of their AL states; INIT is what a slave begins with.
    void see_slaves(std::uint16_t answering, std::uint16_t states) noexcept {
        Picture now = last_;
        now.answering = answering;
        now.some_in_init = (states & static_cast<std::uint16_t>(AlState::init)) != 0;
        note(now);
    }
    /// In each cycle.
    void see_ring(const RingState& ring) noexcept {
        Picture now = last_;
        now.broken = ring.broken();
        now.before_break = now.broken ? ring.before_break : std::uint16_t{0};
        now.behind_break = now.broken ? ring.behind_break : std::uint16_t{0};
        note(now);
    }
    [[nodiscard]] std::uint32_t count() const noexcept { return count_; }

private:
    struct Picture {
        std::uint16_t answering = 0, before_break = 0, behind_break = 0;
        bool some_in_init = false, broken = false;
        friend bool operator==(const Picture&, const Picture&) = default;
    };
    void note(const Picture& now) noexcept {
        if (now != last_) ++count_;
        last_ = now;
    }

    Picture last_;
    std::uint32_t count_ = 0;
};

}  // namespace taktwerk::ecat
