#include "ecat/bringup/al_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace taktwerk::ecat {

namespace {

constexpr Duration state_poll_period = std::chrono::milliseconds{1};
constexpr std::uint32_t fresh_cycles = 1;

std::uint16_t code_of(const BusSlave& slave) noexcept { return static_cast<std::uint16_t>(slave.link.al.load() >> 16); }

/// Bytes of the PDOs that the slave says it has in a sync manager; a PDO that names none is in the first of its direction.
std::optional<std::uint16_t> mapped_bytes(const BusSlave& slave, std::uint8_t number) {
    if (slave.rx.empty() && slave.tx.empty()) return std::nullopt;
    const auto& managers = slave.device().sync_managers;
    const auto first_of = [&](SmUse use) {
        const auto it = std::find_if(managers.begin(), managers.end(), [&](const SyncManagerDescription& sm) { return sm.use == use; });
        return static_cast<std::uint8_t>(it - managers.begin());
    };
    std::size_t bits = 0;
    for (const auto& pdo : slave.rx)
        if (pdo.sync_manager.value_or(first_of(SmUse::outputs)) == number) bits += mapped_bits({&pdo, 1});
    for (const auto& pdo : slave.tx)
        if (pdo.sync_manager.value_or(first_of(SmUse::inputs)) == number) bits += mapped_bits({&pdo, 1});
    return static_cast<std::uint16_t>((bits + 7) / 8);
}

/// What was planned for a state: the mailbox for PREOP, the process data from SAFEOP on.
void note_plan(const Bus& bus, const BusSlave& slave, Refusal& refusal) {
    const auto& sii = slave.found.sii;
    const auto sii_bytes = [&](std::uint8_t n) -> std::optional<std::uint16_t> {
        if (n >= sii.sync_managers.size()) return std::nullopt;
        return sii.sync_managers[n].length;
    };
    if (slave.mailbox.in_size != 0) {
        SyncManager sm;
        sm.activate = SyncManager::enable;
        sm.start = slave.mailbox.out_start, sm.length = slave.mailbox.out_size, sm.control = SyncManager::usual_mailbox_out;
        refusal.sync_managers.push_back({slave.mailbox.out_sm, sm, {}, {}, sii_bytes(slave.mailbox.out_sm)});
        sm.start = slave.mailbox.in_start, sm.length = slave.mailbox.in_size, sm.control = SyncManager::usual_mailbox_in;
        refusal.sync_managers.push_back({slave.mailbox.in_sm, sm, {}, {}, sii_bytes(slave.mailbox.in_sm)});
    }
    if (refusal.asked < AlState::safeop || slave.index >= bus.plan.slaves.size()) return;
    const auto& plan = bus.plan.slaves[slave.index];
    for (const auto& sm : plan.sync_managers)
        refusal.sync_managers.push_back({sm.number, sm.registers, {}, mapped_bytes(slave, sm.number), sii_bytes(sm.number)});
    for (std::size_t n = 0; n < plan.fmmus.size(); ++n) refusal.fmmus.push_back({static_cast<std::uint8_t>(n), plan.fmmus[n], {}});
}

Script<void> read_back(Bus& bus, const BusSlave& slave, Refusal& refusal) {
    const std::uint16_t station = slave.found.station;
    if (!refusal.sync_managers.empty()) {
        std::size_t count = 0;
        for (const auto& sm : refusal.sync_managers) count = std::max<std::size_t>(count, sm.number + 1u);
        const Reply reply = co_await bus.port.fprd(station, reg::sync_manager, count * SyncManager::size);
        if (reply.ok())
            for (auto& sm : refusal.sync_managers)
                sm.found = decode_sync_manager(std::span{reply.data}.subspan(sm.number * SyncManager::size).first<SyncManager::size>());
    }
    if (!refusal.fmmus.empty()) {
        const Reply reply = co_await bus.port.fprd(station, reg::fmmu, refusal.fmmus.size() * Fmmu::size);
        if (reply.ok())
            for (auto& fmmu : refusal.fmmus)
                fmmu.found = decode_fmmu(std::span{reply.data}.subspan(fmmu.number * Fmmu::size).first<Fmmu::size>());
    }
    if (refusal.asked < AlState::safeop) co_return;
    const Reply watchdog = co_await bus.port.fprd(station, reg::sm_watchdog_time, 2);
    if (watchdog.ok()) refusal.sm_watchdog_ticks = watchdog.u16();
    if (!refusal.clock.configured) co_return;
    const Reply activation = co_await bus.port.fprd(station, reg::dc_activation, 1);
    if (activation.ok()) refusal.clock.activation = static_cast<std::uint8_t>(activation.data[0]);
    const Reply cycle = co_await bus.port.fprd(station, reg::dc_sync0_cycle, 4);
    if (cycle.ok()) refusal.clock.sync0_cycle = Duration{cycle.u32()};
    const Reply difference = co_await bus.port.fprd(station, reg::dc_difference, 4);
    if (difference.ok()) refusal.clock.difference_ns = std::abs(static_cast<std::int64_t>(dc_difference_ns(difference.u32())));
}

/// Keeps the refusal and makes the error of it.
Script<Result<void>> refused(Bus& bus, BusSlave& slave, AlState target, Duration waited, bool timed_out) {
    Refusal refusal = co_await read_refusal(bus, slave, target);
    refusal.waited = waited;
    refusal.timed_out = timed_out;
    judge(refusal);
    slave.refusal = std::move(refusal);
    co_return refusal_error(*slave.refusal);
}

}  // namespace

