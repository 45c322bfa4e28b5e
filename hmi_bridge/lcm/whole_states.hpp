#pragma once
// What comes on the channel of whole states of one machine: the newest that is whole is kept, what is missing or no state of this run is counted. One thread,
// not real-time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "taktwerk_lcm/whole_state_v5_t.hpp"

namespace taktwerk::hmi {

class WholeStates {
public:
    /// A publication further ahead than a machine can have come since the last one is nobody's: twice the highest rate, and some.
    static constexpr std::int64_t most_a_second = 100, most_at_once = 1000;

    /// `run`: of the machine, as its socket says it.
    explicit WholeStates(std::int64_t run) : run_(run) {}

    /// Any bytes. Those of an older or the same publication are passed over.
    void receive(std::span<const std::byte> message, Instant at);
    /// The newest, once; nothing: none has come since the last call.
    [[nodiscard]] std::optional<taktwerk_lcm::whole_state_v5_t> take();

    /// Nobody listens for a while: what is missed meanwhile is not lost.
    void look_away() noexcept { looked_away_ = true; }

    /// When the newest came; Instant{}: none has.
    [[nodiscard]] Instant came() const noexcept { return came_; }
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }        ///< publications that did not come
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }  ///< messages that are no whole state
    [[nodiscard]] std::uint64_t foreign() const noexcept { return foreign_; }  ///< whole ones of another run

private:
    std::int64_t run_, newest_ = 0;
    std::vector<std::byte> bytes_;
    bool waits_ = false, looked_away_ = true;
    Instant came_{};
    std::uint64_t lost_ = 0, refused_ = 0, foreign_ = 0;
};

}  // namespace taktwerk::hmi
