#include "ecat/diagnosis/mailbox_access.hpp"

#include <fmt/format.h>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/mailbox_setup.hpp"
#include "ecat/mailbox/take_over.hpp"

namespace taktwerk::ecat {

namespace {

bool is(const Result<void>& result, const char* code) { return !result && result.error().code == code; }

}  // namespace

Script<Result<void>> open_mailbox(Bus& bus, BusSlave& slave) {
    if (!slave.has_coe())
        co_return Error{"sdo.no_mailbox", slave.subject, "has no CoE mailbox: it has no objects to read or write",
                        "its process data is fixed; see `taktwerk bus pdo`"};
    co_return co_await open_mailbox_for(bus, slave, MailboxType::coe);
}

Script<Result<void>> open_mailbox_for(Bus& bus, BusSlave& slave, MailboxType protocol) {
    const char* code = protocol == MailboxType::foe ? "foe.no_mailbox" : protocol == MailboxType::eoe ? "eoe.no_mailbox" : "sdo.no_mailbox";
    if (!slave.has_mailbox())
        co_return Error{code, slave.subject, fmt::format("has no mailbox, and so no {}", name(protocol)),
                        "check that this is the slave you mean: taktwerk bus scan"};
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();
    const AlState state = al_state(*status);
    if (state == AlState::init || state == AlState::unknown) co_return co_await enter_preop(bus, slave);
    if (state == AlState::boot && protocol != MailboxType::foe)
        co_return Error{code, slave.subject, fmt::format("is in BOOT: it takes firmware, and speaks no {}", name(protocol)),
                        "take it to INIT, then try again"};

    const Result<bool> found = co_await find_mailboxes(bus, slave);
    if (!found) co_return found.error();
    if (!*found)
        co_return Error{code, slave.subject, "its mailbox sync managers are not set up, although it is beyond INIT",
                        "take it to INIT first: taktwerk bus state init"};
    if (protocol == MailboxType::coe) co_return Result<void>{};  // read_object() and write_object() ask twice
    co_return co_await take_over(bus.port, slave.mailbox);
}

Script<Result<std::vector<std::byte>>> read_object(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub, SdoAccess access) {
    const bool first = slave.mailbox.counter == 0;
    Result<std::vector<std::byte>> value = co_await sdo_upload(bus.port, slave.mailbox, index, sub, access);
    if (!value && first && value.error().code == "sdo.timeout") value = co_await sdo_upload(bus.port, slave.mailbox, index, sub, access);
    co_return value;
}

Script<Result<void>> write_object(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub, std::vector<std::byte> value,
                                  SdoAccess access) {
    const bool first = slave.mailbox.counter == 0;
    Result<void> written = co_await sdo_download(bus.port, slave.mailbox, index, sub, value, access);
    if (first && is(written, "sdo.timeout")) written = co_await sdo_download(bus.port, slave.mailbox, index, sub, value, access);
    co_return written;
}

}  // namespace taktwerk::ecat
