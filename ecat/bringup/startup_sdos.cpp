#include "ecat/bringup/startup_sdos.hpp"

#include <fmt/format.h>

#include "ecat/bringup/slave_objects.hpp"

namespace taktwerk::ecat {

namespace {

std::vector<std::byte> encode_value(DataType type, std::int64_t value) {
    std::vector<std::byte> bytes((bit_size(type) + 7u) / 8u);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::byte>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xFFu);
    return bytes;
}

std::string hex(const std::vector<std::byte>& bytes) {
    std::string text;
    for (auto it = bytes.rbegin(); it != bytes.rend(); ++it) text += fmt::format("{:02X}", static_cast<unsigned>(*it));
    return text + "h";
}

Script<Result<void>> write_one(Bus& bus, BusSlave& slave, const StartupSdo& sdo) {
    const std::string object = object_text(sdo.index, sdo.sub);
    bus.note(slave, "start-up: writing " + object);
    const std::vector<std::byte> value = encode_value(sdo.type, sdo.value);
    const auto with_origin = [&](Error error) {
        remember_abort(slave, error);
        if (!sdo.origin.empty()) error.what += fmt::format(" (start-up list, {})", sdo.origin);
        return error;
    };
    if (sdo.if_changed) {
        const Result<std::vector<std::byte>> present = co_await sdo_upload(bus.port, slave.mailbox, sdo.index, sdo.sub);
        if (!present) co_return with_origin(present.error());
        if (*present == value) co_return Result<void>{};
    }
    const Result<void> written = co_await sdo_download(bus.port, slave.mailbox, sdo.index, sdo.sub, value);
    if (!written) co_return with_origin(written.error());
    if (sdo.verify) {
        const Result<std::vector<std::byte>> back = co_await sdo_upload(bus.port, slave.mailbox, sdo.index, sdo.sub);
        if (!back) co_return with_origin(back.error());
        if (*back != value)
            co_return with_origin(Error{"bus.startup_verify", slave.subject,
                                        fmt::format("{} reads back {} after {} was written", object, hex(*back), hex(value)),
                                        "the drive limits or rounds the value: write what it can hold, or set verify: false"});
    }
    co_return Result<void>{};
}

Script<Result<void>> write_startup(Bus& bus, BusSlave& slave, Transition transition) {
    for (const auto& sdo : slave.config->startup) {
        if (sdo.at != transition) continue;
        const std::string abort_before = slave.last_abort;
        const Result<void> written = co_await write_one(bus, slave, sdo);
        if (!written && sdo.if_there && (written.error().code == "sdo.abort" || written.error().code == "bus.startup_verify")) {
            bus.remember(fmt::format("{}: {}; it goes on without", slave.subject, written.error().what));
            slave.last_abort = abort_before;
            continue;
        }
        if (!written) co_return written.error();
    }
    co_return Result<void>{};
}

}  // namespace

Script<Result<void>> write_startup_safeop(Bus& bus, BusSlave& slave) { return write_startup(bus, slave, Transition::PreopToSafeop); }
Script<Result<void>> write_startup_op(Bus& bus, BusSlave& slave) { return write_startup(bus, slave, Transition::SafeopToOp); }

}  // namespace taktwerk::ecat
