#include "config/drive_tables.hpp"

#include <fmt/format.h>

#include "config/codecs.hpp"

namespace taktwerk::config {

namespace {

using axes::DriveAlarmText;
using axes::DriveMode;
using axes::DriveProfile;
using axes::Quirk;
using ecat::Access;
using ecat::DeviceDescription;
using ecat::Mappable;
using ecat::ObjectEntry;
using ecat::SmUse;

constexpr std::int64_t u8 = 0xFF, u16 = 0xFFFF, u32 = 0xFFFFFFFF;

Table<ecat::Identity> identity_pair_table() {
    using I = ecat::Identity;
    return {"identity.also_accepted",
            "Another identity of the same drive.",
            {required(field("vendor", &I::vendor, integer<std::uint32_t>(0, u32), "vendor id")),
             required(field("product", &I::product, integer<std::uint32_t>(0, u32), "product code"))},
            {},
            {}};
}

Table<DeviceDescription> identity_table() {
    using D = DeviceDescription;
    return {
        "identity",
        "Who the slave says it is (object 1018h, SII words 8 to 15).",
        {
            field("device_name", &D::device_name, text(), "object 1008h"),
            required(field_at<D>(
                "vendor", [](D & d) -> auto& { return d.identity.vendor; }, integer<std::uint32_t>(0, u32), "vendor id, compared exactly")),
            required(field_at<D>(
                "product", [](D & d) -> auto& { return d.identity.product; }, integer<std::uint32_t>(0, u32),
                "product code, compared exactly")),
            field_at<D>(
                "revision", [](D & d) -> auto& { return d.identity.revision; }, integer<std::uint32_t>(0, u32), "revision"),
            field("revision_exact", &D::revision_exact, boolean(), "also the revision must be equal"),
            field("also_accepted", &D::also_accepted, list(section(identity_pair_table())),
                  "further vendor and product pairs, where manuals contradict themselves"),
        },
        {},
        {}};
}

Table<ecat::MailboxDescription> mailbox_table() {
    using M = ecat::MailboxDescription;
    return {"mailbox",
            "Acyclic services. Left out for terminals that have none.",
            {
                field("coe", &M::coe, boolean(), "CANopen over EtherCAT"),
                field("complete_access", &M::complete_access, boolean(), "whole objects in one SDO"),
                field("sdo_info", &M::sdo_info, boolean(), "the dictionary can be listed"),
                field("max_pending", &M::max_pending, integer<std::uint8_t>(1, 255), "messages that the slave buffers"),
            },
            {},
            {}};
}

Table<ecat::SyncManagerDescription> sync_manager_table() {
    using S = ecat::SyncManagerDescription;
    return {"sync_managers",
            "One sync manager, in the order of the controller.",
            {
                required(field("use", &S::use,
                               choice<SmUse>({{"mailbox_out", SmUse::mailbox_out},
                                              {"mailbox_in", SmUse::mailbox_in},
                                              {"outputs", SmUse::outputs},
                                              {"inputs", SmUse::inputs}}),
                               "what goes through it")),
                required(field("start", &S::start, integer<std::uint16_t>(0x1000, u16), "address in the controller's memory")),
                with_default(field("size", &S::size, integer<std::uint16_t>(1, u16), "bytes of a mailbox"), "from the PDOs"),
                required(field("control", &S::control, integer<std::uint8_t>(0, u8), "control byte: usually 26h, 22h, 64h, 20h")),
            },
            {},
            {}};
}

/// An object in a PDO; its bits are looked up later unless given.
Codec<ecat::PdoEntry> pdo_entry() {
    Codec<ecat::PdoEntry> c;
    const auto address = object_address();
    c.shape = address.shape;
    c.read = [read = address.read](Reader& reader, const Node& node, ecat::PdoEntry& out) {
        ObjectAddress value;
        if (!read(reader, node, value)) return false;
        out = {value.index, value.sub, value.bits};
        return true;
    };
    return c;
}

Table<ecat::PdoDescription> pdo_table() {
    using P = ecat::PdoDescription;
    return {"pdo.<direction>.available",
            "One PDO of the slave.",
            {
                required(field("pdo", &P::index, integer<std::uint16_t>(0x1600, 0x1BFF), "its mapping object: 16xxh, 17xxh, 1Axxh, 1Bxxh")),
                field("fixed", &P::fixed, boolean(), "its mapping cannot be changed"),
                required(field("objects", &P::entries, list(pdo_entry()),
                               "what it carries, in order; `60FDh/16` where it maps fewer bits than the object has")),
            },
            {},
            {}};
}

struct PdoDirection {
    ecat::PdoRules rules;
    std::vector<ecat::PdoDescription> available;
    std::vector<std::uint16_t> assigned;
};

Table<PdoDirection> pdo_direction_table() {
    using P = PdoDirection;
    return {
        "pdo.<direction>",
        "PDOs of one direction (rx: to the drive, tx: from it) and what may be changed.",
        {
            field_at<P>(
                "max_assigned", [](P & p) -> auto& { return p.rules.max_assigned; }, integer<std::uint8_t>(1, 32), "PDOs assigned at once"),
            field_at<P>(
                "max_entries", [](P & p) -> auto& { return p.rules.max_entries; }, integer<std::uint8_t>(1, 254), "objects in one PDO"),
            field_at<P>(
                "max_bytes", [](P & p) -> auto& { return p.rules.max_bytes; }, integer<std::uint16_t>(1, 1486), "bytes of the direction"),
            required(field("assigned", &P::assigned, list(integer<std::uint16_t>(0x1600, 0x1BFF)), "factory assignment (1C12h or 1C13h)")),
            required(field("available", &P::available, list(section(pdo_table())), "all PDOs")),
        },
        {},
        {}};
}

template <class RulesOf, class PdosOf, class AssignedOf>
Field<DeviceDescription> direction_field(std::string key, RulesOf rules, PdosOf pdos, AssignedOf assigned, std::string doc) {
    return required(field_via<DeviceDescription>(
        std::move(key), section(pdo_direction_table()),
        [=](DeviceDescription& d, const PdoDirection& p) {
            rules(d) = p.rules;
            pdos(d) = p.available;
            assigned(d) = p.assigned;
        },
        std::move(doc)));
}

Table<DeviceDescription> pdo_section_table() {
    using D = DeviceDescription;
    return {"pdo",
            "Process data as the drive offers it.",
            {
                direction_field(
                    "rx", [](D & d) -> auto& { return d.rx_rules; }, [](D & d) -> auto& { return d.rx_pdos; },
                    [](D & d) -> auto& { return d.rx_assigned; }, "to the drive"),
                direction_field(
                    "tx", [](D & d) -> auto& { return d.tx_rules; }, [](D & d) -> auto& { return d.tx_pdos; },
                    [](D & d) -> auto& { return d.tx_assigned; }, "from the drive"),
            },
            {},
            {}};
}

Table<PdoChoice> choice_table() {
    using P = PdoChoice;
    return {"mapping.<direction>",
            "A PDO that the runtime assigns.",
            {
                required(field("pdo", &P::pdo, object_address(), "one of the available PDOs")),
                with_default(field("objects", &P::objects, list(pdo_entry()), "what is mapped into it"), "as the drive has it"),
            },
            {},
            {}};
}

Table<DriveFile> mapping_table() {
    using F = DriveFile;
    return {"mapping",
            "What the runtime assigns and maps, unless a machine asks for something else.",
            {required(field("rx", &F::rx, list(section(choice_table())), "to the drive")),
             required(field("tx", &F::tx, list(section(choice_table())), "from the drive"))},
            {},
            {}};
}

Table<ObjectEntry> object_table() {
    using O = ObjectEntry;
    constexpr auto low = std::numeric_limits<std::int64_t>::min(), high = std::numeric_limits<std::int64_t>::max();
    return {
        "objects",
        "One object of the dictionary.",
        {
            required(field_via<O>(
                "object", object_address(), [](O& o, const ObjectAddress& a) { o.index = a.index, o.sub = a.sub; }, "index and sub-index")),
            required(field("name", &O::name, text(), "its name")),
            required(field("type", &O::type, data_type(), "its type")),
            field("access", &O::access, choice<Access>({{"ro", Access::ro}, {"rw", Access::rw}, {"wo", Access::wo}}), "by SDO"),
            field("map", &O::mappable,
                  choice<Mappable>({{"no", Mappable::no}, {"rx", Mappable::rx}, {"tx", Mappable::tx}, {"both", Mappable::both}}),
                  "into which PDOs"),
            field("value", &O::value, integer<std::int64_t>(low, high), "default"),
            field("minimum", &O::minimum, maybe(integer<std::int64_t>(low, high)), "least value that the drive accepts"),
            field("maximum", &O::maximum, maybe(integer<std::int64_t>(low, high)), "greatest value that the drive accepts"),
            field("text", &O::text, text(), "default of a STRING"),
        },
        {},
        {}};
}

Table<ecat::DcDescription> dc_table() {
    using D = ecat::DcDescription;
    return {"dc",
            "Distributed clocks.",
            {
                field("supported", &D::supported, boolean(), "has a clock and SYNC0"),
                field("required", &D::required, boolean(), "SYNC0 must run before SAFEOP"),
                field("clock_64bit", &D::clock_64bit, boolean(), "width of the clock"),
                with_default(field("minimum_cycle", &D::minimum_cycle, duration(), "shortest SYNC0 cycle"), "not stated"),
                with_default(field("cycle_multiple", &D::cycle_multiple, duration(), "the cycle must be a multiple of it"), "any"),
            },
            {},
            {}};
}

Codec<axes::DriveStop> drive_stop() {
    return choice<axes::DriveStop>({{"coast", axes::DriveStop::coast}, {"ramp", axes::DriveStop::ramp}});
}

Codec<axes::DriveAlarmKind> alarm_kind() {
    using K = axes::DriveAlarmKind;
    return choice<K>({{"other", K::other},
                      {"overspeed", K::overspeed},
                      {"following_error", K::following_error},
                      {"setpoint_leap", K::setpoint_leap},
                      {"undervoltage", K::undervoltage},
                      {"overload", K::overload},
                      {"encoder", K::encoder},
                      {"communication", K::communication},
                      {"negative_limit", K::negative_limit},
                      {"positive_limit", K::positive_limit},
                      {"emergency_stop", K::emergency_stop},
                      {"battery_low", K::battery_low},
                      {"reference_lost", K::reference_lost},
                      {"turn_overflow", K::turn_overflow},
                      {"power_cycle_pending", K::power_cycle_pending}});
}

Table<DriveProfile> motion_table() {
    using P = DriveProfile;
    return {
        "motion",
        "What the drive means to an axis.",
        {
            required(field("modes", &P::modes,
                           list(choice<DriveMode>({{"pp", DriveMode::profile_position},
                                                   {"pv", DriveMode::profile_velocity},
                                                   {"pt", DriveMode::profile_torque},
                                                   {"hm", DriveMode::homing},
                                                   {"csp", DriveMode::cyclic_position},
                                                   {"csv", DriveMode::cyclic_velocity},
                                                   {"cst", DriveMode::cyclic_torque}})),
                           "modes of operation that we use of it (6060h)")),
            field("homing_methods", &P::homing_methods, list(integer<std::int8_t>(-128, 127)), "6098h values that the manual documents"),
            field("velocity_counts_per_unit", &P::velocity_counts_per_unit, number(), "606Ch and 60FFh raw = counts/s times this"),
            field("torque_rated_raw", &P::torque_rated_raw, number(), "6077h and 6071h raw value of rated torque"),
            field("position_bits", &P::position_bits, integer<std::uint8_t>(8, 64), "width of the raw position"),
            field("probes", &P::probes, integer<std::uint8_t>(0, 2), "touch probes"),
            field("motor_has_encoder", &P::motor_has_encoder, boolean(), "false: the actual position is the command"),
            with_default(
                field("minimum_cycle_csp", &P::minimum_cycle_csp, duration(), "shortest cycle in cyclic synchronous position mode"),
                "not stated"),
            field("enable_delay", &P::enable_delay, duration(), "motion waits this long after enabling (brake)"),
            field("mode_change_delay", &P::mode_change_delay, duration(), "set-points wait this long after a mode change"),
            field("enable_timeout", &P::enable_timeout, duration(), "enabling that takes longer has failed"),
            field("mode_change_at_standstill", &P::mode_change_at_standstill, boolean(), "modes change only while it stands"),
            field("mode_change_interval", &P::mode_change_interval, duration(), "least time between two changes of 6060h"),
            field("mode_indeterminate", &P::mode_indeterminate, duration(), "6061h means nothing this long after a change of 6060h"),
            field("enable_status_bits", &P::enable_status_bits, integer<std::uint16_t>(0, u16),
                  "of 6041h, all set before Enable Operation"),
            field("brake_release", &P::brake_release, duration(), "after enabling the brake still holds: the drive loses earlier commands"),
            field("brake_hold", &P::brake_hold, duration(), "after disabling at standstill the motor holds until the brake does"),
            field("off_stop", &P::off_stop, drive_stop(), "power taken away while it moves"),
            field("fault_stop", &P::fault_stop, drive_stop(), "its reaction to a fault"),
            field("quick_stop_leaves", &P::quick_stop_leaves, boolean(), "Quick Stop Active ends by itself"),
            field("csp_interpolates", &P::csp_interpolates, boolean(), "a target is reached one cycle after the SYNC0 that brought it"),
            field("axes", &P::axes, integer<std::uint8_t>(1, 8), "axes in this drive"),
            field("object_offset", &P::object_offset, integer<std::uint16_t>(0, u16), "of the objects of each further axis"),
            field("pdo_offset", &P::pdo_offset, integer<std::uint16_t>(0, u16), "of the PDOs of each further axis"),
            field("input_bit_negative_limit", &P::input_bit_negative_limit, integer<std::uint8_t>(0, 31), "in 60FDh"),
            field("input_bit_positive_limit", &P::input_bit_positive_limit, integer<std::uint8_t>(0, 31), "in 60FDh"),
            field("input_bit_home", &P::input_bit_home, integer<std::uint8_t>(0, 31), "in 60FDh"),
            field_via<P>(
                "alarm_detail", object_address(),
                [](P& p, const ObjectAddress& a) { p.alarm_detail_index = a.index, p.alarm_detail_sub = a.sub; },
                "object that tells alarms apart which share a 603Fh code", "none"),
        },
        {},
        {}};
}

Table<DriveAlarmText> alarm_row_table() {
    using A = DriveAlarmText;
    return {"alarms",
            "One alarm of the drive.",
            {
                required(field("code", &A::code, integer<std::uint16_t>(1, u16), "603Fh")),
                with_default(field("detail", &A::detail, integer<std::uint32_t>(0, u32), "value of the detail object"), "the code alone"),
                field("panel", &A::panel, text(), "what the drive's own display shows"),
                required(field("english", &A::english, text(), "its name in English")),
                required(field("chinese", &A::chinese, text(), "its name in Chinese, as the manual prints it")),
                field("cause", &A::cause, text(), "why it comes"),
                field("remedy", &A::remedy, text(), "what to do"),
                field("resettable", &A::resettable, boolean(), "false: only a power cycle clears it"),
                field("warning", &A::warning, boolean(), "the drive goes on"),
                field("whole_drive", &A::whole_drive, boolean(), "common to all axes of the drive"),
                field("kind", &A::kind, alarm_kind(), "what it means, whatever its number"),
            },
            {},
            {}};
}

/// Fills in the bits of mapped objects and reports objects that the dictionary lacks or that may not be mapped.
class PdoResolver {
public:
    PdoResolver(Reader& reader, const DeviceDescription& device) : reader_(reader), device_(device) {}

