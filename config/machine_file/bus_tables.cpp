#include "config/machine_file/bus_tables.hpp"

#include <fmt/format.h>

#include "config/drive_file/device_tables.hpp"
#include "config/drive_file/drive_motion_tables.hpp"
#include "config/machine_file/machine_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using namespace std::chrono_literals;

Table<Terminal> terminal_table() {
    using T = Terminal;
    Table<T> table{"bus.slaves.terminal",
                   "A plain digital terminal without mailbox, as whole bytes.",
                   {
                       field("inputs", &T::inputs, integer<std::uint8_t>(0, 128), "digital inputs: 0, 8, 16, ..."),
                       field("outputs", &T::outputs, integer<std::uint8_t>(0, 128), "digital outputs: 0, 8, 16, ..."),
                   },
                   {},
                   {}};
    table.after = [](Reader& reader, const Node& node, T& t) {
        if (reader.already_bad(reader.path())) return;  // a number that was refused is not a 0 that was written
        if (t.inputs + t.outputs == 0)
            reader.problem(node.at, "config.terminal", "the terminal has neither inputs nor outputs", "give `inputs: 8` or `outputs: 8`");
        if (t.inputs % 8 != 0 || t.outputs % 8 != 0)
            reader.problem(node.at, "config.terminal", "terminals have whole bytes of inputs and outputs", "give 8, 16, 24, ...");
    };
    return table;
}

Table<ecat::ModuleSelection> module_selection_table() {
    using M = ecat::ModuleSelection;
    return {"bus.slaves.modules",
            "The module in one slot of a modular slave.",
            {
                required(field("slot", &M::slot, integer<std::uint8_t>(0, 254), "from 0")),
                required(field("module", &M::module, config::name(), "one of the modules that the drive file lists")),
            },
            {},
            {}};
}

Table<ecat::Identity> identity_table() {
    using I = ecat::Identity;
    return {"bus.slaves.identity",
            "Who a drive is that nobody described: as `taktwerk bus scan` shows it.",
            {
                required(field("vendor", &I::vendor, integer<std::uint32_t>(0, 0xFFFFFFFF), "vendor id")),
                required(field("product", &I::product, integer<std::uint32_t>(0, 0xFFFFFFFF), "product code")),
                field("revision", &I::revision, integer<std::uint32_t>(0, 0xFFFFFFFF), "for `revision_rule`"),
            },
            {},
            {}};
}

Codec<ecat::LossPolicy> loss_policy() {
    using L = ecat::LossPolicy;
    return choice<L>({{"stop_machine", L::stop_machine}, {"stop_own_axes", L::stop_own_axes}});
}

Codec<ecat::SyncStart> sync_start() {
    using S = ecat::SyncStart;
    return choice<S>({{"before_safeop", S::before_safeop}, {"in_safeop", S::in_safeop}});
}

Codec<ecat::ExtraSlaves> extra_slaves() {
    using E = ecat::ExtraSlaves;
    return choice<E>({{"refuse", E::refuse}, {"ignore", E::ignore}});
}

/// A key that the bus is told as it stands.
template <class M>
Field<SlaveEntry> of_bus(std::string key, M ecat::SlaveConfig::*member, Codec<M> codec, std::string doc) {
    return field_at<SlaveEntry>(
        std::move(key), [member](SlaveEntry& s) -> M& { return s.slave.*member; }, std::move(codec), std::move(doc));
}

