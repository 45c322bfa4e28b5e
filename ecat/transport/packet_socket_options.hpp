#pragma once
// What a packet socket is asked for beyond moving frames. Every request may be refused, by an older kernel or for want of
// privilege: the socket then works without it, and the report says so once, in words. Not real-time: at opening only.
//
// The EtherType filter is the socket's binding to 88A4h: the kernel hands it nothing else.

#include <string>
#include <string_view>
#include <vector>

#include "core/clock.hpp"
#include "core/time.hpp"

namespace taktwerk::ecat {

struct RawSocketOptions {
    int priority = 7;              ///< SO_PRIORITY: 0..6 without privilege, 7 needs CAP_NET_ADMIN
    bool skip_queueing = true;     ///< PACKET_QDISC_BYPASS: straight to the driver. False: through tc, e.g. to shape a test
    bool exclusive = true;         ///< take the interface's lock; false only for a listener beside the master
    Duration busy_poll{};          ///< SO_BUSY_POLL, whole us: a receive looks into the NIC's queue itself. 0 = off; needs CAP_NET_ADMIN
    bool receive_stamps = true;    ///< arrival as the kernel saw it, else the time at which receive() asked
    bool send_stamps = false;      ///< measure how long frames take from send() to the driver; some us a frame in the kernel
    const Clock* clock = nullptr;  ///< reads the time at which a frame leaves; outlives the transport. Null: as send() was told
};

struct RawSocketReport {
    std::vector<std::string> refused;  ///< one a request: what, why, and what it costs
    std::string time_stamps;           ///< what the stamps are: "kernel, software", "none"; and whether hardware ones are offered
    bool sees_own_frames = false;      ///< outgoing frames come back through receive() and must be skipped
    bool stamps_receipt = false, stamps_sending = false;
};

/// Applies the options to an open packet socket.
[[nodiscard]] RawSocketReport apply(const RawSocketOptions& options, int socket, std::string_view interface);

}  // namespace taktwerk::ecat
