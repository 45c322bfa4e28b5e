#pragma once
// An AF_XDP socket on queue 0 of an interface, in copy mode. What it hears is decided by an XdpProgram. Linux only.
//
// Copy mode, although some drivers could send from and receive into our memory themselves (zero copy): then the kernel takes frames to be sent only
// inside our own system call, and one that could not leave is ours to take back. It would leave when the cable is in again else, with set-points of
// long ago. What a copy of some hundred bytes costs is nothing beside the system call.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/transport/descriptor.hpp"
#include "ecat/transport/xdp_rings.hpp"

namespace taktwerk::ecat {

class XdpSocket {
public:
    /// Memory, rings and binding; waits a moment for a queue that is just being given free. Not real-time. Errors: transport.no_xdp.
    [[nodiscard]] static Result<std::unique_ptr<XdpSocket>> open(std::string_view interface, unsigned index);

    /// One system call. False: no carrier, interface gone, all places taken, too long; the frame is forgotten then. Real-time safe.
    [[nodiscard]] bool send(std::span<const std::byte> frame) noexcept;

    struct Arrived {
        std::size_t size = 0;
        std::int64_t stamp_ns = 0;  ///< CLOCK_MONOTONIC; 0: not dated
    };
    /// No system call, unless the driver asks to be woken. Real-time safe, on the thread that sends.
    [[nodiscard]] std::optional<Arrived> receive(std::span<std::byte> buffer) noexcept;

    /// Frames since opening that found no place: the cycle did not fetch others in time. Any thread, one system call.
    [[nodiscard]] std::uint64_t dropped() const noexcept;
    [[nodiscard]] int descriptor() const noexcept { return socket_.get(); }

    static constexpr std::uint32_t receive_places = 256, send_places = 64;

private:
    explicit XdpSocket(Descriptor socket) : socket_(std::move(socket)) {}
    /// What failed; empty: nothing.
    [[nodiscard]] std::string_view set_up(unsigned index) noexcept;
    void take_sent() noexcept;

    static constexpr std::uint32_t place_size = 2048;

    Mapping frames_;  // the socket's own count on it ends with the socket, so the socket goes first
    XdpRing<std::uint64_t> fill_, completion_;
    XdpRing<xdp_desc> receive_, transmit_;
    Descriptor socket_;
    std::uint32_t filled_ = 0, received_ = 0, sent_ = 0, completed_ = 0;
    std::array<std::uint64_t, send_places> free_{};
    std::size_t free_count_ = 0;
    std::optional<std::uint64_t> not_taken_;  ///< place of a frame that stands in the ring and the kernel did not take
};

}  // namespace taktwerk::ecat
