#include "ecat/eeprom/eeprom_write.hpp"

#include <array>

#include <fmt/format.h>

#include "ecat/bringup/sii_reader.hpp"
#include "ecat/eeprom/sii_fields.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration busy_poll = std::chrono::microseconds{200};
constexpr std::uint8_t for_master = 0, for_pdi = 1, force_release = 2;  // 0500h
constexpr std::uint16_t held_by_pdi = 0x0101;                           // bit 0 of 0500h, bit 0 of 0501h

Error not_written(const std::string& subject, std::size_t word, std::string what) {
    return {"bus.eeprom_write", subject, fmt::format("EEPROM word {:04X}h cannot be written: {}", word, what),
            "power-cycle the slave and try again; if it stays, its EEPROM is write-protected or defective"};
}

/// 0502h once it is not busy.
Script<Result<std::uint16_t>> when_idle(DatagramPort& port, std::uint16_t station, std::size_t word, std::string subject) {
    Instant started = co_await time();
    for (;;) {
        const Reply reply = co_await port.fprd(station, reg::eeprom_control, 2);
        if (!reply.ok()) co_return unanswered(subject, "EEPROM (0502h)", reply);
        started += reply.queued;
        if ((reply.u16() & eeprom::busy) == 0) co_return reply.u16();
        const Instant now = co_await time();
        if (now - started >= eeprom_busy_limit)
            co_return not_written(subject, word,
                                  fmt::format("the EEPROM stays busy for {} ms", (now - started) / std::chrono::milliseconds{1}));
        co_await pause(busy_poll);
    }
}

/// Data, then command with address and enable bit, which counts only in the same access. The bits that are left when it is done.
Script<Result<std::uint16_t>> write_once(DatagramPort& port, std::uint16_t station, const SiiWordChange change, std::string subject) {
    const Result<std::uint16_t> idle = co_await when_idle(port, station, change.word, subject);
    if (!idle) co_return idle.error();
    const Reply data = co_await port.fpwr(station, reg::eeprom_data, change.to);
    if (!data.ok()) co_return unanswered(subject, "EEPROM data (0508h)", data);
    std::vector<std::byte> command(6);
    store_le(command, 0, static_cast<std::uint16_t>(eeprom::write | eeprom::write_enable));
    store_le(command, 2, static_cast<std::uint32_t>(change.word));
    const Reply asked = co_await port.fpwr(station, reg::eeprom_control, command);
    if (!asked.ok()) co_return unanswered(subject, "EEPROM (0502h)", asked);
    co_return co_await when_idle(port, station, change.word, subject);
}

Script<Result<void>> write_word(DatagramPort& port, std::uint16_t station, const SiiWordChange change, std::string subject) {
    std::uint16_t control = 0;
    for (unsigned attempt = 0; attempt < eeprom_attempts; ++attempt) {
        if (attempt > 0) co_await pause(eeprom_retry_period);
        const Result<std::uint16_t> done = co_await write_once(port, station, change, subject);
        if (!done) co_return done.error();
        control = *done;
        if ((control & (eeprom::command_error | eeprom::write_enable_error)) == 0) co_return Result<void>{};
    }
    const bool enable = (control & eeprom::write_enable_error) != 0;
    co_return not_written(subject, change.word,
                          fmt::format("{} (0502h = {:04X}h, {} attempts)",
                                      enable ? "the controller says that writing is not enabled" : "the memory does not acknowledge",
                                      control, eeprom_attempts));
}

/// From the last word to the first.
Script<Result<void>> write_words(DatagramPort& port, std::uint16_t station, const std::vector<SiiWordChange> changes, std::string subject,
                                 std::size_t& written) {
    for (auto change = changes.rbegin(); change != changes.rend(); ++change) {
        const Result<void> done = co_await write_word(port, station, *change, subject);
        if (!done) co_return done;
        ++written;
    }
    co_return Result<void>{};
}

