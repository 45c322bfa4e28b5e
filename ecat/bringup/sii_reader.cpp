#include "ecat/bringup/sii_reader.hpp"

#include <fmt/format.h>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration sii_timeout = std::chrono::seconds{1};
constexpr Duration sii_poll_period = std::chrono::microseconds{200};

Error sii_error(const std::string& subject, std::uint16_t word, const char* what) {
    return Error{"bus.sii", subject, fmt::format("EEPROM word {:04X}h cannot be read: {}", word, what),
                 "power-cycle the slave; if it stays, its EEPROM is empty or defective"};
}

}  // namespace

Script<Result<std::uint32_t>> read_sii(DatagramPort& port, std::uint16_t station, std::uint16_t word, const std::string& subject) {
    const Instant started = co_await time();
    const Instant deadline = started + sii_timeout;
    std::vector<std::byte> request(6);
    store_le(request, 0, eeprom::read);
    store_le(request, 2, std::uint32_t{word});
    bool asked = false;
    for (;;) {
        const Reply reply = co_await port.fprd(station, reg::eeprom_control, 14);
        if (!reply.ok()) co_return unanswered(subject, "EEPROM (0502h)", reply);
        const std::uint16_t control = reply.u16();
        const bool busy = (control & eeprom::busy) != 0;
        const bool refused = (control & (eeprom::command_error | eeprom::write_enable_error)) != 0;
        if (!busy && asked && !refused && reply.u32(2) == word) co_return reply.u32(6);
        const Instant now = co_await time();
        if (now >= deadline) co_return sii_error(subject, word, busy ? "the EEPROM stays busy" : "the controller reports an error");
        if (!busy) {
            if (asked) co_await pause(sii_poll_period);
            const Reply written = co_await port.fpwr(station, reg::eeprom_control, request);
            if (!written.ok()) co_return unanswered(subject, "EEPROM (0502h)", written);
            asked = true;
        } else {
            co_await pause(sii_poll_period);
        }
    }
}

}  // namespace taktwerk::ecat
