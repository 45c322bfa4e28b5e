#include "ecat/bringup/slave_setup.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/al_control.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration watchdog_tick = std::chrono::microseconds{100};  // divider 2498
constexpr Duration minimum_watchdog = std::chrono::milliseconds{10};

const SyncManagerDescription* find_sm(const DeviceDescription& device, SmUse use, std::uint8_t& number) {
    for (std::size_t n = 0; n < device.sync_managers.size(); ++n)
        if (device.sync_managers[n].use == use) {
            number = static_cast<std::uint8_t>(n);
            return &device.sync_managers[n];
        }
    return nullptr;
}

Script<Result<void>> write_sm(Bus& bus, BusSlave& slave, std::uint8_t number, SyncManager sm) {
    std::vector<std::byte> bytes(SyncManager::size);
    encode(sm, std::span<std::byte, SyncManager::size>{bytes});
    const Reply reply = co_await bus.port.fpwr(slave.found.station, reg::sync_manager_at(number), bytes);
    if (!reply.ok()) co_return unanswered(slave.subject, fmt::format("sync manager {}", number), reply);
    co_return Result<void>{};
}

Result<void> locate_mailbox(BusSlave& slave) {
    auto& mailbox = slave.mailbox;
    mailbox.subject = slave.subject;
    mailbox.station = slave.found.station;
    const auto* out = find_sm(slave.device(), SmUse::mailbox_out, mailbox.out_sm);
    const auto* in = find_sm(slave.device(), SmUse::mailbox_in, mailbox.in_sm);
    mailbox.out_start = out != nullptr && out->size != 0 ? out->start : slave.found.mailbox[0];
    mailbox.out_size = out != nullptr && out->size != 0 ? out->size : slave.found.mailbox[1];
    mailbox.in_start = in != nullptr && in->size != 0 ? in->start : slave.found.mailbox[2];
    mailbox.in_size = in != nullptr && in->size != 0 ? in->size : slave.found.mailbox[3];
    if (mailbox.out_size < 22 || mailbox.in_size < 22)  // header 6, SDO 10, and some
        return Error{"bus.no_mailbox", slave.subject,
                     fmt::format("its mailboxes are {} and {} bytes: neither profile nor EEPROM give usable sizes", mailbox.out_size,
                                 mailbox.in_size),
                     "enter the mailbox sync managers in its profile"};
    return {};
}

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

void remember_abort(BusSlave& slave, const Error& error) {
    if (error.code == "sdo.abort") slave.last_abort = error.what;
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
        const Result<void> written = co_await write_one(bus, slave, sdo);
        if (!written) co_return written.error();
    }
    co_return Result<void>{};
}

/// Writes an unsigned value of `bytes` bytes.
Script<Result<void>> write_number(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub, std::uint32_t value,
                                  std::size_t bytes) {
    std::vector<std::byte> data(bytes);
    for (std::size_t i = 0; i < bytes; ++i) data[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFu);
    bus.note(slave, "writing " + object_text(index, sub));
    const Result<void> written = co_await sdo_download(bus.port, slave.mailbox, index, sub, std::move(data));
    if (!written) remember_abort(slave, written.error());
    co_return written;
}

Script<Result<std::uint32_t>> read_number(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub) {
    const Result<std::vector<std::byte>> data = co_await sdo_upload(bus.port, slave.mailbox, index, sub);
    if (!data) {
        remember_abort(slave, data.error());
        co_return data.error();
    }
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, data->size()); ++i) value |= static_cast<std::uint32_t>((*data)[i]) << (8 * i);
    co_return value;
}

const PdoDescription* described(const std::vector<PdoDescription>& pdos, std::uint16_t index) {
    const auto it = std::find_if(pdos.begin(), pdos.end(), [&](const PdoDescription& p) { return p.index == index; });
    return it == pdos.end() ? nullptr : &*it;
}

Script<Result<void>> write_mapping(Bus& bus, BusSlave& slave, const PdoDescription& pdo) {
    Result<void> written = co_await write_number(bus, slave, pdo.index, 0, 0, 1);
    if (!written) co_return written;
    std::uint8_t sub = 0;
    for (const auto& entry : pdo.entries) {
        const std::uint32_t value = (std::uint32_t{entry.index} << 16) | (std::uint32_t{entry.sub} << 8) | entry.bits;
        written = co_await write_number(bus, slave, pdo.index, ++sub, value, 4);
        if (!written) co_return written;
    }
    co_return co_await write_number(bus, slave, pdo.index, 0, static_cast<std::uint32_t>(pdo.entries.size()), 1);
}

