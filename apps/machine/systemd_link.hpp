#pragma once
// What the service manager that started this process hears of it: that the bus is operational, how it goes, that the cycle advances, that it ends.
// The protocol is sd_notify(3)'s, a datagram a message; libsystemd's own call may wait for the manager, which the service thread must not.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "apps/machine/datagram_out.hpp"
#include "core/time.hpp"

namespace taktwerk::apps {

/// One thread.
class SystemdLink {
public:
    using Environment = std::function<const char*(const char*)>;

    /// From $NOTIFY_SOCKET, $WATCHDOG_USEC and $WATCHDOG_PID; without them everything here does nothing.
    explicit SystemdLink(const Environment& environment);

    [[nodiscard]] bool present() const noexcept { return out_.open(); }
    /// Its time for a sign of life; nothing: it wants none.
    [[nodiscard]] std::optional<Duration> watchdog() const noexcept { return watchdog_; }

    /// Before ready(): it goes on, and wants so much more time. Said about each second.
    void starting(Instant now, std::string_view status);
    /// Once: from here on who waited for this service goes on, and signs of life are expected.
    void ready();
    /// One line for `systemctl status`; said when it is another.
    void status(std::string_view line);
    /// The watchdog is fed when `cycles` is another number than before, four times within its time: a cycle that stands still is no life, whatever
    /// else runs.
    void alive(Instant now, std::uint64_t cycles);
    /// Once.
    void stopping();

private:
    DatagramOut out_;
    std::optional<Duration> watchdog_;
    std::string status_;
    std::uint64_t cycles_ = 0;
    Instant fed_{}, extended_{};
    bool ready_ = false, stopping_ = false, fed_once_ = false, extended_once_ = false;
};

}  // namespace taktwerk::apps
