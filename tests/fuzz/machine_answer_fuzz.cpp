// Any bytes as an answer line of a machine: nothing, or members that stand in braces as a JSON object without `id` where the line was JSON.
#include <cstdint>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "hmi_bridge/web/machine_answer.hpp"

using namespace taktwerk::hmi::web;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view line{reinterpret_cast<const char*>(data), size};
    const auto read = read_machine_answer(line);
    if (!read) return 0;
    const auto& answer = read->answer;
    (void)cycle_of(answer.value_of("state"));
    if (answer.keys.empty()) std::abort();
    if (answer.ok && answer.keys.find("\"ok\":true") == std::string::npos) std::abort();
    const auto whole = nlohmann::ordered_json::parse(line, nullptr, false);
    if (!whole.is_object()) return 0;  // a machine's own long answer is handed on as it is
    const auto members = nlohmann::ordered_json::parse("{" + answer.keys + "}", nullptr, false);
    if (!members.is_object() || !members.contains("ok")) std::abort();
    return 0;
}
