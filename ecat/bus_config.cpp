#include "ecat/bus_config.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/clocks.hpp"
#include "ecat/bringup/known_pdos.hpp"
#include "ecat/dc/sync0_budget.hpp"
#include "ecat/description/factory_mapping.hpp"
#include "ecat/description/module_pdos.hpp"
#include "ecat/group_check.hpp"
#include "ecat/layout/frame_schedule.hpp"
#include "ecat/layout/process_data_plan.hpp"
#include "ecat/place_check.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration minimum_cycle = std::chrono::microseconds{50};
constexpr Duration maximum_cycle = std::chrono::milliseconds{100};
constexpr Duration maximum_watchdog = std::chrono::microseconds{100} * 0xFFFF;

std::string micro(Duration d) { return fmt::format("{:.9g} us", to_seconds(d) * 1e6); }

/// What the planner is told of a slave that nobody has asked: selected PDOs, else its factory ones.
PlanSlave plan_slave(const SlaveConfig& slave, const std::string& subject) {
    const auto& device = *slave.device;
    PlanSlave input;
    input.subject = subject;
    input.sync_unit = slave.sync_unit;
    input.sync_managers = device.sync_managers;
    input.coe = device.mailbox && device.mailbox->coe;
    auto known = known_pdos(slave);
    input.rx = std::move(known.rx);
    input.tx = std::move(known.tx);
    input.fmmus = device.fmmus;
    input.sync_manager_count = device.sync_manager_count;
    const auto mailbox = std::find_if(device.sync_managers.begin(), device.sync_managers.end(),
                                      [](const SyncManagerDescription& sm) { return sm.use == SmUse::mailbox_in; });
    if (input.coe && mailbox != device.sync_managers.end())
        input.mailbox_in = static_cast<std::uint8_t>(mailbox - device.sync_managers.begin());
    return input;
}

class Check {
public:
    explicit Check(const BusConfig& config) : config_(config) {}

    std::vector<Error> run() {
        if (config_.cycle < minimum_cycle || config_.cycle > maximum_cycle)
            add("bus.cycle", "bus",
                fmt::format("the cycle of {} is outside {} .. {}", micro(config_.cycle), micro(minimum_cycle), micro(maximum_cycle)),
                "choose 1 ms if in doubt");
        if (config_.slaves.empty()) add("bus.no_slaves", "bus", "no slave is configured", "list the slaves as they stand on the cable");
        if (config_.lost_frames_limit == 0)
            add("bus.lost_frames_limit", "bus", "a limit of 0 lost frames would stop at once", "choose 3 if in doubt");
        if (config_.acyclic_per_cycle == 0)
            add("bus.acyclic_per_cycle", "bus", "with 0 acyclic datagrams no SDO and no recovery gets through in OP",
                "choose 4 if in doubt");
        check_ring();
        check_shift("bus", config_.sync0_shift);
        check_places(config_, errors_);
        check_groups(config_, errors_);
        for (const auto& slave : config_.slaves) check_slave(slave);
        check_load();
        return std::move(errors_);
    }

private:
    void add(std::string code, std::string subject, std::string what, std::string remedy) {
        errors_.push_back({std::move(code), std::move(subject), std::move(what), std::move(remedy)});
    }
    static std::string subject_of(const SlaveConfig& slave) { return fmt::format("slave '{}'", slave.name); }

    void check_ring() {
        if (!config_.ring) return;
        const auto& other = config_.ring->interface2;
        if (config_.interface.empty() != other.empty())
            add("bus.ring", "bus", "one interface of the ring is simulated and the other is not",
                "write `simulated` for both, or two network interfaces");
        else if (!other.empty() && other == config_.interface)
            add("bus.ring", "bus", fmt::format("both ends of the ring are {}", other), "a ring needs two network interfaces");
    }

    void check_shift(const std::string& subject, Duration shift) {
        if (shift < Duration{} || shift >= config_.cycle)
            add("bus.sync0_shift", subject,
                fmt::format("a SYNC0 shift of {} is not inside the cycle of {}", micro(shift), micro(config_.cycle)),
                "leave it out for half a cycle");
    }

