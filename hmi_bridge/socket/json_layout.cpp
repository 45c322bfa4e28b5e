#include "hmi_bridge/socket/json_layout.hpp"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/socket/json_number.hpp"
#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {
namespace {

using Json = nlohmann::ordered_json;

std::string text(Json json) {
    spell_out_numbers(json);
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// By the name of the point; those with nothing are left out.
Json texts_of(const std::vector<std::string>& names, const std::vector<std::string>& units) {
    auto out = Json::object();
    for (std::size_t i = 0; i < names.size() && i < units.size(); ++i)
        if (!units[i].empty()) out[names[i]] = units[i];
    return out;
}

Json finite_or_null(double limit) { return std::isfinite(limit) ? Json(limit) : Json(nullptr); }

}  // namespace

std::string layout_json(const runtime::MachineLayout& layout) {
    Json out{{"machine", layout.machine}, {"cycle_ns", count(layout.cycle)}};
    auto& axes = out["axes"] = Json::array();
    for (const auto& axis : layout.axes)
        axes.push_back(Json{{"name", axis.name},
                            {"unit", axis.unit},
                            {"disabled", axis.disabled},
                            {"simulated", axis.simulated},
                            {"jog_slow", axis.jog_slow},
                            {"jog_fast", axis.jog_fast},
                            {"position_min", finite_or_null(axis.position_min)},
                            {"position_max", finite_or_null(axis.position_max)},
                            {"velocity_limit", axis.velocity_limit},
                            {"acceleration_limit", axis.acceleration_limit},
                            {"deceleration", axis.deceleration},
                            {"jerk_limit", finite_or_null(axis.jerk_limit)},
                            {"following_window", finite_or_null(axis.following_window)},
                            {"in_position_window", axis.in_position_window},
                            {"modulo", axis.modulo},
                            {"homing", word(axis.homing)},
                            {"group", axis.group},
                            {"programs", axis.programs},
                            {"drive", axis.drive},
                            {"profile", axis.profile},
                            {"drive_axis", axis.drive_axis + 1}});
    auto& groups = out["groups"] = Json::array();
    for (const auto& group : layout.groups) {
        Json members = Json::array();
        for (const auto member : group.members) members.push_back(layout.axes[member].name);
        groups.push_back(Json{{"name", group.name},
                              {"unit", group.unit},
                              {"members", std::move(members)},
                              {"arm", group.arm},
                              {"commands", group.commands},
                              {"setup_velocity", group.setup_velocity}});
    }
    out["slaves"] = layout.slaves;
    out["inputs"] = layout.inputs;
    out["outputs"] = layout.outputs;
    out["input_units"] = texts_of(layout.inputs, layout.input_units);
    out["output_units"] = texts_of(layout.outputs, layout.output_units);
    out["kept_inputs"] = texts_of(layout.inputs, layout.kept_inputs);  // why nobody may force them
    out["kept_outputs"] = texts_of(layout.outputs, layout.kept_outputs);
    out["programs"] = layout.programs;
    out["tasks"] = layout.tasks;
    auto& variables = out["variables"] = Json::array();
    for (const auto& v : layout.variables) {
        Json one{{"program", v.program}, {"name", v.name},       {"unit", v.unit},
                 {"doc", v.doc},         {"type", word(v.type)}, {"writable", v.writable}};
        if (v.writable) one.update(Json{{"minimum", v.minimum}, {"maximum", v.maximum}, {"whole", v.whole()}, {"momentary", v.momentary}});
        variables.push_back(std::move(one));
    }
    auto& parameters = out["parameters"] = Json::array();
    for (const auto& p : layout.parameters)
        parameters.push_back(Json{{"program", p.program},
                                  {"name", p.name},
                                  {"unit", p.unit},
                                  {"doc", p.doc},
                                  {"minimum", p.minimum},
                                  {"maximum", p.maximum},
                                  {"whole", p.whole},
                                  {"value", p.value}});
    return text(std::move(out));
}

}  // namespace taktwerk::hmi