Table<SlaveEntry> slave_table() {
    using S = SlaveEntry;
    using C = ecat::SlaveConfig;
    Table<S> table{
        "bus.slaves",
        "One slave on the cable: a drive (with `profile`), another device (with `device`) or a plain digital terminal (with `terminal`).",
        {
            required(of_bus("name", &C::name, config::name(), "by which axes and I/O points refer to it")),
            with_default(field("profile", &S::profile, config::name(), "drive type: a file in config/drives/"), ""),
            with_default(field("device", &S::device, config::name(), "device type that is no drive: a file in config/devices/"), ""),
            field("terminal", &S::terminal, maybe(section(terminal_table())), "or a digital terminal of no particular make"),
            with_default(
                field("identity", &S::identity, maybe(section(identity_table())), "who it is, where its drive file leaves that open"),
                "whoever stands at its place"),
            with_default(
                field("modes", &S::modes, list(drive_mode()), "of operation, where its drive file leaves them open: 6502h is not asked"),
                "those of 6502h"),
            with_default(of_bus("position", &C::position, maybe(integer<std::uint16_t>(0, 65535)), "place on the cable, from 0"),
                         "its place in this list"),
            of_bus("alias", &C::alias, maybe(integer<std::uint16_t>(1, 65535)), "station alias instead of the position"),
            of_bus("device_id", &C::device_id, maybe(integer<std::uint16_t>(1, 65535)),
                   "explicit device id (switches on the device) instead of the position"),
            with_default(of_bus("revision_rule", &C::revision_rule, maybe(revision_rule()),
                                "any · at_least: the drive file's revision or a later one · exact"),
                         "as its drive file says"),
            with_default(
                of_bus("hot_connect", &C::hot_connect, config::name(),
                       "name of the group that it joins and leaves with while the rest runs; the first slave of a group has `alias` or "
                       "`device_id`, those behind it have no place of their own"),
                "it is always there"),
            of_bus("on_loss", &C::on_loss, loss_policy(), "when it is gone: every axis stops, or those on this slave alone"),
            with_default(field("dc", &S::dc, maybe(boolean()), "run SYNC0 on it"), "where the drive supports it"),
            with_default(of_bus("sync0_shift", &C::sync0_shift, duration(), "SYNC0 after the start of the bus cycle"), "as the bus"),
            with_default(of_bus("sm_watchdog", &C::sm_watchdog, duration(100us, 6s), "the slave stops when no outputs come for this long"),
                         "three periods of its sync unit, at least 10 ms"),
            with_default(
                of_bus("sync_unit", &C::sync_unit, config::name(), "slaves of one name are exchanged together, and valid or not together"),
                "a unit of its own"),
            with_default(
                of_bus("pdi_watchdog", &C::pdi_watchdog, duration(0ns, 6s), "the controller notices that the slave's processor hangs"),
                "as the slave has it"),
            with_default(of_bus("sync1", &C::sync1, maybe(duration()), "run SYNC1 too, this long after SYNC0"), "not used"),
            of_bus("sync_start", &C::sync_start, sync_start(), "when SYNC0 starts; some slaves refuse it before SAFEOP"),
            of_bus("modules", &C::modules, list(section(module_selection_table())), "what is in the slots of a modular slave"),
            group<S>("pdo", "Other process data than the profile's mapping: objects (607Ah, ...) or whole PDOs (1702h).",
                     {
                         field("rx", &S::rx, list(object_address()), "to the drive"),
                         field("tx", &S::tx, list(object_address()), "from the drive"),
                     }),
            field("startup", &S::startup, list(section(startup_table())), "SDOs written while the slave comes up"),
            field("stored", &S::stored, list(section(stored_table())),
                  "what its EEPROM holds once it was commissioned, because the drive looks at it when it is switched on only"),
        },
        {},
        {}};
    for (auto& f : table.fields)
        if (f.info.key == "pdo" || f.info.key == "startup" || f.info.key == "stored" || f.info.key == "modules" || f.info.key == "identity")
            f.info.default_text.clear();
    table.after = [](Reader& reader, const Node& node, S& s) {
        reader.also_known_as(fmt::format("slave '{}'", s.slave.name), node.at);  // as the bus calls it
        std::string kinds;
        int count = 0;
        for (const auto* kind : {"profile", "device", "terminal"})
            if (node.find(kind) != nullptr) kinds += fmt::format("{}`{}`", count++ == 0 ? "" : " and ", kind);
        if (count == 0)
            reader.problem(
                node.at, "config.missing_key", fmt::format("slave '{}' has neither `profile` nor `device` nor `terminal`", s.slave.name),
                "add `profile:` with a drive type, `device:` with another device type, or `terminal:` with its inputs and outputs");
        if (count > 1)
            reader.problem(node.at, "config.conflict", fmt::format("slave '{}' has both {}", s.slave.name, kinds), "keep one of them");
        if (s.slave.position.has_value() + s.slave.alias.has_value() + s.slave.device_id.has_value() > 1)
            reader.problem(node.at, "config.conflict",
                           fmt::format("slave '{}' has more than one of `position`, `alias` and `device_id`", s.slave.name),
                           s.slave.hot_connect.empty() ? "keep the one that identifies it"
                                                       : "keep the alias or the device id: a group may be plugged in anywhere");
        if (!s.slave.hot_connect.empty() && node.find("on_loss") != nullptr)
            reader.problem(node.find("on_loss")->at, "config.conflict",
                           fmt::format("slave '{}' is of group '{}', which may go: its own axes stop then, and the others run on",
                                       s.slave.name, s.slave.hot_connect),
                           "remove `on_loss`");
        s.broken = reader.already_bad(reader.path());
    };
    return table;
}

/// A NIC by name, or `simulated`.
Codec<std::string> interface_name() {
    auto c = text();
    c.read = [any = c.read](Reader& reader, const Node& node, std::string& out) {
        std::string value;
        if (!any(reader, node, value)) return false;
        if (value.size() > 15 || value.find_first_of(" /:") != std::string::npos) {
            reader.problem(node.at, "config.bad_name", fmt::format("`{}` is no name of a network interface", value),
                           "write `simulated`, or a name that `ip link` shows, such as `eth1`");
            return false;
        }
        out = value == "simulated" ? std::string{} : value;
        return true;
    };
    c.show = {};
    return c;
}

