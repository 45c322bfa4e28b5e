#include "config/drive_file/device_tables.hpp"

#include <algorithm>
#include <limits>

#include "config/drive_file/startup_entry.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using ecat::Access;
using ecat::DeviceDescription;
using ecat::Mappable;
using ecat::ObjectEntry;
using ecat::SmUse;

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
            field("revision_rule", &D::revision_rule, revision_rule(), "any · at_least: this revision or a later one · exact"),
            field("also_accepted", &D::also_accepted, list(section(identity_pair_table())),
                  "further vendor and product pairs, where manuals contradict themselves"),
        },
        {},
        {}};
}

Table<ecat::BootstrapDescription> bootstrap_table() {
    using B = ecat::BootstrapDescription;
    return {"mailbox.bootstrap",
            "The mailboxes in BOOT, as words 14h to 17h of the EEPROM say.",
            {
                required(field("out_start", &B::out_start, integer<std::uint16_t>(0x1000, u16), "master to slave: address")),
                required(field("out_size", &B::out_size, integer<std::uint16_t>(16, u16), "and bytes")),
                required(field("in_start", &B::in_start, integer<std::uint16_t>(0x1000, u16), "slave to master: address")),
                required(field("in_size", &B::in_size, integer<std::uint16_t>(16, u16), "and bytes")),
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
                field("foe", &M::foe, boolean(), "files over EtherCAT; only the simulated slave looks at it"),
                field("eoe", &M::eoe, boolean(), "Ethernet over EtherCAT; only the simulated slave looks at it"),
                with_default(field("bootstrap", &M::bootstrap, maybe(section(bootstrap_table())),
                                   "its mailboxes in BOOT; only the simulated slave looks at it"),
                             "no BOOT"),
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
                required(field("start", &S::start, integer<std::uint16_t>(0x0900, u16),
                               "address in the controller's memory, or of the registers that it fills: 0F00h")),
                with_default(field("size", &S::size, integer<std::uint16_t>(1, u16), "bytes of a mailbox"), "from the PDOs"),
                required(field("control", &S::control, integer<std::uint8_t>(0, u8), "control byte: usually 26h, 22h, 64h, 20h")),
            },
            {},
            {}};
}

}  // namespace

Table<ecat::PdoDescription> pdo_table() {
    using P = ecat::PdoDescription;
    return {"pdo.<direction>.available",
            "One PDO of the slave.",
            {
                required(field("pdo", &P::index, integer<std::uint16_t>(0x1600, 0x1BFF), "its mapping object: 16xxh, 17xxh, 1Axxh, 1Bxxh")),
                field("fixed", &P::fixed, boolean(), "its mapping cannot be changed"),
                with_default(field("sync_manager", &P::sync_manager, maybe(integer<std::uint8_t>(0, 15)), "that it is assigned to"),
                             "the first of its direction"),
                required(
                    field("objects", &P::entries, list(pdo_entry()),
                          "what it carries, in order; `60FDh/16` where it maps fewer bits than the object has, `gap/5` for 5 unused bits")),
            },
            {},
            {}};
}

namespace {

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
            field_at<P>(
                "assignment_fixed", [](P & p) -> auto& { return p.rules.assignment_fixed; }, boolean(), "nothing else can be assigned"),
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

constexpr auto i64_low = std::numeric_limits<std::int64_t>::min(), i64_high = std::numeric_limits<std::int64_t>::max();

Codec<axes::ParameterEffect> parameter_effect() {
    using E = axes::ParameterEffect;
    return choice<E>({{"at_once", E::at_once},
                      {"at_standstill", E::at_standstill},
                      {"when_enabled", E::when_enabled},
                      {"after_restart", E::after_restart},
                      {"after_saving", E::after_saving}});
}

Codec<axes::ParameterChange> parameter_change() {
    using C = axes::ParameterChange;
    return choice<C>({{"any_time", C::any_time}, {"disabled", C::disabled}, {"never", C::never}});
}

}  // namespace

