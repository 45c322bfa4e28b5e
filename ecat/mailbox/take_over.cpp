#include "ecat/mailbox/take_over.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration until_it_has_answered = std::chrono::milliseconds{20};
constexpr std::size_t voe_header = 6;  ///< vendor, type

}  // namespace

Script<Result<void>> take_over(DatagramPort& port, MailboxEndpoint& mailbox) {
    const Result<void> emptied = co_await read_unasked(port, mailbox);
    if (!emptied) co_return emptied;
    MailboxRequest stranger;
    stranger.about = "taking over its mailbox";
    stranger.payload.resize(voe_header);
    stranger.type = MailboxType::voe;
    {
        co_await mailbox.lock.acquire();
        const ScriptLockGuard guard{mailbox.lock};
        const Result<void> told = co_await tell(port, mailbox, stranger);
        if (!told) co_return told;
    }
    co_await pause(until_it_has_answered);
    co_return co_await read_unasked(port, mailbox);
}

}  // namespace taktwerk::ecat
