#pragma once
// Which slave hangs where, which links are up, and the way a frame takes through them. The way is computed when a link or a loop
// changes; a frame only follows it. Source: ETG.1000.3 (order of the ports), ETG.1000.4 (circulating frames, loop control).
//
// Inside a slave the ports form a ring: 0 -> processing unit -> 3 -> 1 -> 2 -> 0. A frame that enters anywhere goes on to the next
// open port, around the branch behind it, and so on until it leaves where it came in. It is processed where it passes from port 0
// to port 3: at once when it entered at port 0, else on its way round.
//
// A ring: the master has two ends. Where all cables are in, a frame that enters at one end leaves at the other: from the first end
// processed by all, from the second by none, since it passes every slave from port 1 to port 0. At a break the ports to both sides of it
// close, so each end has a line of its own; the slaves of the second end's process a frame on its way back, nearest to the break first.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/math.hpp"
#include "core/time.hpp"
#include "ecat/sim/sim_slave.hpp"
#include "ecat/topology/topology.hpp"

namespace taktwerk::ecat::sim {

/// Time a frame needs inside a slave, between two open ports (or from a port back to itself when all others are closed). Through
/// the processing unit it is some 40 ns more than past it, as in the common controllers: half of that per slave is what a master
/// that takes both ways for equal gets wrong.
struct SlaveDelays {
    Duration forward = std::chrono::nanoseconds{600};  ///< through the processing unit
    Duration back = std::chrono::nanoseconds{560};     ///< past it, between any other two ports
};

/// 5 ns a metre: two thirds of the speed of light.
[[nodiscard]] constexpr Duration cable_delay(double metres) noexcept { return Duration{math::round_to_int64(metres * 5.0)}; }

/// One slave and the cable that leads to it from the master's side.
struct Place {
    std::unique_ptr<SimSlave> slave;
    Place* parent = nullptr;  ///< none: the master's cable
    unsigned parent_port = 1, entry_port = 0;
    std::array<Place*, ports_per_slave> child{};
    bool plugged = true;
    Duration cable{};
    SlaveDelays delays{};

    /// Of a frame that follows a route: when it arrives at each port, counted from its start at the master.
    struct Passage {
        std::array<Duration, ports_per_slave> arrival{};
        std::uint8_t arrives = 0;  ///< bit p: it does
    };
    std::array<Passage, 2> passage{};  ///< by the end at which it started
};

/// An end of the master's cabling: its network interface, or the second one of a ring.
enum class CableEnd : std::uint8_t { first, second };
[[nodiscard]] constexpr std::size_t number(CableEnd end) noexcept { return static_cast<std::size_t>(end); }

/// The frame at the processing unit of one slave.
struct Visit {
    Place* place = nullptr;
    Duration at{};             ///< since its start at the master
    bool port_0_shut = false;  ///< port 0 closed itself: the frame gets its circulating bit, or dies of it
};

/// What becomes of a frame that starts at one end.
struct Route {
    bool enters = false;  ///< there is a link at that end
    std::vector<Visit> visits;
    std::optional<Duration> flight;  ///< until it is at an end again; nothing: it is lost on the way
    CableEnd leaves = CableEnd::first;
};

class Wiring {
public:
    /// `parent`: nullptr for the slave at the master's cable. The port must be free. Allocates all that a route can need.
    Place& add(std::unique_ptr<SimSlave> slave, Place* parent, unsigned port, unsigned entry_port, const SlaveDelays& delays,
               Duration cable);
    /// The master's second end goes into `port` of `last`: a ring. The port must be free.
    void close_ring(Place& last, unsigned port, Duration cable);
    /// The cable of the second end; no ring: nothing happens.
    void plug_ring(bool plugged) noexcept { ring_plugged_ = plugged; }
    /// In processing order with every cable plugged in and every slave on.
    [[nodiscard]] std::span<Place* const> places() const noexcept { return order_; }
    [[nodiscard]] Place* find(const SimSlave& slave) const noexcept;

    /// Tells every controller which of its ports have a link now, and computes the way anew. Call when a cable, a power supply or
    /// a loop changed. Allocation-free.
    void update() noexcept;

    [[nodiscard]] const Route& route(CableEnd from) const noexcept { return routes_[number(from)]; }

private:
    struct Port {
        Place* place = nullptr;
        unsigned number = 0;
    };
    [[nodiscard]] bool ring_linked() const noexcept;
    [[nodiscard]] std::uint8_t links_of(const Place& place) const noexcept;
    void follow(CableEnd from) noexcept;
    [[nodiscard]] static unsigned pass(Place& place, unsigned port, Duration& at, Route& route) noexcept;
    void count(Place& place);

    std::vector<std::unique_ptr<Place>> places_;  // as they were added
    std::vector<Place*> order_;
    std::array<Route, 2> routes_;  // by the end where they start
    Port ring_;                    // what the second end is plugged into; no place: no ring
    Duration ring_cable_{};
    bool ring_plugged_ = true;
};

}  // namespace taktwerk::ecat::sim