Table<ObjectRow> object_table() {
    using R = ObjectRow;
    const auto object = [](R& r) -> ObjectEntry& { return r.object; };
    const auto parameter = [](R& r) -> axes::DriveParameter& { return r.parameter; };
    Table<R> table{
        "objects",
        "One object of the dictionary, or one parameter of the drive.",
        {
            field_via<R>(
                "object", object_address(),
                [](R& r, const ObjectAddress& a) {
                    r.object.index = a.index, r.object.sub = a.sub;
                    r.parameter.address = {a.index, a.sub};
                },
                "index and sub-index"),
            field_via<R>(
                "register", integer<std::uint16_t>(0, u16),
                [](R& r, const std::uint16_t& number) {
                    r.parameter.address = {number, 0}, r.is_register = true;
                },
                "number of a register, for drives without a dictionary"),
            field_at<R>(
                "reach", [parameter](R & r) -> auto& { return parameter(r).reach; },
                choice<axes::ParameterReach>({{"bus", axes::ParameterReach::bus}, {"maker_tool", axes::ParameterReach::maker_tool}}),
                "maker_tool: panel or PC tool alone, the manual prints no address"),
            required(field_at<R>(
                "name", [object](R & r) -> auto& { return object(r).name; }, text(), "its name in English")),
            field_at<R>(
                "parameter", [parameter](R & r) -> auto& { return parameter(r).parameter; }, text(),
                "what the manual calls it: P05.10, PA17, Pr098"),
            field_at<R>(
                "chinese", [parameter](R & r) -> auto& { return parameter(r).chinese; }, text(), "its name as the manual prints it"),
            required(field_at<R>(
                "type", [object](R & r) -> auto& { return object(r).type; }, data_type(), "its type")),
            field_at<R>(
                "access", [object](R & r) -> auto& { return object(r).access; },
                choice<Access>({{"ro", Access::ro}, {"rw", Access::rw}, {"wo", Access::wo}}), "by SDO"),
            field_at<R>(
                "map", [object](R & r) -> auto& { return object(r).mappable; },
                choice<Mappable>({{"no", Mappable::no}, {"rx", Mappable::rx}, {"tx", Mappable::tx}, {"both", Mappable::both}}),
                "into which PDOs"),
            field_via<R>(
                "value", integer<std::int64_t>(i64_low, i64_high),
                [](R& r, const std::int64_t& value) { r.object.value = value, r.has_value = true; },
                "as it leaves the factory, raw: as the manual states it, unless `factory` says otherwise", "the manual prints none"),
            field_via<R>(
                "factory", choice<axes::FactoryValue>({{"assumed", axes::FactoryValue::assumed}}),
                [](R& r, const axes::FactoryValue& factory) { r.parameter.factory = factory; },
                "assumed: `value` is ours, the manual leaves it open or contradicts itself", "stated, with a `value`"),
            field_via<R>(
                "commissioned", integer<std::int64_t>(i64_low, i64_high),
                [](R& r, const std::int64_t& value) { r.object.value = value, r.has_commissioned = true; },
                "instead of `value`: what the simulated drive begins with, raw; nothing is claimed of a real one", "0"),
            field_at<R>(
                "minimum", [object](R & r) -> auto& { return object(r).minimum; }, maybe(integer<std::int64_t>(i64_low, i64_high)),
                "least value that the drive accepts, raw"),
            field_at<R>(
                "maximum", [object](R & r) -> auto& { return object(r).maximum; }, maybe(integer<std::int64_t>(i64_low, i64_high)),
                "greatest value that the drive accepts, raw"),
            field_at<R>(
                "text", [object](R & r) -> auto& { return object(r).text; }, text(), "default of a STRING"),
            field_at<R>(
                "unit", [parameter](R & r) -> auto& { return parameter(r).unit; }, text(), "of the value times `scale`: ms, %, rpm"),
            field_at<R>(
                "scale", [parameter](R & r) -> auto& { return parameter(r).scale; }, number(), "what one raw count is in `unit`"),
            field_at<R>(
                "meaning", [parameter](R & r) -> auto& { return parameter(r).meaning; }, text(), "of the values, where they are a choice"),
            field_at<R>(
                "effective", [parameter](R & r) -> auto& { return parameter(r).effect; }, parameter_effect(), "when a new value counts"),
            field_at<R>(
                "change", [parameter](R & r) -> auto& { return parameter(r).change; }, parameter_change(), "when the drive takes a write"),
            field_at<R>(
                "action", [parameter](R & r) -> auto& { return parameter(r).action; }, boolean(),
                "writing it does something (store, restore, clear turns), or nothing (a filler): never part of a saved set"),
            field_at<R>(
                "section", [parameter](R & r) -> auto& { return parameter(r).section; }, text(), "of the manual"),
        },
        {},
        {}};
    table.after = [](Reader& reader, const Node& node, R& row) {
        const bool addressed = row.object.index != 0 || row.is_register;
        const bool tool = row.parameter.reach == axes::ParameterReach::maker_tool;
        if (!addressed && !tool)
            reader.problem(node.at, "config.object_address", "a row needs its `object:` or its `register:`",
                           "add `object: 2005h:0B`, `register: 98` for a drive without a dictionary, or `reach: maker_tool`");
        if (tool && (addressed || row.parameter.parameter.empty()))
            reader.problem(node.at, "config.object_address", "what only the maker's tool reaches has a `parameter:` and no address",
                           "write `parameter: PA17`, and remove `object:` or `reach:`");
        const bool assumed = row.parameter.factory == axes::FactoryValue::assumed;
        if ((row.has_value && row.has_commissioned) || (assumed && !row.has_value))
            reader.problem(node.at, "config.factory_value", "a row has a factory `value`, stated or assumed, or a `commissioned` one",
                           "keep `value` where the manual prints it, `value` and `factory: assumed` where it is ours, else `commissioned`");
        if (row.has_value && !assumed) row.parameter.factory = axes::FactoryValue::stated;
        row.parameter.name = row.object.name;
        row.parameter.bits = ecat::bit_size(row.object.type);
        row.parameter.is_signed = ecat::is_signed(row.object.type);
        row.parameter.value = row.object.value;
        row.parameter.minimum = row.object.minimum;
        row.parameter.maximum = row.object.maximum;
        if (row.object.access == Access::ro) row.parameter.change = axes::ParameterChange::never;
    };
    return table;
}

