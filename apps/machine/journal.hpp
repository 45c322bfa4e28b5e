#pragma once
// The machine's log in the system's journal, each entry with fields of its own: `journalctl TAKTWERK_ALARM=drive_fault`, `TAKTWERK_AXIS=x`, `-p err`.
// The journal's native protocol (systemd.io/JOURNAL_NATIVE_PROTOCOL), a datagram an entry: nothing here waits, as libsystemd's own call may.

#include <functional>
#include <string>
#include <string_view>

#include "apps/machine/datagram_out.hpp"
#include "apps/machine/log_entry.hpp"

namespace taktwerk::apps {

class Journal {
public:
    static constexpr std::string_view usual_address = "/run/systemd/journal/socket";

    explicit Journal(std::string machine, std::string_view address = usual_address) : machine_(std::move(machine)), out_(address) {}

    /// Any thread. False: nobody took it, and it has to be said in another way.
    bool take(const LogEntry& entry) const;

private:
    std::string machine_;
    DatagramOut out_;
};

/// The entry as the protocol wants it. PRIORITY as syslog has it: 3 what stops something, 4 a warning, 5 what a person should read, 6 else.
/// MESSAGE_ID is one for each kind of event (docs/service.md).
[[nodiscard]] std::string journal_fields(const std::string& machine, const LogEntry& entry);

/// Standard output is the journal's, by $JOURNAL_STREAM (systemd.exec(5)).
[[nodiscard]] bool output_is_journal(const char* journal_stream) noexcept;

}  // namespace taktwerk::apps
