#pragma once
// EtherCAT frames on a network interface: an AF_PACKET socket bound to EtherType 88A4h. Linux only.
//
// Answers come back with the broadcast destination they were sent with, so promiscuous mode is not needed. The socket
// sees no outgoing frames (PACKET_IGNORE_OUTGOING), skips the queueing discipline (PACKET_QDISC_BYPASS) and never blocks.
// A frame's arrival is the time at which receive() was asked: kernel stamps are of another clock.
//
// One master an interface: opening takes the abstract Unix socket "taktwerk.nic.<interface>" of the network namespace, so
// that a second Taktwerk is refused with the first one's process id. The kernel drops it when the process ends, however.
// (Other makes of masters are not seen.)

#include <atomic>
#include <memory>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::ecat {

struct RawSocketOptions {
    int priority = 7;           ///< SO_PRIORITY: 0..6 without privilege, 7 needs CAP_NET_ADMIN; refused values are ignored
    bool skip_queueing = true;  ///< PACKET_QDISC_BYPASS: straight to the driver. False: through tc, e.g. to shape a test
    bool exclusive = true;      ///< take the interface's lock; false only for a listener beside the master
};

class RawSocketTransport final : public Transport {
public:
    /// Opens `interface` ("eth1"). Not real-time. Errors: transport.no_such_interface, transport.not_ethernet,
    /// transport.interface_down, transport.no_privilege, transport.in_use, transport.socket.
    static Result<std::unique_ptr<RawSocketTransport>> open(std::string_view interface, const RawSocketOptions& options = {});
    ~RawSocketTransport() override;
    RawSocketTransport(const RawSocketTransport&) = delete;
    RawSocketTransport& operator=(const RawSocketTransport&) = delete;

    /// One system call. False: no carrier, queue full, interface gone.
    bool send(std::span<const std::byte> frame, Instant now) noexcept override;
    /// One system call (without PACKET_IGNORE_OUTGOING, before Linux 4.20: one more for each own frame).
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override;
    [[nodiscard]] MacAddress mac() const noexcept override { return mac_; }
    /// As of the last refresh().
    [[nodiscard]] bool link_up() const noexcept override { return link_up_.load(std::memory_order_relaxed); }

    /// Asks the kernel for carrier and administrative state. From any thread but the cycle's: it is a system call that the
    /// cycle may not make.
    void refresh() noexcept;

    [[nodiscard]] const std::string& interface() const noexcept { return interface_; }
    /// For poll(2), by whoever plays the slaves; a master never waits on it.
    [[nodiscard]] int descriptor() const noexcept { return socket_; }

private:
    RawSocketTransport(std::string interface, int socket, int lock, const MacAddress& mac, bool sees_own_frames) noexcept;

    std::string interface_;
    int socket_;
    int lock_;  ///< -1 when not exclusive
    MacAddress mac_;
    bool sees_own_frames_;
    std::atomic<bool> link_up_{false};
};

}  // namespace taktwerk::ecat
