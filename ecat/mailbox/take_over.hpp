#pragma once
// A mailbox that somebody else spoke through before: a command that was killed, another tool. Service side.

#include "core/result.hpp"
#include "ecat/mailbox/mailbox_client.hpp"

namespace taktwerk::ecat {

/// Reads out what was left in it, and makes the slave forget the counter it saw last: a slave drops a message with that counter as a
/// repetition, and with it the first request of whoever comes new. What is sent for it no slave knows (VoE of vendor 0), and it says so.
[[nodiscard]] Script<Result<void>> take_over(DatagramPort& port, MailboxEndpoint& mailbox);

}  // namespace taktwerk::ecat
