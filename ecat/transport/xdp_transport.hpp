#pragma once
// EtherCAT frames on a network interface by AF_XDP: the kernel hands them over before it makes packets of them, and takes them past its queues. Linux
// only, from 5.9 on; needs CAP_NET_RAW, CAP_NET_ADMIN and CAP_BPF.
//
// It stands beside a packet socket that is open already and keeps what that one is for: the lock against a second master, the carrier, and the
// frames that do not come by: EtherCAT is no IP, so cards with several queues put it into the first one, the only one heard here; what a card puts
// elsewhere all the same, or sends with a VLAN tag, the kernel gives to the packet socket. receive() asks there, too, and news() says that it happens.
//
// Beside it others hear nothing of EtherCAT on this interface, Wireshark and `taktwerk bus capture` included: frames are gone before
// their sockets are asked. All other traffic goes where it went.
//
// A frame's arrival is the instant at which the program saw it, of the clock that machine time is.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/clock.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "ecat/transport/xdp_program.hpp"
#include "ecat/transport/xdp_socket.hpp"

namespace taktwerk::ecat {

class XdpTransport final : public Transport {
public:
    /// On the interface of `beside`, which outlives it. `clock` as RawSocketOptions has it. Not real-time; where the driver takes the program
    /// the card may start anew, and its link with it. Errors: transport.no_xdp, transport.xdp_taken.
    [[nodiscard]] static Result<std::unique_ptr<XdpTransport>> open(RawSocketTransport& beside, XdpProgram::Places places,
                                                                    const Clock* clock = nullptr);

    /// One system call. False: no carrier, interface gone, longer than its MTU. What could not leave is forgotten.
    bool send(std::span<const std::byte> frame, Instant now) noexcept override;
    [[nodiscard]] Instant departure(Instant now) const noexcept override { return clock_ != nullptr ? departed_ : now; }
    /// No system call where a frame has come, else one.
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override;
    [[nodiscard]] MacAddress mac() const noexcept override { return beside_.mac(); }
    [[nodiscard]] bool link_up() const noexcept override { return beside_.link_up(); }
    [[nodiscard]] std::optional<Error> link_trouble() const override { return beside_.link_trouble(); }

    /// As RawSocketTransport has it, and for that one, too.
    void refresh() noexcept;
    /// What has come to light since open(), once; else empty. Of the thread that calls refresh().
    [[nodiscard]] std::string news();
    /// Frames that nobody fetched in time, as of the last refresh(), on its thread.
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
    /// Frames that came by the packet socket instead; likewise.
    [[nodiscard]] std::uint64_t passed_by() const noexcept { return beside_.statistics().received - beside_before_; }
    /// "AF_XDP in the driver, ...", for whoever wants to know how his frames go.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] XdpProgram::Place place() const noexcept { return place_; }

private:
    XdpTransport(RawSocketTransport& beside, std::unique_ptr<XdpSocket> socket, XdpProgram program, XdpProgram::Place place)
        : beside_(beside), socket_(std::move(socket)), program_(std::move(program)), place_(place) {}

    RawSocketTransport& beside_;
    std::unique_ptr<XdpSocket> socket_;
    XdpProgram program_;
    XdpProgram::Place place_;
    const Clock* clock_ = nullptr;
    Instant departed_{};
    std::atomic<std::size_t> longest_{max_frame_size};  ///< that the interface sends
    std::uint64_t beside_before_ = 0, dropped_ = 0;
    bool said_passed_by_ = false;
};

}  // namespace taktwerk::ecat