/// What is there and what should be.
Script<Result<std::vector<SiiWordChange>>> missing_words(DatagramPort& port, std::uint16_t station, const std::vector<std::byte>& wanted,
                                                         std::string subject) {
    const Result<std::vector<std::byte>> there = co_await read_eeprom(port, station, subject, wanted.size() / 2);
    if (!there) co_return there.error();
    co_return sii_changes(*there, wanted);
}

Script<Result<void>> write_and_verify(DatagramPort& port, std::uint16_t station, const std::vector<SiiWordChange> changes,
                                      const std::vector<std::byte>& wanted, std::string subject, std::size_t& written) {
    const Result<void> done = co_await write_words(port, station, changes, subject, written);
    if (!done) co_return done;
    const Result<std::vector<SiiWordChange>> missing = co_await missing_words(port, station, wanted, subject);
    if (!missing) co_return missing.error();
    if (missing->empty()) co_return Result<void>{};
    const auto& first = missing->front();
    co_return Error{
        "bus.eeprom_verify", subject,
        fmt::format("EEPROM word {:04X}h ({}) was written as {:04X}h and reads {:04X}h{}", first.word, sii_field(wanted, first.word),
                    first.to, first.from, missing->size() == 1 ? std::string{} : fmt::format("; {} words are wrong", missing->size())),
        "its EEPROM is write-protected, worn out, or smaller than its word 003Eh says"};
}

}  // namespace

Script<Result<void>> take_eeprom(DatagramPort& port, std::uint16_t station, std::string subject) {
    Reply owner = co_await port.fprd(station, reg::eeprom_configuration, 2);
    if (!owner.ok()) co_return unanswered(subject, "the owner of its EEPROM (0500h)", owner);
    if ((owner.u16() & held_by_pdi) == 0) co_return Result<void>{};
    constexpr std::array steps{force_release, for_master};
    for (const std::uint8_t step : steps) {
        const Reply written = co_await port.fpwr(station, reg::eeprom_configuration, step);
        if (!written.ok()) co_return unanswered(subject, "the owner of its EEPROM (0500h)", written);
    }
    owner = co_await port.fprd(station, reg::eeprom_configuration, 2);
    if (!owner.ok()) co_return unanswered(subject, "the owner of its EEPROM (0500h)", owner);
    if ((owner.u16() & held_by_pdi) == 0) co_return Result<void>{};
    co_return Error{"bus.sii_taken", subject,
                    fmt::format("its own processor does not let go of the EEPROM (0500h = {:02X}h, 0501h = {:02X}h)", owner.u16() & 0xFFu,
                                owner.u16() >> 8),
                    "power-cycle the slave, and try again while it is in INIT"};
}

Script<Result<void>> give_eeprom_back(DatagramPort& port, std::uint16_t station, std::string subject) {
    const Reply written = co_await port.fpwr(station, reg::eeprom_configuration, for_pdi);
    if (!written.ok()) co_return unanswered(subject, "the owner of its EEPROM (0500h)", written);
    co_return Result<void>{};
}

Script<Result<EepromWriting>> write_eeprom(DatagramPort& port, std::uint16_t station, std::vector<std::byte> before,
                                           std::vector<std::byte> after, std::string subject) {
    const Result<void> taken = co_await take_eeprom(port, station, subject);
    if (!taken) co_return taken.error();
    EepromWriting out;
    std::vector<SiiWordChange> changes = sii_changes(before, after);
    const Result<void> done = co_await write_and_verify(port, station, changes, after, subject, out.words);
    if (done) co_return out;
    out.failure = done.error();
    // Nothing can be put back where nobody answers, and each attempt would wait for its time again.
    const Result<std::vector<SiiWordChange>> lost = co_await missing_words(port, station, before, subject);
    if (!lost) co_return out;
    changes = *lost;
    std::size_t ignored = 0;
    const Result<void> back = co_await write_and_verify(port, station, changes, before, subject, ignored);
    out.restored = static_cast<bool>(back);
    co_return out;
}

}  // namespace taktwerk::ecat
