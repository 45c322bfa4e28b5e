// What `esi show` says, for scripts.

#include <fmt/format.h>

#include "apps/esi/esi.hpp"
#include "apps/esi/names.hpp"

namespace taktwerk::apps {

namespace {

using namespace ecat::esi;

EsiJson pdos_json(const std::vector<EsiPdo>& pdos) {
    EsiJson list = EsiJson::array();
    for (const auto& pdo : pdos) {
        EsiJson entries = EsiJson::array();
        for (const auto& entry : pdo.entries)
            entries.push_back(
                {{"index", entry.index}, {"sub", entry.sub}, {"bits", entry.bits}, {"type", entry.type}, {"name", entry.name}});
        EsiJson one{{"index", pdo.index},         {"name", pdo.name},          {"fixed", pdo.fixed},
                    {"mandatory", pdo.mandatory}, {"virtual", pdo.is_virtual}, {"excludes", pdo.excludes}};
        if (pdo.sync_manager) one["sync_manager"] = *pdo.sync_manager;
        one["entries"] = std::move(entries);
        list.push_back(std::move(one));
    }
    return list;
}

EsiJson init_commands_json(const std::vector<EsiInitCommand>& commands) {
    EsiJson list = EsiJson::array();
    for (const auto& one : commands) {
        std::string data;
        for (const auto byte : one.data) data += fmt::format("{:02X}", std::to_integer<unsigned>(byte));
        list.push_back({{"transitions", one.transitions},
                        {"index", one.index},
                        {"sub", one.sub},
                        {"data", data},
                        {"complete_access", one.complete_access},
                        {"comment", one.comment}});
    }
    return list;
}

EsiJson objects_json(const std::vector<EsiObject>& objects) {
    EsiJson list = EsiJson::array();
    for (const auto& object : objects) {
        EsiJson one{{"index", object.index}, {"sub", object.sub},   {"name", object.name},
                    {"type", object.type},   {"bits", object.bits}, {"access", esi_access_name(object.access)}};
        if (object.mappable != ecat::Mappable::no) one["map"] = esi_mappable_name(object.mappable);
        if (object.value) one["value"] = *object.value;
        if (object.minimum) one["minimum"] = *object.minimum;
        if (object.maximum) one["maximum"] = *object.maximum;
        if (!object.text.empty()) one["text"] = object.text;
        list.push_back(std::move(one));
    }
    return list;
}

EsiJson errors_json(const std::vector<Error>& errors) {
    EsiJson list = EsiJson::array();
    for (const auto& error : errors)
        list.push_back({{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}});
    return list;
}

EsiJson op_modes_json(const std::vector<EsiOpMode>& modes) {
    EsiJson list = EsiJson::array();
    for (const auto& mode : modes)
        list.push_back({{"name", mode.name},
                        {"description", mode.description},
                        {"assign_activate", mode.assign_activate},
                        {"sync0_cycle_ns", mode.sync0_cycle.count()},
                        {"sync0_factor", mode.sync0_factor},
                        {"sync0_shift_ns", mode.sync0_shift.count()},
                        {"sync1_cycle_ns", mode.sync1_cycle.count()},
                        {"sync1_factor", mode.sync1_factor},
                        {"sync1_shift_ns", mode.sync1_shift.count()}});
    return list;
}

EsiJson mailbox_json(const EsiMailbox& mailbox) {
    EsiJson json{{"protocols", mailbox.other_protocols}};
    if (mailbox.coe)
        json["coe"] = {{"sdo_info", mailbox.coe->sdo_info},     {"complete_access", mailbox.coe->complete_access},
                       {"pdo_assign", mailbox.coe->pdo_assign}, {"pdo_config", mailbox.coe->pdo_config},
                       {"pdo_upload", mailbox.coe->pdo_upload}, {"segmented_sdo", mailbox.coe->segmented_sdo}};
    json["init_commands"] = init_commands_json(mailbox.init_commands);
    return json;
}

}  // namespace

EsiJson esi_show_json(const std::string& vendor, const EsiReading& reading) {
    const auto& device = reading.device;
    const auto& head = device.heading;
    EsiJson json{{"type", head.type},
                 {"name", head.name},
                 {"name_chinese", head.chinese},
                 {"vendor_name", vendor},
                 {"vendor", head.identity.vendor},
                 {"product", head.identity.product},
                 {"revision", head.identity.revision},
                 {"check_revision", head.check_revision},
                 {"hidden", head.hidden},
                 {"profiles", device.profiles}};
    if (device.ebus_current) json["ebus_current_ma"] = *device.ebus_current;
    json["sync_managers"] = EsiJson::array();
    for (const auto& sm : device.sync_managers)
        json["sync_managers"].push_back({{"use", sm.use ? esi_use_name(*sm.use) : ""},
                                         {"start", sm.start},
                                         {"size", sm.size},
                                         {"control", sm.control},
                                         {"enable", sm.enable}});
    json["rx"] = pdos_json(device.rx), json["tx"] = pdos_json(device.tx);
    if (device.mailbox) json["mailbox"] = mailbox_json(*device.mailbox);
    if (device.has_dc) json["op_modes"] = op_modes_json(device.op_modes);
    if (device.slots) {
        json["slots"] = {{"maximum", device.slots->maximum},
                         {"pdo_increment", device.slots->pdo_increment},
                         {"index_increment", device.slots->index_increment}};
        json["modules"] = EsiJson::array();
        for (const auto& module : device.modules)
            json["modules"].push_back({{"type", module.type},
                                       {"ident", module.ident},
                                       {"name", module.name},
                                       {"rx", pdos_json(module.rx)},
                                       {"tx", pdos_json(module.tx)},
                                       {"init_commands", init_commands_json(module.init_commands)}});
    }
    json["objects"] = objects_json(device.objects);
    json["problems"] = errors_json(reading.problems), json["remarks"] = errors_json(reading.remarks);
    json["unread"] = EsiJson::array();
    for (const auto& part : reading.unread) json["unread"].push_back({{"path", part.path}, {"count", part.count}, {"line", part.line}});
    return json;
}

}  // namespace taktwerk::apps
