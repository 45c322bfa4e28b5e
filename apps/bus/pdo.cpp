// taktwerk bus pdo [SLAVE]: what each slave exchanges, where it lies, and its present values.

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"
#include "ecat/diagnosis/object_value.hpp"

namespace taktwerk::apps {

namespace {

using ecat::PdoReport;
using ecat::SmUse;
using ecat::SyncManagerReport;

struct PdoOptions {
    std::shared_ptr<BusOptions> bus;
    std::string slave;
};

std::string_view name(std::optional<SmUse> use) {
    if (!use) return "unknown use";
    switch (*use) {
        case SmUse::mailbox_out: return "mailbox out";
        case SmUse::mailbox_in: return "mailbox in";
        case SmUse::outputs: return "outputs";
        case SmUse::inputs: break;
    }
    return "inputs";
}

std::string head_of(const SyncManagerReport& sm, Colours colours) {
    const auto& r = sm.registers;
    std::string text = toned(fmt::format("SM{} {}", sm.number, name(sm.use)), Tone::strong, colours);
    if (r.enabled()) text += fmt::format(": {} at {:04X}h, control {:02X}h", count_text(r.length, "byte"), r.start, r.control);
    else text += ": not programmed yet";
    if (sm.use != SmUse::outputs && sm.use != SmUse::inputs) return text;
    if (sm.pdos.empty()) return text + ", no PDO";
    if (r.enabled() && sm.mapped_bytes != r.length)
        text += toned(fmt::format(", but its PDOs take {}", sm.mapped_bytes), Tone::bad, colours);
    else if (!r.enabled()) text += fmt::format(", its PDOs take {}", count_text(sm.mapped_bytes, "byte"));
    return text;
}

std::string_view use_of(const ecat::Fmmu& fmmu) {
    // The status byte of a mailbox' sync manager, mapped so that nobody has to ask for it.
    if (fmmu.physical_start >= ecat::reg::sync_manager && fmmu.physical_start < ecat::reg::dc_receive_times) return "mailbox status";
    return fmmu.write ? (fmmu.read ? "outputs and inputs" : "outputs") : "inputs";
}

Json entry_json(const ecat::PdoEntryReport& entry) {
    Json json{{"index", entry.index}, {"sub", entry.sub}, {"bits", entry.bits}, {"bit_offset", entry.bit_offset}, {"name", entry.name}};
    if (entry.type != 0) json["type"] = ecat::type_name(entry.type);
    if (entry.value) json["value"] = ecat::value_text(entry.type, *entry.value);
    return json;
}

ecat::Script<Result<PdoReport>> ask(ecat::Bus& bus, ecat::BusSlave& slave) {
    if (slave.has_coe() && slave.mailbox.station == 0) {
        const Result<void> open = co_await ecat::open_mailbox(bus, slave);
        if (!open) co_return open.error();
    }
    co_return co_await ecat::read_pdos(bus, slave);
}

int report_pdos(BusSession& session, const PdoOptions& options) {
    const Result<ecat::Survey> found = session.look();
    if (!found) return fail(*options.bus, found.error());
    std::optional<std::size_t> only;
    if (!options.slave.empty()) {
        const Result<std::size_t> position = find_slave(*found, options.slave);
        if (!position) return fail(*options.bus, position.error());
        only = *position;
    }
    if (auto allowed = session.may_write(*found, "asking slaves for their objects"); !allowed) return fail(*options.bus, allowed.error());
    if (options.bus->operational) {
        if (auto up = session.bring_up(*found); !up) return fail(*options.bus, up.error());
        // A drive answers with its first inputs some cycles after it has reached OP.
        (void)session.probe().run_for(10 * session.configured().cycle).ok();
    } else {
        session.adopt(*found);
    }
    Json list = Json::array();
    int code = exit_ok;
    bool first = true;
    for (std::size_t position = 0; position < found->slaves.size(); ++position) {
        if (only && position != *only) continue;
        const Result<ecat::BusSlave*> slave = slave_at(session, *found, position);
        if (!slave) {
            code = fail(*options.bus, slave.error());
            continue;
        }
        const Result<PdoReport> report = session.probe().run(ask(session.bus(), **slave));
        if (!report) {
            code = fail(*options.bus, report.error());
            continue;
        }
        if (options.bus->json) list.push_back(pdo_json(*report));
        else fmt::print("{}{}", first ? "" : "\n", pdo_text(*report, colours_of_output()));
        first = false;
    }
    if (options.bus->json) print_json(Json{{"slaves", std::move(list)}});
    return code;
}

}  // namespace

std::string pdo_text(const PdoReport& report, Colours colours) {
    const Cell state = state_cell(report.state, false);
    std::string out = toned(report.subject, Tone::strong, colours) + ", " + toned(state.text, state.tone, colours) + "\n";
    for (const auto& sm : report.sync_managers) {
        out += "  " + head_of(sm, colours) + "\n";
        using Side = TextTable::Column::Side;
        TextTable table{{{"PDO"},
                         {"byte", Side::right},
                         {"bits", Side::right},
                         {"object"},
                         {"name", Side::left, 26},
                         {"type"},
                         {"value", Side::left, 24}}};
        for (const auto& pdo : sm.pdos) {
            std::string title = fmt::format("{:04X}h", pdo.index);
            if (pdo.entries.empty()) table.add({title, "", "", Cell{"(empty)", Tone::faint}});
            for (const auto& entry : pdo.entries) {
                const std::string offset = entry.bit_offset % 8 == 0 && entry.bits % 8 == 0
                                               ? fmt::format("{}", entry.bit_offset / 8)
                                               : fmt::format("{}.{}", entry.bit_offset / 8, entry.bit_offset % 8);
                if (entry.index == 0) table.add({title, offset, std::to_string(entry.bits), Cell{"gap", Tone::faint}});
                else
                    table.add({title, offset, std::to_string(entry.bits), ecat::object_text(entry.index, entry.sub), entry.name,
                               entry.type != 0 ? ecat::type_name(entry.type) : std::string{},
                               entry.value ? ecat::value_text(entry.type, *entry.value) : std::string{}});
                title.clear();
            }
        }
        if (!table.empty()) out += table.text(colours, 4);
    }
    for (const auto& [number, fmmu] : report.fmmus)
        out += fmt::format("  FMMU{} {}: {} of {:08X}h at {:04X}h\n", number, use_of(fmmu), count_text(fmmu.length, "byte"),
                           fmmu.logical_start, fmmu.physical_start);
    if (report.error) out += "  " + toned("not all could be read", Tone::bad, colours) + ": " + wrapped(report.error->text(), 4) + "\n";
    return out;
}

Json pdo_json(const PdoReport& report) {
    Json json{{"subject", report.subject}, {"position", report.position}, {"state", ecat::name(report.state)}};
    json["sync_managers"] = Json::array();
    for (const auto& sm : report.sync_managers) {
        Json one{{"number", sm.number},
                 {"use", name(sm.use)},
                 {"start", sm.registers.start},
                 {"length", sm.registers.length},
                 {"control", sm.registers.control},
                 {"enabled", sm.registers.enabled()},
                 {"mapped_bytes", sm.mapped_bytes},
                 {"pdos", Json::array()}};
        for (const auto& pdo : sm.pdos) {
            Json entries = Json::array();
            for (const auto& entry : pdo.entries) entries.push_back(entry_json(entry));
            one["pdos"].push_back(Json{{"index", pdo.index}, {"entries", std::move(entries)}});
        }
        json["sync_managers"].push_back(std::move(one));
    }
    json["fmmus"] = Json::array();
    for (const auto& [number, fmmu] : report.fmmus)
        json["fmmus"].push_back(Json{{"number", number},
                                     {"logical", fmmu.logical_start},
                                     {"length", fmmu.length},
                                     {"physical", fmmu.physical_start},
                                     {"read", fmmu.read},
                                     {"write", fmmu.write}});
    if (report.error) json["incomplete"] = error_json(*report.error);
    return json;
}

void add_bus_pdo(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("pdo", "process data: sync managers, FMMUs, PDOs with entries and offsets, values in SAFEOP and OP");
    auto options = std::make_shared<PdoOptions>();
    options->bus = add_bus_options(*sub);
    sub->add_option("SLAVE", options->slave, "position or name; default: all");
    add_operational(*sub, *options->bus);
    sub->callback([&action, options] {
        action = [options] { return with_bus(*options->bus, [&](BusSession& session) { return report_pdos(session, *options); }); };
    });
}

}  // namespace taktwerk::apps
