#pragma once
// The four ports of a slave controller: which have a link, which are closed to a loop, and why. A closed port sends the frame on
// to the next port inside the slave. Real-time safe. Source: ETG.1000.4 (0101h DL control, 0110h DL status), ETG.1000.3.

#include <array>
#include <cstdint>

#include "ecat/topology/topology.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat::sim {

/// Two bits a port in 0101h.
enum class LoopMode : std::uint8_t {
    automatic = 0,      ///< closed without link, opens with it
    closes_itself = 1,  ///< closed when the link is lost; opens when 0101h is written again, or when a frame arrives
    open = 2,           ///< whatever the link does: frames towards a missing neighbour are lost
    closed = 3,
};

class Ports {
public:
    void power_on() noexcept { *this = Ports{}; }

    /// Bit p: port p has a link. Returns the ports that lost theirs.
    std::uint8_t set_links(std::uint8_t links) noexcept {
        const auto lost = static_cast<std::uint8_t>(links_ & ~links);
        const auto before = links_;
        links_ = links;
        for (unsigned p = 0; p < ports_per_slave; ++p) {
            // With its first link after power-on this mode opens, too.
            if (mode(p) == LoopMode::closes_itself && (had_link_ & (1u << p)) != 0 && (before & (1u << p)) == 0) continue;
            settle(p);
        }
        had_link_ |= links;
        return lost;
    }
    /// 0101h was written.
    void set_modes(std::uint8_t modes) noexcept {
        modes_ = modes;
        for (unsigned p = 0; p < ports_per_slave; ++p) settle(p);
    }
    [[nodiscard]] std::uint8_t modes() const noexcept { return modes_; }
    /// A frame arrives at port p. False: the port is closed and does not take it.
    bool takes_frame(unsigned p) noexcept {
        if (mode(p) == LoopMode::closes_itself) settle(p);
        return open(p);
    }

    [[nodiscard]] LoopMode mode(unsigned p) const noexcept { return static_cast<LoopMode>((modes_ >> (2 * p)) & 3u); }
    [[nodiscard]] std::uint8_t links() const noexcept { return links_; }
    [[nodiscard]] bool link(unsigned p) const noexcept { return ((links_ >> p) & 1u) != 0; }
    [[nodiscard]] bool open(unsigned p) const noexcept { return ((closed_ >> p) & 1u) == 0; }
    /// Closed because there is no link, not because the master said so.
    [[nodiscard]] bool closed_itself(unsigned p) const noexcept { return !open(p) && mode(p) != LoopMode::closed; }

    /// The port bits of 0110h.
    [[nodiscard]] std::uint16_t dl_status() const noexcept {
        unsigned bits = 0;
        for (unsigned p = 0; p < ports_per_slave; ++p) {
            if (link(p)) bits |= (1u << (4 + p)) | (1u << (9 + 2 * p));
            if (!open(p)) bits |= 1u << (8 + 2 * p);
        }
        return static_cast<std::uint16_t>(bits);
    }

private:
    void settle(unsigned p) noexcept {
        const bool closed = mode(p) == LoopMode::closed || (mode(p) != LoopMode::open && !link(p));
        const auto bit = static_cast<std::uint8_t>(1u << p);
        closed_ = static_cast<std::uint8_t>(closed ? closed_ | bit : closed_ & ~bit);
    }

    std::uint8_t modes_ = 0, links_ = 0, had_link_ = 0, closed_ = 0x0F;
};

}  // namespace taktwerk::ecat::sim