    void check_slave(const SlaveConfig& slave) {
        const std::string subject = subject_of(slave);
        if (!slave.device) {
            add("bus.no_device", subject, "it has no device description", "name its drive or terminal profile");
            plannable_ = false;
            return;
        }
        const auto& device = *slave.device;
        check_clock(slave, device, subject);
        if (slave.sm_watchdog < Duration{} || slave.sm_watchdog > maximum_watchdog)
            add("bus.sm_watchdog", subject, fmt::format("a watchdog of {} cannot be set", micro(slave.sm_watchdog)),
                fmt::format("0 .. {}", micro(maximum_watchdog)));
        else if (const auto period = exchange_period(config_, slave); slave.sm_watchdog > Duration{} && slave.sm_watchdog < 2 * period)
            add("bus.sm_watchdog", subject,
                fmt::format("a watchdog of {} trips at the first lost frame: it is exchanged every {}", micro(slave.sm_watchdog),
                            micro(period)),
                fmt::format("choose at least {}", micro(3 * period)));
        if (slave.pdi_watchdog < Duration{} || slave.pdi_watchdog > maximum_watchdog)
            add("bus.pdi_watchdog", subject, fmt::format("a watchdog of {} cannot be set", micro(slave.pdi_watchdog)),
                fmt::format("0 .. {}", micro(maximum_watchdog)));
        check_modules(slave, device, subject);
        check_pdos(slave, device, subject, true);
        check_pdos(slave, device, subject, false);
        check_startup(slave, device, subject);
        check_plan(slave, subject);
    }

    void check_clock(const SlaveConfig& slave, const DeviceDescription& device, const std::string& subject) {
        check_shift(subject, slave.sync0_shift);
        if (slave.sync1 && (*slave.sync1 < Duration{} || *slave.sync1 >= config_.cycle))
            add("bus.sync1", subject,
                fmt::format("SYNC1 {} after SYNC0 is not inside the cycle of {}", micro(*slave.sync1), micro(config_.cycle)),
                "choose a time below the cycle");
        if (slave.dc && device.dc.supported && time_to_compute(config_, slave) <= Duration{})
            add("bus.sync0_budget", subject,
                fmt::format("SYNC0 comes {} after the start of the cycle, but the frames alone need {} to be through",
                            micro(sync0_shift(config_, slave)), micro(estimated_flight(config_))),
                "choose a later SYNC0 (sync0_shift) or a longer cycle");
        if (slave.dc && !device.dc.supported)
            add("bus.dc_unsupported", subject, fmt::format("'{}' has no distributed clock", device.name), "set dc: false");
        if (!slave.dc && device.dc.required)
            add("bus.dc_required", subject, fmt::format("'{}' works with SYNC0 only", device.name), "set dc: true");
        if (slave.sync1 && !slave.dc)
            add("bus.sync1", subject, "SYNC1 is asked for, and the slave runs without SYNC0", "set dc: true, or remove sync1");
        if (slave.sync1 && (*slave.sync1 < Duration{} || *slave.sync1 >= config_.cycle))
            add("bus.sync1", subject,
                fmt::format("SYNC1 {} after SYNC0 is not inside the cycle of {}", micro(*slave.sync1), micro(config_.cycle)),
                "choose a shorter time");
        if (!slave.dc) return;
        const Duration sync0_cycle = exchange_period(config_, slave);
        if (device.dc.minimum_cycle > sync0_cycle)
            add("bus.cycle_too_short", subject,
                fmt::format("'{}' needs a cycle of at least {}, it is exchanged every {}", device.name, micro(device.dc.minimum_cycle),
                            micro(sync0_cycle)),
                "lengthen the bus cycle, or put it into a slower sync unit");
        if (device.dc.cycle_multiple > Duration{} && sync0_cycle % device.dc.cycle_multiple != Duration{})
            add("bus.cycle_multiple", subject,
                fmt::format("'{}' needs a multiple of {}, it is exchanged every {}", device.name, micro(device.dc.cycle_multiple),
                            micro(sync0_cycle)),
                "choose another bus cycle");
        if (!device.dc.cycles.empty() &&
            std::find(device.dc.cycles.begin(), device.dc.cycles.end(), sync0_cycle) == device.dc.cycles.end()) {
            std::string known;
            for (const auto cycle : device.dc.cycles) known += (known.empty() ? "" : ", ") + micro(cycle);
            add("bus.cycle_unknown", subject,
                fmt::format("'{}' knows the cycles {} only, it is exchanged every {}", device.name, known, micro(sync0_cycle)),
                "choose one of them");
        }
    }

