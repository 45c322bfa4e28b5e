#pragma once
// Moves whole Ethernet frames with time stamps. Knows nothing of datagrams. Implementations: raw_socket.hpp (AF_PACKET),
// xdp_transport.hpp (AF_XDP), loopback.hpp (in-process, to simulated slaves).

#include <cstddef>
#include <optional>
#include <span>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/wire/frame.hpp"

namespace taktwerk::ecat {

struct ReceivedFrame {
    std::size_t size = 0;  ///< bytes written to the caller's buffer
    Instant at{};          ///< when it arrived (kernel stamp where there is one)
    bool half = false;     ///< of a broken ring, and the other half's copy got lost: who was not met may be there all the same
};

class RingView;

class Transport {
public:
    virtual ~Transport() = default;
    /// Sends one frame without FCS. False when the link did not take it (down, full): the caller counts it. Real-time safe.
    virtual bool send(std::span<const std::byte> frame, Instant now) noexcept = 0;
    /// When the frame that send() took last really left; `now` of that call where nobody measures it. What the reference clock
    /// stamps is compared with this, not with the instant at which the cycle was due.
    [[nodiscard]] virtual Instant departure(Instant now) const noexcept { return now; }
    /// One frame that has arrived by `now`, or nothing. Never blocks. Real-time safe.
    virtual std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept = 0;
    [[nodiscard]] virtual MacAddress mac() const noexcept = 0;
    /// False: no carrier. Cheap, real-time safe.
    [[nodiscard]] virtual bool link_up() const noexcept = 0;
    /// Why there is no link, where the interface itself is the reason and no cable: switched off, renamed, gone. Not real-time.
    [[nodiscard]] virtual std::optional<Error> link_trouble() const { return std::nullopt; }
    /// Itself where two interfaces are one ring (ecat/ring/), for whoever has to know; nullptr otherwise.
    [[nodiscard]] virtual RingView* ring() noexcept { return nullptr; }
};

}  // namespace taktwerk::ecat