Duration state_timeout(const StateTimeouts& timeouts, AlState target) noexcept {
    switch (target) {
        case AlState::preop: return timeouts.preop;
        case AlState::safeop: return timeouts.safeop;
        case AlState::op: return timeouts.op;
        default: return timeouts.down;
    }
}

Script<Result<std::uint16_t>> read_al_status(Bus& bus, BusSlave& slave) {
    const Reply reply = co_await bus.port.fprd(slave.found.station, reg::al_status, 6);
    if (!reply.ok()) co_return unanswered(slave.subject, "AL status (0130h)", reply);
    const std::uint16_t status = reply.u16();
    slave.link.al.store(status | (std::uint32_t{reply.u16(4)} << 16));
    co_return status;
}

Script<Refusal> read_refusal(Bus& bus, BusSlave& slave, AlState asked) {
    Refusal refusal;
    refusal.subject = slave.subject;
    refusal.asked = asked;
    refusal.status = static_cast<std::uint16_t>(slave.link.al.load());
    refusal.reached = al_state(refusal.status);
    refusal.code = code_of(slave);
    refusal.last_abort = slave.last_abort;
    refusal.valid_outputs = bus.link.good_in_a_row.load() >= fresh_cycles;
    refusal.clock.supported = slave.device().dc.supported;
    refusal.clock.required = slave.device().dc.required;
    refusal.clock.configured = slave.config->dc;
    refusal.clock.started = slave.link.sync0_start.load() != 0;
    refusal.clock.bus_cycle = bus.config.cycle;
    note_plan(bus, slave, refusal);
    co_await read_back(bus, slave, refusal);
    judge(refusal);
    co_return refusal;
}

namespace {

/// A slave whose firmware has not read the last AL control yet does not take the next (ETG.1000.4: the register is locked until
/// the application has read it): asked again until `deadline`. The last reply.
Script<Reply> write_al_control(Bus& bus, const BusSlave& slave, std::uint16_t control, Instant deadline) {
    for (;;) {
        Reply written = co_await bus.port.fpwr(slave.found.station, reg::al_control, control);
        const Instant now = co_await time();
        if (written.lost || written.wkc != 0 || now >= deadline) co_return written;
        co_await pause(state_poll_period);
    }
}

}  // namespace

Script<Result<void>> set_state(Bus& bus, BusSlave& slave, AlState target) {
    Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();
    const Instant started = co_await time();
    const bool down = target < al_state(*status);
    const auto& timeouts = bus.config.state_timeouts;
    const Duration patience = down ? timeouts.down : state_timeout(timeouts, target);
    const std::string from{name(al_state(*status))};
    bus.note(slave, fmt::format("{} -> {}", from, name(target)));

    if ((*status & al_status_error) != 0) {
        const auto acknowledge = static_cast<std::uint16_t>((*status & al_state_mask) | al_control_acknowledge);
        const Reply written = co_await write_al_control(bus, slave, acknowledge, started + timeouts.down);
        if (written.lost) co_return unanswered(slave.subject, "AL control (0120h)", written);
        for (;;) {
            co_await pause(state_poll_period);
            status = co_await read_al_status(bus, slave);
            if (!status) co_return status.error();
            if ((*status & al_status_error) == 0) break;
            const Instant now = co_await time();
            if (now - started >= timeouts.down) co_return co_await refused(bus, slave, target, now - started, false);
        }
    }
    if (al_state(*status) == target) {
        slave.refusal.reset();
        co_return Result<void>{};
    }

    const auto control = static_cast<std::uint16_t>(target);
    const Reply written = co_await write_al_control(bus, slave, control, started + patience);
    if (written.lost) co_return unanswered(slave.subject, "AL control (0120h)", written);
    for (;;) {
        status = co_await read_al_status(bus, slave);
        if (!status) co_return status.error();
        const Instant now = co_await time();
        if ((*status & al_status_error) != 0) co_return co_await refused(bus, slave, target, now - started, false);
        if (al_state(*status) == target) break;
        if (now - started >= patience) co_return co_await refused(bus, slave, target, now - started, true);
        co_await pause(state_poll_period);
    }
    slave.refusal.reset();
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