    void check_modules(const SlaveConfig& slave, const DeviceDescription& device, const std::string& subject) {
        if (slave.modules.empty()) return;
        if (device.slots.count == 0) {
            add("bus.modules", subject, fmt::format("'{}' has no slots: modules cannot be chosen", device.name), "remove them");
            return;
        }
        std::vector<bool> filled(device.slots.count, false);
        for (const auto& selection : slave.modules) {
            if (selection.slot >= device.slots.count) {
                add("bus.modules", subject,
                    fmt::format("there is no slot {}: '{}' has {}", selection.slot, device.name, device.slots.count), "slots count from 0");
                continue;
            }
            if (filled[selection.slot])
                add("bus.modules", subject, fmt::format("slot {} holds two modules", selection.slot), "keep one of them");
            filled[selection.slot] = true;
            if (find_module(device.slots, selection.module) != nullptr) continue;
            std::string known;
            for (const auto& module : device.slots.modules) known += (known.empty() ? "" : ", ") + module.name;
            add("bus.modules", subject, fmt::format("'{}' has no module '{}'", device.name, selection.module), "choose one of " + known);
        }
    }

    void check_pdos(const SlaveConfig& slave, const DeviceDescription& device, const std::string& subject, bool rx) {
        const auto& selection = rx ? slave.rx.assigned : slave.tx.assigned;
        const auto& rules = rx ? device.rx_rules : device.tx_rules;
        const auto offered = pdos_of(device, slave.modules);
        const auto& known = rx ? offered.rx : offered.tx;
        const char* direction = rx ? "RxPDO" : "TxPDO";
        if (selection.empty()) return;
        if (!device.mailbox || !device.mailbox->coe) {
            add("bus.pdo_no_coe", subject, fmt::format("'{}' has no CoE: its PDOs cannot be chosen", device.name), "remove the selection");
            return;
        }
        if (selection.size() > rules.max_assigned)
            add("bus.pdo_too_many", subject,
                fmt::format("{} {}s are selected, '{}' takes {}", selection.size(), direction, device.name, rules.max_assigned),
                "select fewer");
        for (const auto& pdo : selection) {
            const auto own = std::find_if(known.begin(), known.end(), [&](const PdoDescription& p) { return p.index == pdo.index; });
            if (own == known.end()) {
                add("bus.pdo_unknown", subject, fmt::format("'{}' has no {} {:04X}h", device.name, direction, pdo.index),
                    "select one that its profile lists");
                continue;
            }
            if (own->fixed && !pdo.entries.empty() && pdo.entries != own->entries)
                add("bus.pdo_fixed", subject, fmt::format("the entries of {:04X}h are fixed and differ from the selection", pdo.index),
                    "select it without entries, or use a variable PDO");
            if (!own->fixed && pdo.entries.size() > rules.max_entries)
                add("bus.pdo_entries", subject,
                    fmt::format("{:04X}h gets {} entries, '{}' takes {}", pdo.index, pdo.entries.size(), device.name, rules.max_entries),
                    "map fewer objects");
            for (const auto& entry : pdo.entries) check_entry(device, subject, pdo.index, entry, rx);
        }
        if ((mapped_bits(selection) + 7) / 8 > rules.max_bytes)
            add("bus.pdo_bytes", subject,
                fmt::format("its {}s are {} bytes, '{}' takes {}", direction, (mapped_bits(selection) + 7) / 8, device.name,
                            rules.max_bytes),
                "map fewer objects");
    }

    void check_entry(const DeviceDescription& device, const std::string& subject, std::uint16_t pdo, const PdoEntry& entry, bool rx) {
        if (entry.index == 0 || device.objects.empty()) return;
        const auto object = std::find_if(device.objects.begin(), device.objects.end(),
                                         [&](const ObjectEntry& o) { return o.index == entry.index && o.sub == entry.sub; });
        if (object == device.objects.end()) return;  // profiles need not list every object
        const bool mappable = object->mappable == Mappable::both || object->mappable == (rx ? Mappable::rx : Mappable::tx);
        if (!mappable)
            add("bus.pdo_mappable", subject,
                fmt::format("{} '{}' cannot be mapped into {:04X}h", object_text(entry.index, entry.sub), object->name, pdo),
                "read or write it as an SDO");
        const bool part = entry.bits < bit_size(object->type) && mapped_by_maker(device, entry.index, entry.sub, entry.bits, rx);
        if (bit_size(object->type) != 0 && bit_size(object->type) != entry.bits && !part)
            add("bus.pdo_bits", subject,
                fmt::format("{} has {} bits, {:04X}h maps {}", object_text(entry.index, entry.sub), bit_size(object->type), pdo,
                            entry.bits),
                "map its whole size");
    }

