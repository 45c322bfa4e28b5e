#pragma once
// Looks at the error counters of every port while the bus runs, so that a bad cable is known before it takes slaves away: what rose within the last
// minute, and at which port. A slave that fell or came back, and a cable that was pulled, count nothing: those have alarms of their own.

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

/// What rose at one slave's ports lately. Pure.
class CableHistory {
public:
    static constexpr std::size_t looks = 12;      ///< that are remembered
    static constexpr unsigned nearly_full = 200;  ///< counters stop at 255

    /// The next look: what is more than at the last one.
    void add(const SlaveCounters& now) noexcept;
    /// The next look shows what is no matter of the cables: it only says where the counters stand.
    void forget_base() noexcept { based_ = false; }
    /// They are to be cleared.
    [[nodiscard]] bool full() const noexcept;
    [[nodiscard]] CableRise lately(unsigned port) const noexcept;

private:
    struct Rise {
        std::uint8_t lost_links = 0, errors = 0;
    };
    SlaveCounters base_{};
    bool based_ = false;
    std::array<std::array<Rise, ports_per_slave>, looks> rises_{};
    std::size_t next_ = 0;
};

/// Runs until it is destroyed.
[[nodiscard]] Script<void> watch_cables(Bus& bus);

/// The cable at a port, by both ends: "between slave 3 'y' (sv33-e) port 1 and slave 4 'z' (sv33-e)"; "at its port 2" where nobody is.
[[nodiscard]] std::string cable_text(const Bus& bus, const BusSlave& slave, unsigned port);

}  // namespace taktwerk::ecat
