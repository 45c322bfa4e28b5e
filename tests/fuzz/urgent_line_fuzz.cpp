// Any bytes at the door: what acts before everything else is only what the line clearly says, on an axis that the machine has, and its
// answer is a line of JSON. A stop of all that is written without tricks is never missed, whatever else stands in its line.
#include <cstdlib>
#include <string>

#include <nlohmann/json.hpp>

#include "hmi_bridge/socket/answer_line.hpp"
#include "hmi_bridge/socket/urgent_line.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

namespace {

/// The word of `cmd` in an object that says each thing once and is not deep; else empty.
std::string command_of(std::string_view line, bool& axis_given) {
    std::size_t keys = 0;
    bool deep = false;
    const auto look = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json&) {
        deep = deep || depth > 3;
        keys += depth == 1 && event == nlohmann::json::parse_event_t::key;
        return !deep;
    };
    const auto json = nlohmann::json::parse(line, look, false);
    if (deep || !json.is_object() || json.size() != keys || !json.contains("cmd") || !json["cmd"].is_string()) return {};
    axis_given = json.contains("axis");
    return json["cmd"].get<std::string>();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const test::FakeMachine machine;
    const std::string_view line(reinterpret_cast<const char*>(data), size);
    const auto urgent = urgent_line(line, machine.layout());
    bool axis_given = false;
    const auto command = command_of(line, axis_given);
    if (!urgent) {
        const bool plain = line.find("\"cmd\":\"stop\"") != std::string_view::npos;
        if (command == "stop" && (plain || (!axis_given && size <= 1024 && line.find("\"stop\"") != std::string_view::npos))) std::abort();
        return 0;
    }
    using Kind = UrgentLine::Kind;
    if (!command.empty() && command != (urgent->kind == Kind::shutdown ? "shutdown" : urgent->kind == Kind::stop ? "stop" : "jog"))
        std::abort();
    const bool of_one = urgent->kind == Kind::jog_hold || urgent->kind == Kind::jog_release;
    if (urgent->axis == 0xFFFF ? of_one : urgent->axis >= machine.layout().axes.size()) std::abort();
    const auto answer = accepted_line(urgent->id);
    if (!nlohmann::json::accept(answer) || answer.find('\n') != std::string::npos) std::abort();
    return 0;
}
