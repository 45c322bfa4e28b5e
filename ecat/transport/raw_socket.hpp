#pragma once
// EtherCAT frames on a network interface: an AF_PACKET socket bound to EtherType 88A4h. Linux only.
//
// Answers come back with the broadcast destination they were sent with, so promiscuous mode is not needed. The socket
// sees no outgoing frames, skips the queueing discipline and never blocks; packet_socket_options.hpp has what it asks the
// kernel for, report() what was refused.
//
// A frame's arrival is the kernel's receive stamp, carried from its real-time clock to ours with the distance that refresh()
// measured last; a stamp that cannot be (the clock was set meanwhile) is replaced by the time at which receive() was asked.
//
// Plain sends and receives, not a ring in shared memory (TPACKET): a cycle has one to a few frames, and a system call a frame
// is what a ring costs too for sending. docs/performance.md has the figures.
//
// One master an interface: opening takes the abstract Unix socket "taktwerk.nic.<interface>" of the network namespace, so
// that a second Taktwerk is refused with the first one's process id. The kernel drops it when the process ends, however. Everybody may
// hold such a name: who does so and has no EtherCAT socket on the interface is passed over, with a remark in the report.
// (Other makes of masters are not seen.)

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "ecat/transport/packet_socket_options.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::ecat {

/// Counters since opening, as of the last refresh().
struct RawSocketStatistics {
    std::uint64_t received = 0;  ///< frames the kernel handed to the socket
    std::uint64_t dropped = 0;   ///< and those it had no room for: the cycle did not fetch them in time
    std::uint64_t stamped = 0;   ///< sent frames with a stamp; only with RawSocketOptions::send_stamps
    Duration send_delay{};       ///< of the last stamped frame: from the time given to send() until it was with the driver
    Duration longest_send_delay{};
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
    [[nodiscard]] Instant departure(Instant now) const noexcept override { return clock_ != nullptr ? departed_ : now; }
    /// One system call (without PACKET_IGNORE_OUTGOING, before Linux 4.20: one more for each own frame).
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override;
    [[nodiscard]] MacAddress mac() const noexcept override { return mac_; }
    /// As of the last refresh().
    [[nodiscard]] bool link_up() const noexcept override { return link_up_.load(std::memory_order_relaxed); }

    [[nodiscard]] std::optional<Error> link_trouble() const override;

    /// Asks the kernel for carrier, clock distance and statistics. From one thread, not the cycle's: it makes system calls
    /// that the cycle may not make.
    void refresh() noexcept;
    /// Of the thread that calls refresh().
    [[nodiscard]] const RawSocketStatistics& statistics() const noexcept { return statistics_; }
    /// What was asked for and refused at opening.
    [[nodiscard]] const RawSocketReport& report() const noexcept { return report_; }

    [[nodiscard]] const std::string& interface() const noexcept { return interface_; }
    /// For poll(2), by whoever plays the slaves; a master never waits on it.
    [[nodiscard]] int descriptor() const noexcept { return socket_; }

private:
    RawSocketTransport(std::string interface, int socket, int lock, const MacAddress& mac, RawSocketReport report) noexcept;
    [[nodiscard]] Instant arrival(std::int64_t stamp_ns, Instant asked) const noexcept;
    void read_carrier() noexcept;
    void read_drops() noexcept;
    void read_send_stamps() noexcept;

    std::string interface_;
    int socket_;
    int lock_;  ///< -1 when not exclusive
    MacAddress mac_;
    RawSocketReport report_;
    const Clock* clock_ = nullptr;
    Instant departed_{};
    std::atomic<bool> link_up_{false};
    std::atomic<std::int64_t> realtime_minus_machine_ns_{0};
    RawSocketStatistics statistics_;

    static constexpr std::size_t remembered_sends = 256;
    std::array<std::atomic<std::int64_t>, remembered_sends> sent_at_ns_{};  ///< by the kernel's number of the frame
    std::uint32_t next_send_ = 0;
};

}  // namespace taktwerk::ecat
