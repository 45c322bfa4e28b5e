#include "hmi_bridge/socket/json_bus.hpp"

#include "ecat/bringup/bus.hpp"
#include "ecat/diagnosis/port_errors.hpp"
#include "ecat/diagnosis/running_survey.hpp"
#include "ecat/wire/al_status.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "hmi_bridge/socket/json_writer.hpp"
#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {
namespace {

using ecat::BusSlave;
using ecat::Survey;
using ecat::SurveyedSlave;

/// Where a slave stands: empty on a bus whose tree is not known.
const ecat::SlavePlace* place_of(const Survey& survey, std::size_t position) {
    if (!survey.topology || position >= survey.topology->slaves.size()) return nullptr;
    return &survey.topology->slaves[position];
}

void put_position(JsonWriter& json, std::string_view key, std::optional<std::size_t> position) {
    json.key(key);
    if (position) json.value(*position);
    else json.value(std::nullopt);
}

void put_ports(JsonWriter& json, const Survey& survey, std::size_t position) {
    const auto* place = place_of(survey, position);
    json.open("ports", '[');
    for (unsigned p = 0; p < ecat::ports_per_slave; ++p) {
        const auto& port = survey.slaves[position].ports[p];
        json.open('{');
        json.field("link", port.link);
        json.field("open", port.open);
        json.field("at_other_end", ecat::neighbour(survey, position, p));  // in words; empty: nobody
        put_position(json, "child", place != nullptr ? place->child[p] : std::nullopt);
        json.field("lost_links", port.counters.lost_links);
        json.field("rx_errors", port.counters.rx_errors);
        json.field("invalid_frames", port.counters.invalid_frames);
        json.field("forwarded_errors", port.counters.forwarded_errors);
        json.close('}');
    }
    json.close(']');
}

void put_al(JsonWriter& json, ecat::AlState state, bool error, std::uint16_t code) {
    json.field("state", ecat::name(state));
    json.field("al_error", error);
    json.field("al_status_code", code);
    json.field("al_status_text", code != 0 ? ecat::al_status_info(code).text : std::string_view{});
    json.field("al_status_remedy", code != 0 ? ecat::al_status_info(code).remedy : std::string_view{});
}

void put_identity(JsonWriter& json, const ecat::Identity& identity) {
    json.field("vendor", identity.vendor);
    json.field("product", identity.product);
    json.field("revision", identity.revision);
    json.field("serial", identity.serial);
}

/// What the machine knows of one that it has configured.
void put_configured(JsonWriter& json, const ecat::Bus& bus, const BusSlave& slave, const runtime::Snapshot* snapshot) {
    json.field("index", slave.index);  // among `slaves` of `state`
    json.field("group", slave.config->hot_connect);
    json.field("away", slave.away());
    if (snapshot != nullptr && slave.index < snapshot->slaves.size()) {
        const auto& health = snapshot->slaves[slave.index];
        json.field("fresh", health.fresh);
        json.field("age", health.age);
        json.field("emergency_code", health.emergency_code);
    }
    json.field("dc", slave.dc);
    json.field("reference_clock", bus.reference == slave.index);
    json.field("dc_delay_ns", slave.dc_delay);
    json.field("dc_difference_ns", slave.dc_difference);
    json.field("trouble", slave.last_trouble);  // why it does not come back; empty: it does
    json.field("not_exchanged", slave.not_exchanged);
}

void put_on_cable(JsonWriter& json, const ecat::Bus& bus, const Survey& survey, std::size_t position, const runtime::Snapshot* snapshot) {
    const auto& slave = survey.slaves[position];
    const auto* known = ecat::slave_at(bus, position);
    const auto* place = place_of(survey, position);
    json.open('{');
    json.field("position", position);
    json.field("name", slave.name);
    json.field("configured", known != nullptr);
    json.field("device", slave.expected);
    json.field("station", slave.found.station);
    put_identity(json, slave.found.identity);
    put_position(json, "parent", place != nullptr ? place->parent : std::nullopt);
    put_position(json, "parent_port", place != nullptr && place->parent ? std::optional<std::size_t>(place->parent_port) : std::nullopt);
    put_position(json, "entry_port", place != nullptr ? std::optional<std::size_t>(place->entry_port) : std::nullopt);
    put_position(json, "depth", place != nullptr ? std::optional<std::size_t>(place->depth) : std::nullopt);
    put_al(json, slave.state, slave.al_error, slave.al_code);
    put_ports(json, survey, position);
    json.field("processing_unit_errors", slave.processing_unit_errors);
    json.field("pdi_errors", slave.pdi_errors);
    json.field("sm_watchdogs", slave.sm_watchdogs);
    json.field("unread", slave.found.error ? slave.found.error->what : std::string{});  // why ports and counters are not of now
    if (known != nullptr) put_configured(json, bus, *known, snapshot);
    json.close('}');
}

/// Of the configuration, and not on the cable now.
void put_missing(JsonWriter& json, const ecat::Bus& bus, const BusSlave& slave, const runtime::Snapshot* snapshot) {
    json.open('{');
    json.field("position", std::nullopt);
    json.field("name", slave.config->name);
    json.field("configured", true);
    json.field("device", slave.config->device ? std::string_view(slave.config->device->name) : std::string_view{});
    put_identity(json, slave.found.identity);
    put_al(json, ecat::AlState::unknown, false, 0);
    put_configured(json, bus, slave, snapshot);
    json.close('}');
}

void put_error(JsonWriter& json, const Error& error) {
    json.open('{');
    json.field("code", error.code);
    json.field("subject", error.subject);
    json.field("what", error.what);
    json.field("remedy", error.remedy);
    json.close('}');
}

void put_trouble(JsonWriter& json, const Survey& survey, ecat::Master& master, const runtime::Snapshot* snapshot,
                 const MachineLink& machine) {
    json.key("trouble");
    json.raw(snapshot != nullptr ? bus_alarms_json(*snapshot, machine) : std::string("[]"));
    json.open("findings", '[');  // what the counters speak of, the worst cable first
    for (const auto& finding : ecat::port_findings(survey)) {
        json.open('{');
        json.field("position", finding.position);
        json.field("port", finding.port);
        json.field("text", finding.text);
        json.close('}');
    }
    json.close(']');
    json.open("remarks", '[');
    if (const auto remark = ecat::ring_remark(survey)) put_error(json, *remark);
    for (const auto& remark : survey.remarks) put_error(json, remark);
    if (master.phase() == ecat::Master::Phase::failed) put_error(json, master.failure());
    json.close(']');
    json.open("notes", '[');
    for (const auto& note : master.notes()) json.value(note);
    json.close(']');
}

}  // namespace

std::string bus_json(ecat::Master& master, const Survey& survey, const runtime::Snapshot* snapshot, const MachineLink& machine) {
    const auto& bus = master.bus();
    JsonWriter json(survey.slaves.size() * 1536 + 4096);
    json.open('{');
    json.field("phase", word(master.phase()));
    json.field("progress", master.progress());
    json.field("interface", machine.layout().interface);  // empty: simulated
    json.field("ring", ecat::name(survey.ring.shape));
    json.field("tree_known", survey.topology.has_value());
    json.open("slaves", '[');
    for (std::size_t position = 0; position < survey.slaves.size(); ++position) put_on_cable(json, bus, survey, position, snapshot);
    for (const auto& slave : bus.slaves)
        if (!slave->position_now || slave->away() || *slave->position_now >= survey.slaves.size()) put_missing(json, bus, *slave, snapshot);
    json.close(']');
    if (snapshot != nullptr) {
        json.key("statistics");
        json.raw(bus_statistics_json(*snapshot));
    }
    put_trouble(json, survey, master, snapshot, machine);
    json.close('}');
    return json.take();
}

}  // namespace taktwerk::hmi