/// Which PDOs the slave has assigned, and which entries they have, in its own words.
Script<Result<std::vector<PdoDescription>>> read_assigned(Bus& bus, BusSlave& slave, std::uint16_t assignment) {
    bus.note(slave, fmt::format("reading the PDOs of {:04X}h", assignment));
    std::vector<PdoDescription> pdos;
    const Result<std::uint32_t> count = co_await read_number(bus, slave, assignment, 0);
    if (!count) co_return count.error();
    for (std::uint32_t i = 1; i <= (*count & 0xFFu); ++i) {
        const Result<std::uint32_t> index = co_await read_number(bus, slave, assignment, static_cast<std::uint8_t>(i));
        if (!index) co_return index.error();
        PdoDescription pdo;
        pdo.index = static_cast<std::uint16_t>(*index);
        const Result<std::uint32_t> entries = co_await read_number(bus, slave, pdo.index, 0);
        if (!entries) co_return entries.error();
        for (std::uint32_t k = 1; k <= (*entries & 0xFFu); ++k) {
            const Result<std::uint32_t> entry = co_await read_number(bus, slave, pdo.index, static_cast<std::uint8_t>(k));
            if (!entry) co_return entry.error();
            pdo.entries.push_back(
                {static_cast<std::uint16_t>(*entry >> 16), static_cast<std::uint8_t>(*entry >> 8), static_cast<std::uint8_t>(*entry)});
        }
        pdos.push_back(std::move(pdo));
    }
    co_return pdos;
}

std::string entry_text(const PdoEntry& entry) {
    return entry.index == 0 ? fmt::format("gap/{}", entry.bits) : fmt::format("{}/{}", object_text(entry.index, entry.sub), entry.bits);
}

/// What was asked for and what the slave says, compared; the message shows the first difference and both sizes.
Result<void> compare(const BusSlave& slave, std::uint16_t assignment, const std::vector<PdoDescription>& wanted,
                     const std::vector<PdoDescription>& got) {
    const auto mismatch = [&](std::string what) {
        return Error{
            "bus.pdo_mismatch", slave.subject,
            fmt::format("{}; configured are {} bytes, the slave has {}", std::move(what), (mapped_bits(wanted) + 7) / 8,
                        (mapped_bits(got) + 7) / 8),
            "choose a PDO this firmware offers with exactly these entries, or correct the PDO in the profile to what the slave reports"};
    };
    for (std::size_t i = 0; i < std::max(wanted.size(), got.size()); ++i) {
        if (i >= got.size()) return mismatch(fmt::format("{:04X}h was not assigned to {:04X}h", wanted[i].index, assignment));
        if (i >= wanted.size())
            return mismatch(fmt::format("the slave has {:04X}h assigned to {:04X}h in addition", got[i].index, assignment));
        if (wanted[i].index != got[i].index)
            return mismatch(fmt::format("{:04X}h holds {:04X}h, not {:04X}h", assignment, got[i].index, wanted[i].index));
        const auto& a = wanted[i].entries;
        const auto& b = got[i].entries;
        for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
            if (k < a.size() && k < b.size() && a[k] == b[k]) continue;
            return mismatch(fmt::format("entry {} of {:04X}h is {} in the slave, configured is {}", k + 1, wanted[i].index,
                                        k < b.size() ? entry_text(b[k]) : "missing", k < a.size() ? entry_text(a[k]) : "nothing"));
        }
    }
    return {};
}

Script<Result<void>> assign_direction(Bus& bus, BusSlave& slave, SmUse use) {
    const bool outputs = use == SmUse::outputs;
    const auto& device = slave.device();
    const auto& wanted = outputs ? slave.config->rx.assigned : slave.config->tx.assigned;
    const auto& known = outputs ? device.rx_pdos : device.tx_pdos;
    auto& effective = outputs ? slave.rx : slave.tx;
    std::uint8_t sm = 0;
    if (find_sm(device, use, sm) == nullptr) {
        effective.clear();
        co_return Result<void>{};
    }
    const auto assignment = static_cast<std::uint16_t>(0x1C10 + sm);

    if (!wanted.empty()) {
        Result<void> written = co_await write_number(bus, slave, assignment, 0, 0, 1);
        if (!written) co_return written;
        for (const auto& pdo : wanted) {
            const auto* own = described(known, pdo.index);
            if (pdo.fixed || pdo.entries.empty() || (own != nullptr && own->fixed)) continue;
            written = co_await write_mapping(bus, slave, pdo);
            if (!written) co_return written;
        }
        std::uint8_t sub = 0;
        for (const auto& pdo : wanted) {
            written = co_await write_number(bus, slave, assignment, ++sub, pdo.index, 2);
            if (!written) co_return written;
        }
        written = co_await write_number(bus, slave, assignment, 0, static_cast<std::uint32_t>(wanted.size()), 1);
        if (!written) co_return written;
    }

    // Never assumed: manuals contradict themselves about entries and defaults; offsets come from what the slave says.
    Result<std::vector<PdoDescription>> got = co_await read_assigned(bus, slave, assignment);
    if (!got) co_return got.error();
    if (!wanted.empty()) {
        std::vector<PdoDescription> expected = wanted;
        for (auto& pdo : expected)
            if (pdo.entries.empty()) {
                const auto* own = described(known, pdo.index);
                const auto* now = described(*got, pdo.index);
                pdo.entries = own != nullptr ? own->entries : now != nullptr ? now->entries : std::vector<PdoEntry>{};
            }
        const Result<void> same = compare(slave, assignment, expected, *got);
        if (!same) co_return same;
    }
    effective = std::move(*got);
    co_return Result<void>{};
}