namespace {

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
                with_default(field("cycles", &D::cycles, list(duration()), "the only SYNC0 cycles that it knows"), "any"),
            },
            {},
            {}};
}

Table<ecat::ModuleDescription> module_table() {
    using M = ecat::ModuleDescription;
    return {"slots.modules.<name>",
            "A module: PDOs and ident, as in slot 0.",
            {
                with_default(field("ident", &M::ident, integer<std::uint32_t>(1, u32), "written to F030h, found in F050h"),
                             "not stated: neither is looked at"),
                field("rx", &M::rx_pdos, list(section(pdo_table())), "PDOs to the drive"),
                field("tx", &M::tx_pdos, list(section(pdo_table())), "PDOs from the drive"),
            },
            {},
            {}};
}

Table<ecat::SlotDescription> slot_table() {
    using S = ecat::SlotDescription;
    return {
        "slots",
        "A modular slave (ETG.5001): each slot holds one of the modules.",
        {
            required(field("count", &S::count, integer<std::uint8_t>(1, 255), "slots")),
            field("index_increment", &S::index_increment, integer<std::uint16_t>(0, u16), "between the objects of two slots, such as 800h"),
            field("pdo_increment", &S::pdo_increment, integer<std::uint16_t>(0, u16), "between the PDOs of two slots, such as 40h"),
            field("may_be_empty", &S::may_be_empty, boolean(), "a slot may hold no module"),
            required(field("modules", &S::modules,
                           by_name(section(module_table()), [](ecat::ModuleDescription& m) -> std::string& { return m.name; }),
                           "what a slot can hold")),
        },
        {},
        {}};
}

}  // namespace

Codec<ecat::PdoEntry> pdo_entry() {
    Codec<ecat::PdoEntry> c;
    const auto address = object_address();
    c.shape.kind = Shape::Kind::either;
    c.shape.alternatives = {std::make_shared<const Shape>(address.shape), std::make_shared<const Shape>(text().shape)};
    c.read = [read = address.read](Reader& reader, const Node& node, ecat::PdoEntry& out) {
        constexpr std::string_view gap = "gap/";
        if (node.kind == Node::Kind::scalar && node.text.compare(0, gap.size(), gap) == 0) {
            Node bits = node;
            bits.text = node.text.substr(gap.size());
            const auto count = read_integer(reader, bits, 1, 255);
            if (count) out = {0, 0, static_cast<std::uint8_t>(*count)};
            return count.has_value();
        }
        ObjectAddress value;
        if (!read(reader, node, value)) return false;
        out = {value.index, value.sub, value.bits};
        return true;
    };
    return c;
}

Codec<std::string> checked_against() {
    auto c = text();
    c.shape.kind = Shape::Kind::choice;
    c.shape.choices = {"unit", "vendor_file", "project", "inferred"};
    c.read = [words = c.shape.choices](Reader& reader, const Node& node, std::string& out) {
        const auto index = read_choice(reader, node, words);
        if (index) out = words[*index];
        return index.has_value();
    };
    return c;
}

Codec<ecat::RevisionRule> revision_rule() {
    using R = ecat::RevisionRule;
    return choice<R>({{"any", R::any}, {"at_least", R::at_least}, {"exact", R::exact}});
}

std::vector<Field<DeviceDescription>> controller_fields() {
    return {
        required(field_at<DeviceDescription>(
            "identity", [](DeviceDescription& d) -> DeviceDescription& { return d; }, section(identity_table()), "who it says it is")),
        field("mailbox", &DeviceDescription::mailbox, maybe(section(mailbox_table())), "acyclic services"),
        field("sync_managers", &DeviceDescription::sync_managers, list(section(sync_manager_table())), "in the order of the controller"),
        field("fmmus", &DeviceDescription::fmmus, integer<std::uint8_t>(1, 16), "of the controller"),
        field("sync_manager_count", &DeviceDescription::sync_manager_count, integer<std::uint8_t>(1, 16), "of the controller"),
        field("process_ram", &DeviceDescription::process_ram, integer<std::uint16_t>(1, u16), "bytes from 1000h"),
        field("slots", &DeviceDescription::slots, section(slot_table()), "of a modular slave"),
        field("dc", &DeviceDescription::dc, section(dc_table()), "distributed clocks"),
    };
}

std::vector<Field<DeviceDescription>> device_fields() {
    auto fields = controller_fields();
    const auto sync_managers = std::find_if(fields.begin(), fields.end(), [](const auto& f) { return f.info.key == "sync_managers"; });
    *sync_managers = required(std::move(*sync_managers));
    const auto slots = std::find_if(fields.begin(), fields.end(), [](const auto& f) { return f.info.key == "slots"; });
    fields.insert(slots, required(field_at<DeviceDescription>(
                             "pdo", [](DeviceDescription& d) -> DeviceDescription& { return d; }, section(pdo_section_table()),
                             "process data as the drive offers it")));
    return fields;
}

}  // namespace taktwerk::config
