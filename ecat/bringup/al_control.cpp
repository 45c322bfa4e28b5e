#include "ecat/bringup/al_control.hpp"

#include <fmt/format.h>

namespace taktwerk::ecat {

namespace {

constexpr Duration state_poll_period = std::chrono::milliseconds{1};

/// What was configured, for the one message that must be enough.
std::string configuration_text(const Bus& bus, const BusSlave& slave) {
    std::string text;
    if (slave.index < bus.plan.slaves.size())
        for (const auto& sm : bus.plan.slaves[slave.index].sync_managers)
            text += fmt::format("; SM{} is {} bytes at {:04X}h", sm.number, sm.registers.length, sm.registers.start);
    if (slave.config->dc) {
        const double cycle_ms = to_seconds(bus.config.cycle) * 1e3;
        text += slave.sync0_start.load() != 0 ? fmt::format("; SYNC0 every {} ms", cycle_ms) : std::string{"; SYNC0 not started"};
    } else if (slave.device().dc.supported) {
        text += "; SYNC0 not used";
    }
    if (!slave.last_abort.empty()) text += "; last SDO abort: " + slave.last_abort;
    return text;
}

Error refused(const Bus& bus, const BusSlave& slave, AlState target, std::uint16_t code) {
    const auto& info = al_status_info(code);
    return Error{"bus.refused_state", slave.subject,
                 fmt::format("refused {}: 0x{:04X} {}{}", name(target), code, info.text,
                             target >= AlState::safeop ? configuration_text(bus, slave) : ""),
                 std::string{info.remedy}};
}

Error timed_out(const Bus& bus, const BusSlave& slave, AlState target, std::uint16_t status, std::uint16_t code) {
    return Error{"bus.state_timeout", slave.subject,
                 fmt::format("did not reach {} within {} s: it stays in {} without an error (status 0x{:04X}, code 0x{:04X} {}){}",
                             name(target), state_timeout(target) / std::chrono::seconds{1}, name(al_state(status)), status, code,
                             al_status_info(code).text, configuration_text(bus, slave)),
                 target == AlState::op ? "it may be waiting for valid outputs or for SYNC0: check that the cycle runs"
                                       : "power-cycle the slave; if it stays, check its firmware"};
}

std::uint16_t code_of(const BusSlave& slave) noexcept { return static_cast<std::uint16_t>(slave.al.load() >> 16); }

}  // namespace

Duration state_timeout(AlState target) noexcept {
    switch (target) {
        case AlState::preop: return std::chrono::seconds{3};
        case AlState::safeop:
        case AlState::op: return std::chrono::seconds{10};
        default: return std::chrono::seconds{5};
    }
}

Script<Result<std::uint16_t>> read_al_status(Bus& bus, BusSlave& slave) {
    const Reply reply = co_await bus.port.fprd(slave.found.station, reg::al_status, 6);
    if (!reply.ok()) co_return unanswered(slave.subject, "AL status (0130h)", reply);
    const std::uint16_t status = reply.u16();
    slave.al.store(status | (std::uint32_t{reply.u16(4)} << 16));
    co_return status;
}

Script<Result<void>> set_state(Bus& bus, BusSlave& slave, AlState target) {
    Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();
    const Instant started = co_await time();
    const Instant deadline = started + state_timeout(target);
    const std::string from{name(al_state(*status))};
    bus.note(slave, fmt::format("{} -> {}", from, name(target)));

    if ((*status & al_status_error) != 0) {
        const auto acknowledge = static_cast<std::uint16_t>((*status & al_state_mask) | al_control_acknowledge);
        const Reply written = co_await bus.port.fpwr(slave.found.station, reg::al_control, acknowledge);
        if (!written.ok()) co_return unanswered(slave.subject, "AL control (0120h)", written);
        for (;;) {
            co_await pause(state_poll_period);
            status = co_await read_al_status(bus, slave);
            if (!status) co_return status.error();
            if ((*status & al_status_error) == 0) break;
            const Instant now = co_await time();
            if (now >= deadline) co_return refused(bus, slave, target, code_of(slave));
        }
    }
    if (al_state(*status) == target) co_return Result<void>{};

    const auto control = static_cast<std::uint16_t>(target);
    const Reply written = co_await bus.port.fpwr(slave.found.station, reg::al_control, control);
    if (!written.ok()) co_return unanswered(slave.subject, "AL control (0120h)", written);
    for (;;) {
        status = co_await read_al_status(bus, slave);
        if (!status) co_return status.error();
        if ((*status & al_status_error) != 0) co_return refused(bus, slave, target, code_of(slave));
        if (al_state(*status) == target) co_return Result<void>{};
        const Instant now = co_await time();
        if (now >= deadline) co_return timed_out(bus, slave, target, *status, code_of(slave));
        co_await pause(state_poll_period);
    }
}

}  // namespace taktwerk::ecat
