#pragma once
// The tree of slaves, from what each says of its ports. Pure; service side.
// Source: ETG.1000.3 (processing order of the ports), reference/ethercat-masters.md section 5 (0110h).
//
// A frame enters a slave, is processed, and leaves through the open ports in the order 0 -> 3 -> 1 -> 2 -> 0, going around each
// branch and coming back before it takes the next. A port is open when it has a signal and its loop is not closed. Slaves are
// numbered in the order in which they process the frame; that order and the number of open ports fix the tree:
//
//     master -- 0[A]1 -- 0[B]1 -- 0[D]       A: ports 0 1       position 0
//                         3                  B: ports 0 1 3     position 1
//                         |                  C: port 0          position 2, behind port 3 of B
//                        0[C]                D: port 0          position 3, behind port 1 of B

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::ecat {

inline constexpr unsigned ports_per_slave = 4;
/// The order in which a frame visits the ports after it was processed.
inline constexpr std::array<unsigned, ports_per_slave> port_order{0, 3, 1, 2};
/// The port that comes after `port` in that order.
[[nodiscard]] constexpr unsigned next_port(unsigned port) noexcept {
    constexpr std::array<unsigned, ports_per_slave> after{3, 2, 0, 1};
    return after[port & 3u];
}

struct SlavePlace {
    std::optional<std::size_t> parent;  ///< position of the slave towards the master; none: the first
    unsigned parent_port = 0;           ///< the parent's port that leads here
    unsigned entry_port = 0;            ///< own port towards the master
    std::array<bool, ports_per_slave> open{};
    std::array<std::optional<std::size_t>, ports_per_slave> child{};  ///< by port
    std::size_t depth = 0;                                            ///< slaves between it and the master

    [[nodiscard]] unsigned open_ports() const noexcept;
    /// The open ports other than the entry, in the order in which the frame takes them.
    [[nodiscard]] std::vector<unsigned> exits() const;
};

/// The port that the second interface of a ring is plugged into.
struct RingEnd {
    std::size_t slave = 0;
    unsigned port = 1;
    friend bool operator==(const RingEnd&, const RingEnd&) = default;
};

struct Topology {
    std::vector<SlavePlace> slaves;   ///< by position
    std::optional<RingEnd> ring_end;  ///< of a ring whose second cable is in
    std::size_t behind_break = 0;     ///< the last so many are reached from the second interface only
    /// `position` and everything behind it: what is gone when its cable is pulled. Ascending.
    [[nodiscard]] std::vector<std::size_t> behind(std::size_t position) const;
};

/// `dl_status`: 0110h of each slave, in the order of their positions. A slave's entry port is port 0 where that is open, else
/// its lowest open port in the processing order (the cable goes into the wrong socket: order of positions is then not the
/// wiring's, and the delays are still right).
/// Errors: bus.plugs_exchanged (the last to process frames has a way in and a way on, and the others are a whole tree without it: one
/// slave in the line is entered through its OUT socket), bus.topology (a slave has no open port, more slaves than open ports, or open ports without a slave behind them: the
/// bus changed while it was read, or a cable is half plugged). Names the position.
[[nodiscard]] Result<Topology> build_topology(std::span<const std::uint16_t> dl_status);

/// Of a ring: one open port leads to the second interface. `before_break`: slaves that the first interface reaches; all of them while the
/// ring is closed. Those behind a break are a tree of their own: the one next to the break has no parent.
/// Errors as above; bus.topology as well when no port leads to the second interface while slaves are reached from there.
[[nodiscard]] Result<Topology> build_ring_topology(std::span<const std::uint16_t> dl_status, std::size_t before_break);

}  // namespace taktwerk::ecat