std::vector<PdoDescription> from_description(const std::vector<PdoDescription>& pdos, const std::vector<std::uint16_t>& assigned) {
    if (assigned.empty()) return pdos;
    std::vector<PdoDescription> result;
    for (const auto index : assigned)
        if (const auto* pdo = described(pdos, index)) result.push_back(*pdo);
    return result;
}

}  // namespace

Script<Result<void>> enter_preop(Bus& bus, BusSlave& slave) {
    slave.mailbox.reset();
    if (slave.has_mailbox()) {
        const Result<void> located = locate_mailbox(slave);
        if (!located) co_return located;
        SyncManager sm;
        sm.activate = SyncManager::enable;
        sm.start = slave.mailbox.out_start;
        sm.length = slave.mailbox.out_size;
        sm.control = SyncManager::usual_mailbox_out;
        Result<void> written = co_await write_sm(bus, slave, slave.mailbox.out_sm, sm);
        if (!written) co_return written;
        sm.start = slave.mailbox.in_start;
        sm.length = slave.mailbox.in_size;
        sm.control = SyncManager::usual_mailbox_in;
        written = co_await write_sm(bus, slave, slave.mailbox.in_sm, sm);
        if (!written) co_return written;
    }
    co_return co_await set_state(bus, slave, AlState::preop);
}

Script<Result<void>> assign_pdos(Bus& bus, BusSlave& slave) {
    if (!slave.has_mailbox()) {
        const auto& device = slave.device();
        slave.rx = from_description(device.rx_pdos, device.rx_assigned);
        slave.tx = from_description(device.tx_pdos, device.tx_assigned);
        co_return Result<void>{};
    }
    const Result<void> outputs = co_await assign_direction(bus, slave, SmUse::outputs);
    if (!outputs) co_return outputs;
    co_return co_await assign_direction(bus, slave, SmUse::inputs);
}

Script<Result<void>> write_startup_safeop(Bus& bus, BusSlave& slave) { return write_startup(bus, slave, Transition::PreopToSafeop); }
Script<Result<void>> write_startup_op(Bus& bus, BusSlave& slave) { return write_startup(bus, slave, Transition::SafeopToOp); }

Script<Result<void>> prepare_process_data(Bus& bus, BusSlave& slave) {
    const Result<void> written = co_await write_startup_safeop(bus, slave);
    if (!written) co_return written;
    co_return co_await assign_pdos(bus, slave);
}

Duration sm_watchdog(const BusConfig& bus, const SlaveConfig& slave) noexcept {
    if (slave.sm_watchdog > Duration{}) return slave.sm_watchdog;
    return std::max(3 * exchange_period(bus, slave), minimum_watchdog);
}

Script<Result<void>> program_process_data(Bus& bus, BusSlave& slave) {
    const auto& plan = bus.plan.slaves[slave.index];
    bus.note(slave, "programming sync managers and FMMUs");
    const std::uint16_t station = slave.found.station;
    for (const auto& sm : plan.sync_managers) {
        const Result<void> written = co_await write_sm(bus, slave, sm.number, sm.registers);
        if (!written) co_return written;
    }
    for (std::size_t n = 0; n < plan.fmmus.size(); ++n) {
        std::vector<std::byte> bytes(Fmmu::size);
        encode(plan.fmmus[n], std::span<std::byte, Fmmu::size>{bytes});
        const Reply reply = co_await bus.port.fpwr(station, reg::fmmu_at(static_cast<unsigned>(n)), bytes);
        if (!reply.ok()) co_return unanswered(slave.subject, fmt::format("FMMU {}", n), reply);
    }
    const auto ticks = static_cast<std::uint16_t>(
        std::min<std::int64_t>(0xFFFF, (sm_watchdog(bus.config, *slave.config) + watchdog_tick - Duration{1}) / watchdog_tick));
    const Reply divider = co_await bus.port.fpwr(station, reg::watchdog_divider, reg::watchdog_divider_default);
    const Reply watchdog = co_await bus.port.fpwr(station, reg::sm_watchdog_time, ticks);
    if (plan.outputs.size > 0 && (!divider.ok() || !watchdog.ok()))
        co_return unanswered(slave.subject, "SM watchdog (0420h)", divider.ok() ? watchdog : divider);
    co_return Result<void>{};
}

PlanSlave plan_input(const BusSlave& slave) {
    PlanSlave input;
    input.subject = slave.subject;
    input.sync_unit = slave.config->sync_unit;
    input.sync_managers = slave.device().sync_managers;
    input.rx = slave.rx;
    input.tx = slave.tx;
    input.coe = slave.has_mailbox();
    input.fmmus = slave.found.fmmus;
    input.sync_manager_count = slave.found.sync_managers;
    input.lrw = (slave.found.features & feature::no_lrw) == 0;
    input.bitwise_fmmu = (slave.found.features & feature::fmmu_not_bitwise) == 0;
    if (input.coe) input.mailbox_in = slave.mailbox.in_sm;
    return input;
}

}  // namespace taktwerk::ecat
