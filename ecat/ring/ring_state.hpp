#pragma once
// What the master knows of its ring: plain numbers.

#include <cstdint>
#include <string_view>

namespace taktwerk::ecat {

enum class RingShape : std::uint8_t {
    none,           ///< one interface, no ring
    unknown,        ///< no frame has come back yet
    closed,         ///< frames that leave at one interface come back at the other
    open,           ///< each interface gets its own frames back: the cable is broken between two slaves
    first_silent,   ///< nothing comes back of what the first interface sends
    second_silent,  ///< nothing comes back of what the second interface sends, and the first gets its own
    one_way,        ///< as closed, but nothing comes back of what the second interface sends: no break could be borne
    exchanged,      ///< as closed, but the slaves count from the second interface: the plugs are exchanged
};

[[nodiscard]] constexpr std::string_view name(RingShape shape) noexcept {
    switch (shape) {
        case RingShape::none: return "none";
        case RingShape::unknown: return "unknown";
        case RingShape::closed: return "closed";
        case RingShape::open: return "open";
        case RingShape::first_silent: return "first_silent";
        case RingShape::second_silent: return "second_silent";
        case RingShape::one_way: return "one_way";
        case RingShape::exchanged: return "exchanged";
    }
    return "?";
}

struct RingState {
    RingShape shape = RingShape::none;
    std::uint16_t before_break = 0;  ///< slaves that the first interface reaches; meaningless while closed
    std::uint16_t behind_break = 0;  ///< slaves that the second interface reaches
    std::uint64_t opened = 0;        ///< how often it went from closed to something else
    std::uint16_t whole = 0;         ///< slaves when it was closed last; 0: it never was
    friend bool operator==(const RingState&, const RingState&) = default;

    /// Position of the first slave behind the break. Each half counts from its own end of the ring, so that nobody's position depends on who is
    /// missing between them.
    [[nodiscard]] std::uint16_t second_half() const noexcept {
        return whole >= behind_break && whole > 0 ? static_cast<std::uint16_t>(whole - behind_break) : before_break;
    }
    [[nodiscard]] bool broken() const noexcept {
        return shape == RingShape::open || shape == RingShape::first_silent || shape == RingShape::second_silent;
    }
    /// It takes a person: a break, or a ring that would not bear one.
    [[nodiscard]] bool needs_mending() const noexcept { return broken() || shape == RingShape::one_way || shape == RingShape::exchanged; }
};

/// How the half behind the break gets its time: see RingTransport::hand_time_on().
struct RingClocks {
    bool hand_on = false;    ///< the slaves behind the break get the time that the master expects the reference to have
    std::int64_t ahead = 0;  ///< ns: added to what the first interface's frame carries
    friend bool operator==(const RingClocks&, const RingClocks&) = default;
};

}  // namespace taktwerk::ecat