    void resolve(ecat::PdoEntry& entry, bool rx, std::string_view place) const {
        const auto* object = find_object(device_, entry.index, entry.sub);
        const auto shown = show_object(entry.index, entry.sub);
        if (!object) {
            report(place, fmt::format("{} is mapped, but `objects` does not list it", shown), "add it to `objects` with its type");
            return;
        }
        if (entry.bits == 0) entry.bits = ecat::bit_size(object->type);
        if (object->mappable != Mappable::both && object->mappable != (rx ? Mappable::rx : Mappable::tx))
            report(place, fmt::format("{} cannot be mapped into {}", shown, rx ? "an RxPDO" : "a TxPDO"),
                   fmt::format("remove it, or correct its `map:` in `objects`"));
    }

    void report(std::string_view place, std::string what, std::string remedy) const {
        reader_.problem(reader_.find(place), "config.mapping", std::move(what), std::move(remedy));
    }

private:
    Reader& reader_;
    const DeviceDescription& device_;
};

void check_rules(const PdoResolver& resolver, const std::vector<PdoChoice>& chosen, const std::vector<ecat::PdoDescription>& available,
                 const ecat::PdoRules& rules, std::string_view place) {
    std::size_t bits = 0;
    if (chosen.size() > rules.max_assigned)
        resolver.report(place, fmt::format("{} PDOs are assigned, the drive takes {}", chosen.size(), rules.max_assigned), "use fewer");
    for (const auto& choice : chosen) {
        const ecat::PdoDescription* pdo = nullptr;
        for (const auto& a : available)
            if (a.index == choice.pdo.index) pdo = &a;
        if (!pdo) {
            resolver.report(place, fmt::format("PDO {:04X}h is not among those `available`", choice.pdo.index), "correct its number");
            continue;
        }
        if (pdo->fixed && !choice.objects.empty())
            resolver.report(place, fmt::format("PDO {:04X}h is fixed", choice.pdo.index), "remove its `objects`");
        const auto& entries = choice.objects.empty() ? pdo->entries : choice.objects;
        if (entries.size() > rules.max_entries)
            resolver.report(
                place, fmt::format("PDO {:04X}h maps {} objects, the drive takes {}", choice.pdo.index, entries.size(), rules.max_entries),
                "map fewer");
        for (const auto& e : entries) bits += e.bits;
    }
    if ((bits + 7) / 8 > rules.max_bytes)
        resolver.report(place, fmt::format("{} bytes are mapped, the drive takes {}", (bits + 7) / 8, rules.max_bytes),
                        "map fewer objects");
}

}  // namespace

Codec<std::int64_t> version_number() {
    auto c = integer<std::int64_t>(0, 1'000'000);
    c.shape.minimum = c.shape.maximum = static_cast<double>(format_version);
    c.read = [number = c.read](Reader& reader, const Node& node, std::int64_t& out) {
        if (!number(reader, node, out)) return false;
        if (out == format_version) return true;
        reader.problem(node.at, "config.version",
                       fmt::format("the file has format version {}, this program reads version {}", out, format_version),
                       out > format_version ? "use a newer taktwerk" : "write `version: 1`");
        return false;
    };
    return c;
}

Table<DriveFile> drive_table() {
    using F = DriveFile;
    const auto device = [](F& f) -> DeviceDescription& { return f.device; };
    Table<F> table{"drive file", "What one drive type is (for master and simulator) and what it means to an axis.", {}, {}, {}};
    auto& f = table.fields;
    f.push_back(version_field(&F::version));
    f.push_back(required(field_at<F>(
        "name", [](F & d) -> auto& { return d.profile.name; }, name(), "as machines name it: `profile: sv33-e`")));
    f.push_back(required(field_at<F>(
        "vendor", [](F & d) -> auto& { return d.profile.vendor; }, text(), "for people")));
    f.push_back(required(field_at<F>(
        "title", [](F & d) -> auto& { return d.profile.title; }, text(), "for people")));
    std::vector<Field<DeviceDescription>> bus{
        required(field_at<DeviceDescription>(
            "identity", [](DeviceDescription& d) -> DeviceDescription& { return d; }, section(identity_table()), "who it says it is")),
        field("mailbox", &DeviceDescription::mailbox, maybe(section(mailbox_table())), "acyclic services"),
        required(field("sync_managers", &DeviceDescription::sync_managers, list(section(sync_manager_table())),
                       "in the order of the controller")),
        field("fmmus", &DeviceDescription::fmmus, integer<std::uint8_t>(1, 16), "of the controller"),
        field("sync_manager_count", &DeviceDescription::sync_manager_count, integer<std::uint8_t>(1, 16), "of the controller"),
        field("process_ram", &DeviceDescription::process_ram, integer<std::uint16_t>(1, u16), "bytes from 1000h"),
        required(
            field("objects", &DeviceDescription::objects, list(section(object_table())), "of the dictionary, as far as they are used")),
        required(field_at<DeviceDescription>(
            "pdo", [](DeviceDescription& d) -> DeviceDescription& { return d; }, section(pdo_section_table()),
            "process data as the drive offers it")),
        field("dc", &DeviceDescription::dc, section(dc_table()), "distributed clocks"),
    };
    include_fields(f, device, Table<DeviceDescription>{{}, {}, std::move(bus), {}, {}});
    f.push_back(required(field_at<F>(
        "mapping", [](F& d) -> F& { return d; }, section(mapping_table()), "what the runtime maps")));
    f.push_back(required(field("motion", &F::profile, section(motion_table()), "what it means to an axis")));
    f.push_back(field_at<F>(
        "quirks", [](F & d) -> auto& { return d.profile.quirks; },
        list(choice<Quirk>({{"fault_low_nibble_f", Quirk::fault_low_nibble_f},
                            {"fault_reset_needs_disable", Quirk::fault_reset_needs_disable},
                            {"limit_stop_is_warning", Quirk::limit_stop_is_warning},
                            {"no_remote_bit", Quirk::no_remote_bit},
                            {"no_internal_limit_bit", Quirk::no_internal_limit_bit},
                            {"csp_bits_12_13_reserved", Quirk::csp_bits_12_13_reserved},
                            {"disable_may_coast", Quirk::disable_may_coast}})),
        "deviations from CiA 402, by name (axes/port/drive_profile.hpp)"));
    f.push_back(
        field("startup", &F::startup, list(section(startup_table())), "SDOs written on every bring-up, before those of the machine"));
    f.push_back(field_at<F>(
        "alarms", [](F & d) -> auto& { return d.profile.alarms; }, list(section(alarm_row_table())), "the drive's alarms"));
    f.push_back(field("alarm_file", &F::alarm_file, text(), "file beside this one with the alarms, where they are many"));
    f.push_back(field_at<F>(
        "assumed", [](F & d) -> auto& { return d.profile.assumed; }, list(text()),
        "what the manual leaves open and this file took, in words"));
    table.after = [](Reader& reader, const Node&, F& file) {
        const PdoResolver resolver(reader, file.device);
        for (auto& pdo : file.device.rx_pdos)
            for (auto& entry : pdo.entries) resolver.resolve(entry, true, "pdo.rx");
        for (auto& pdo : file.device.tx_pdos)
            for (auto& entry : pdo.entries) resolver.resolve(entry, false, "pdo.tx");
        for (auto& choice : file.rx)
            for (auto& entry : choice.objects) resolver.resolve(entry, true, "mapping.rx");
        for (auto& choice : file.tx)
            for (auto& entry : choice.objects) resolver.resolve(entry, false, "mapping.tx");
        check_rules(resolver, file.rx, file.device.rx_pdos, file.device.rx_rules, "mapping.rx");
        check_rules(resolver, file.tx, file.device.tx_pdos, file.device.tx_rules, "mapping.tx");
    };
    return table;
}

Table<AlarmFile> alarm_table() {
    using A = AlarmFile;
    return {"alarm file",
            "The alarms of one drive type.",
            {version_field(&A::version), required(field("alarms", &A::alarms, list(section(alarm_row_table())), "the drive's alarms"))},
            {},
            {}};
}

}  // namespace taktwerk::config
