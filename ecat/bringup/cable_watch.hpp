#pragma once
// Looks at the error counters of every port while the bus runs, so that a bad cable is known before it takes slaves away: what rose within the last
// minute, and at which port. A slave that fell or came back, and a cable that was pulled, count nothing: those have alarms of their own.
//
// A cable that breaks raises the counters at once, and the cycle sees it with its next frame: so what a look finds counts only when some
// frames have come back behind it, and nobody came, went or began anew since the look before.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "ecat/bringup/bus.hpp"
#include "ecat/bringup/port_counters.hpp"

namespace taktwerk::ecat {

/// Of one port or one cable, within the time that is remembered.
struct CableRise {
    unsigned lost_links = 0, errors = 0;
    /// Fewer errors may be a contactor that switched.
    [[nodiscard]] bool worth_telling() const noexcept { return lost_links > 0 || errors >= 3; }
    /// A lost link weighs more than any number of errors.
    [[nodiscard]] bool worse_than(const CableRise& other) const noexcept {
        return lost_links != other.lost_links ? lost_links > other.lost_links : errors > other.errors;
    }
    friend bool operator==(const CableRise&, const CableRise&) = default;
};

/// What rose at one slave's ports within a minute. Pure.
class CableHistory {
public:
    static constexpr Duration span = std::chrono::seconds{5};  ///< what rises within so long is forgotten together
    static constexpr std::size_t spans = 12;                   ///< that are remembered
    static constexpr unsigned nearly_full = 200;               ///< counters stop at 255

    /// The next look: what is more than at the last one. Times never go backwards.
    void add(const SlaveCounters& now, Instant at) noexcept;
    /// The next look shows what is no matter of the cables: it only says where the counters stand.
    void forget_base() noexcept { based_ = links_based_ = false; }
    /// The same of lost links alone.
    void forget_links() noexcept { links_based_ = false; }
    /// They are to be cleared.
    [[nodiscard]] bool full() const noexcept;
    [[nodiscard]] CableRise lately(unsigned port, Instant now) const noexcept;

private:
    struct Rise {
        std::uint16_t lost_links = 0, errors = 0;
    };
    struct Span {
        std::int64_t number = -1;  ///< of the five seconds that it is about; -1: of none yet
        std::array<Rise, ports_per_slave> ports{};
    };
    [[nodiscard]] Span& span_of(Instant at) noexcept;

    SlaveCounters base_{};
    bool based_ = false, links_based_ = false;
    std::array<Span, spans> spans_{};
};

/// Runs until it is destroyed.
[[nodiscard]] Script<void> watch_cables(Bus& bus);

/// The cable at a port, by both ends: "between slave 3 'y' (sv33-e) port 1 and slave 4 'z' (sv33-e)"; "at its port 2" where nobody is.
[[nodiscard]] std::string cable_text(const Bus& bus, const BusSlave& slave, unsigned port);

}  // namespace taktwerk::ecat