    void check_startup(const SlaveConfig& slave, const DeviceDescription& device, const std::string& subject) {
        if (slave.startup.empty()) return;
        if (!device.mailbox || !device.mailbox->coe) {
            add("bus.startup_no_coe", subject, fmt::format("'{}' has no CoE: start-up SDOs cannot be written", device.name), "remove them");
            return;
        }
        for (const auto& sdo : slave.startup) {
            const std::string where = sdo.origin.empty() ? subject : sdo.origin;
            const std::string object = object_text(sdo.index, sdo.sub);
            if (sdo.type == DataType::STRING)
                add("bus.startup_type", where, fmt::format("{}: strings cannot be start-up values", object), "remove it");
            const unsigned bits = bit_size(sdo.type);
            const std::int64_t low = is_signed(sdo.type) ? -(std::int64_t{1} << (bits - 1)) : 0;
            const std::int64_t high = is_signed(sdo.type) ? -(low + 1) : static_cast<std::int64_t>((std::uint64_t{1} << (bits % 64)) - 1);
            if (bits > 0 && bits < 64 && (sdo.value < low || sdo.value > high))
                add("bus.startup_range", where, fmt::format("{}: {} does not fit {} bits", object, sdo.value, bits),
                    fmt::format("{} .. {}", low, high));
            const auto known = std::find_if(device.objects.begin(), device.objects.end(),
                                            [&](const ObjectEntry& o) { return o.index == sdo.index && o.sub == sdo.sub; });
            if (known == device.objects.end()) continue;
            if (known->access == Access::ro)
                add("bus.startup_read_only", where, fmt::format("{} '{}' is read-only", object, known->name),
                    "remove it from the start-up list");
            if (known->access == Access::wo && (sdo.verify || sdo.if_changed))
                add("bus.startup_write_only", where, fmt::format("{} '{}' is write-only and cannot be read back", object, known->name),
                    "set verify: false");
            if ((known->minimum && sdo.value < *known->minimum) || (known->maximum && sdo.value > *known->maximum))
                add("bus.startup_range", where, fmt::format("{} '{}': {} is outside the drive's range", object, known->name, sdo.value),
                    fmt::format("{} .. {}", known->minimum.value_or(low), known->maximum.value_or(high)));
        }
    }

    void check_plan(const SlaveConfig& slave, const std::string& subject) {
        const std::vector inputs{plan_slave(slave, subject)};
        if (const auto plan = plan_process_data(inputs); !plan) errors_.push_back(plan.error());
        else return;
        plannable_ = false;
    }

    void check_load() {
        if (!plannable_ || config_.cycle < minimum_cycle) return;
        const BusLoad load = bus_load(config_);
        const Duration least = load.wire + static_cast<std::int64_t>(config_.slaves.size()) * least_hop_both_ways;
        if (least <= config_.cycle) return;
        const auto whole = [](Duration d) { return fmt::format("{:.0f} us", to_seconds(d) * 1e6); };
        add("bus.cycle_too_short_for_frames", "bus",
            fmt::format(
                "the process data of a cycle is {} bytes in {} frame(s): at 100 Mbit/s {} on the wire, and {} until it is back through "
                "{} slaves; the cycle is {}",
                load.bytes, load.frames, whole(load.wire), whole(load.round_trip), config_.slaves.size(), micro(config_.cycle)),
            fmt::format("choose a cycle of at least {}, map fewer objects, put slaves into slower sync units, or use two buses",
                        whole(load.round_trip * 4 / 3)));
    }

    const BusConfig& config_;
    std::vector<Error> errors_;
    bool plannable_ = true;
};

}  // namespace

Duration estimated_flight(const BusConfig& config) {
    std::size_t bytes = 0;
    for (const auto& slave : config.slaves) {
        if (!slave.device) continue;
        const auto known = known_pdos(slave);
        bytes += datagram_overhead + (mapped_bits(known.rx) + 7) / 8 + (mapped_bits(known.tx) + 7) / 8;
    }
    bytes += datagram_overhead + 8 + datagram_overhead + 2;  // clock and AL states
    const std::size_t frames = bytes / frame_capacity + 1;
    return flight_time(bytes + frames * (ethernet_header_size + ecat_header_size), frames, config.slaves.size());
}

BusLoad bus_load(const BusConfig& config) {
    std::vector<PlanSlave> inputs;
    for (const auto& slave : config.slaves) {
        if (!slave.device) return {};
        inputs.push_back(plan_slave(slave, slave.name));
    }
    const auto plan = plan_process_data(inputs, config.sync_units);
    if (!plan) return {};
    const auto load = fullest_cycle(*plan);
    return {load.wire, load.wire + static_cast<std::int64_t>(config.slaves.size()) * usual_hop, load.bytes, load.frames};
}

Duration time_to_compute(const BusConfig& config, const SlaveConfig& slave) {
    return sync0_shift(config, slave) - estimated_flight(config);
}

std::vector<Error> check(const BusConfig& config) { return Check{config}.run(); }

}  // namespace taktwerk::ecat