Codec<ecat::BehindBreak> behind_break() {
    using B = ecat::BehindBreak;
    return choice<B>({{"hand_time_on", B::hand_time_on}, {"ramp_down", B::ramp_down}});
}

Codec<ecat::BusTransport> bus_transport() {
    using B = ecat::BusTransport;
    return choice<B>({{"packet", B::packet}, {"xdp", B::xdp}, {"auto", B::automatic}});
}

Table<ecat::RingConfig> ring_table() {
    using R = ecat::RingConfig;
    return {
        "bus.ring",
        "A second interface behind the last slave: no single cable takes a slave away.",
        {
            required(field("interface2", &R::interface2, interface_name(),
                           "`simulated` where `interface` is, or the network interface that the cable from the last slave goes to")),
            field("behind_break", &R::behind_break, behind_break(),
                  "slaves with SYNC0 that a break cuts off from the reference clock: this computer hands its time on to them and they run "
                  "on, or they count as unsynchronised and their axes stop"),
        },
        {},
        {}};
}

Table<ecat::SyncUnitConfig> sync_unit_table() {
    using U = ecat::SyncUnitConfig;
    return {"bus.sync_units",
            "How often the slaves of a `sync_unit` are exchanged; those of a unit that is not listed are in every cycle.",
            {
                required(field("name", &U::name, config::name(), "as the slaves name it")),
                required(field("divisor", &U::divisor, integer<std::uint16_t>(1, 1000), "exchanged every so many bus cycles")),
            },
            {},
            {}};
}

}  // namespace

Field<MachineFile> bus_field() {
    using F = MachineFile;
    return group<F>(
        "bus", "The EtherCAT bus.",
        {
            required(field_at<F>(
                "interface", [](F & f) -> auto& { return f.machine.bus.interface; }, interface_name(),
                "`simulated`, or the name of the network interface (`ip link`)")),
            field_at<F>(
                "transport", [](F & f) -> auto& { return f.machine.bus.transport; }, bus_transport(),
                "AF_PACKET; AF_XDP, and no start without it; or AF_XDP where the port's driver has it, else AF_PACKET (bus.md)"),
            with_default(field_at<F>(
                             "ring", [](F & f) -> auto& { return f.machine.bus.ring; }, maybe(section(ring_table())),
                             "two interfaces, with the slaves in line between them"),
                         "one interface"),
            with_default(field_at<F>(
                             "sync0_shift", [](F & f) -> auto& { return f.machine.bus.sync0_shift; }, duration(),
                             "SYNC0 after the start of the bus cycle"),
                         "half a cycle"),
            field_at<F>(
                "lost_frames_limit", [](F & f) -> auto& { return f.machine.bus.lost_frames_limit; }, integer<std::uint16_t>(1, 10000),
                "unanswered cycles in a row until the bus alarm"),
            field_at<F>(
                "acyclic_per_cycle", [](F & f) -> auto& { return f.machine.bus.acyclic_per_cycle; }, integer<std::uint8_t>(1, 64),
                "datagrams per cycle for SDO, recovery, diagnosis"),
            field_at<F>(
                "extra_slaves", [](F & f) -> auto& { return f.machine.bus.extra_slaves; }, extra_slaves(),
                "on the cable, and not in `slaves`: refuse to start, or leave them in INIT"),
            group<F>(
                "state_timeouts", "How long a slave may take for a transition.",
                {
                    field_at<F>(
                        "preop", [](F & f) -> auto& { return f.machine.bus.state_timeouts.preop; }, duration(1ms, 600s), "INIT to PREOP"),
                    field_at<F>(
                        "safeop", [](F & f) -> auto& { return f.machine.bus.state_timeouts.safeop; }, duration(1ms, 600s),
                        "PREOP to SAFEOP"),
                    field_at<F>(
                        "op", [](F & f) -> auto& { return f.machine.bus.state_timeouts.op; }, duration(1ms, 600s), "SAFEOP to OP"),
                    field_at<F>(
                        "down", [](F & f) -> auto& { return f.machine.bus.state_timeouts.down; }, duration(1ms, 600s), "back towards INIT"),
                }),
            with_default(field_at<F>(
                             "sync_units", [](F & f) -> auto& { return f.machine.bus.sync_units; }, list(section(sync_unit_table())),
                             "groups of slaves that are exchanged less often"),
                         ""),
            required(field("slaves", &F::slaves, list(section(slave_table())), "what is on the cable, in its order")),
        });
}

}  // namespace taktwerk::config
