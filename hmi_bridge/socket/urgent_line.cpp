#include "hmi_bridge/socket/urgent_line.hpp"

#include <algorithm>
#include <vector>

#include <nlohmann/json.hpp>

#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/words/target_names.hpp"

namespace taktwerk::hmi {
namespace {

constexpr std::size_t longest_line = 1024;
constexpr std::size_t most_keys = 64;  ///< more are refused by who reads the line in full

/// As it is written, wherever in the line: who asks for one must not have to write the rest without a fault.
bool asks_for(std::string_view line, std::string_view command) {
    constexpr std::string_view key = "\"cmd\"", blanks = " \t\r\n";
    for (auto at = line.find(key); at != std::string_view::npos; at = line.find(key, at + 1)) {
        auto rest = line.substr(at + key.size());
        const auto skip_blanks = [&] { rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size())); };
        skip_blanks();
        if (!rest.starts_with(':')) continue;
        rest.remove_prefix(1);
        skip_blanks();
        if (rest.starts_with(command)) return true;
    }
    return false;
}

/// Cheap: most lines are none of these. Behind a backslash any word may stand, letter by letter.
bool may_be(std::string_view line) {
    if (line.size() > longest_line) return asks_for(line, "\"stop\"") || asks_for(line, "\"shutdown\"");
    for (const std::string_view word : {"\"stop\"", "\"shutdown\"", "\"jog\"", "\"group_jog\"", "\"measure\"", "\\"})
        if (line.find(word) != std::string_view::npos) return true;
    return false;
}

std::optional<std::uint16_t> axis_of(const nlohmann::json& line, const runtime::MachineLayout& layout, bool or_all) {
    const auto found = line.find("axis");
    if (found == line.end()) return or_all ? std::optional<std::uint16_t>{all_axes} : std::nullopt;
    if (!found->is_string()) return std::nullopt;
    const auto& name = found->get_ref<const std::string&>();
    if (or_all && (name.empty() || name == "all")) return all_axes;
    for (std::size_t i = 0; i < layout.axes.size(); ++i)
        if (layout.axes[i].name == name) return static_cast<std::uint16_t>(i);
    return std::nullopt;
}

const std::vector<std::uint16_t>* members_of(const nlohmann::json& line, const runtime::MachineLayout& layout) {
    const auto found = line.find("group");
    if (found == line.end() || !found->is_string()) return nullptr;
    for (const auto& group : layout.groups)
        if (group.name == found->get_ref<const std::string&>()) return &group.members;
    return nullptr;
}

}  // namespace

std::optional<UrgentLine> urgent_line(std::string_view line, const runtime::MachineLayout& layout) {
    if (!may_be(line)) return std::nullopt;
    bool too_deep = false, too_many = false, twice = false, asks_for_a_stop = false, at_cmd = false;
    std::vector<std::string> keys;
    const auto looked_at = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& value) {
        too_deep = too_deep || depth > deepest_nesting;
        if (event == nlohmann::json::parse_event_t::key && depth == 1) {
            const auto& key = value.get_ref<const std::string&>();
            at_cmd = key == "cmd";
            // Each is compared with all before it: a line of some thousands would hold up the stop that comes behind it.
            if (keys.size() >= most_keys) return too_many = true, false;
            twice = twice || std::find(keys.begin(), keys.end(), key) != keys.end();
            keys.push_back(key);
        }
        if (event == nlohmann::json::parse_event_t::value && depth == 1) asks_for_a_stop = asks_for_a_stop || (at_cmd && value == "stop");
        return !too_deep;
    };
    const auto json = nlohmann::json::parse(line, looked_at, false);
    const UrgentLine unclear_stop{UrgentLine::Kind::stop, all_axes, false, true};
    if (too_deep || !json.is_object()) return asks_for(line, "\"stop\"") ? std::optional{unclear_stop} : std::nullopt;
    if (too_many) return asks_for_a_stop || asks_for(line, "\"stop\"") ? std::optional{unclear_stop} : std::nullopt;
    if (twice && !asks_for_a_stop)
        return std::nullopt;  // refused by who reads it in full; a jog that it was to keep alive ends with its lease
    if (twice) return unclear_stop;
    const auto cmd = json.find("cmd");
    if (cmd == json.end() || !cmd->is_string()) return std::nullopt;

    UrgentLine urgent;
    if (const auto id = json.find("id"); id != json.end() && id->is_number_unsigned() && id->get<std::uint64_t>() > 0)
        urgent.id = id->dump();
    if (*cmd == "shutdown") {
        urgent.kind = UrgentLine::Kind::shutdown;
        return urgent;
    }
    const bool stop = *cmd == "stop";
    const bool measures = *cmd == "measure";
    const bool of_a_group = *cmd == "group_jog";
    if (!stop && !measures && !of_a_group && *cmd != "jog") return std::nullopt;
    if (of_a_group) {
        const auto* members = members_of(json, layout);
        if (members == nullptr) return std::nullopt;
        urgent.held = *members;
    } else {
        const auto axis = axis_of(json, layout, stop);
        urgent.unclear_axis = stop && !axis;
        if (!axis && !stop) return std::nullopt;
        urgent.axis = axis.value_or(all_axes);
        if (stop) return urgent;
        urgent.held = {urgent.axis};
    }
    const auto velocity = json.find("velocity");
    if (!measures && (velocity == json.end() || !velocity->is_number())) return std::nullopt;
    // A measurement is let go by a stop; its velocity 0 is a number left open.
    urgent.kind = !measures && velocity->get<double>() == 0 ? UrgentLine::Kind::jog_release : UrgentLine::Kind::jog_hold;
    const auto press = json.find("press");
    urgent.press = press != json.end() && press->is_boolean() && press->get<bool>();
    return urgent;
}

}  // namespace taktwerk::hmi
