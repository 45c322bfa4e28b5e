#include "apps/machine/remote.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>

#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/json_text.hpp"
#include "apps/terminal/print_error.hpp"
#include "config/reading/unit_text.hpp"

namespace taktwerk::apps {
namespace {

Error bad_answer(const std::string& path) {
    return {"socket.bad_answer", path, "the answer is not what this version understands", "Use the command line of the runtime's version."};
}

Result<nlohmann::ordered_json> ask(hmi::Client& client, const char* question) {
    auto answer = client.request({{"cmd", question}});
    if (!answer) return answer.error();
    if (!answer->contains(question)) return bad_answer(client.path());
    return (*answer)[question];
}

/// The unit in the layout of what is called `name`; nothing without such an axis.
Result<std::string> unit_of_axis(hmi::Client& client, const std::string& axis) {
    const auto layout = layout_of(client);
    if (!layout) return layout.error();
    for (const auto& one : layout->at("axes"))
        if (one.at("name") == axis) return one.at("unit").get<std::string>();
    return std::string{};
}

bool begins_with(const std::string& text, const char* start) { return text.rfind(start, 0) == 0; }

}  // namespace

void add_remote_options(CLI::App& sub, RemoteOptions& options) {
    sub.add_option("-s,--socket", options.machine, "socket path or machine name; needed only when several machines run");
    sub.add_flag("--json", options.json, "the answer as one JSON object");
}

int exit_code_of(const Error& error) {
    if (error.code == "socket.ambiguous") return exit_usage;
    for (const char* usage : {"request.", "unit.", "usage."})
        if (begins_with(error.code, usage)) return exit_usage;
    if (begins_with(error.code, "socket.") || begins_with(error.code, "state.")) return exit_no_runtime;
    return exit_refused;
}

int report(const RemoteOptions& options, const std::string& done) {
    if (options.json) fmt::print("{{\"ok\":true,\"text\":{}}}\n", json_text(done));
    else fmt::print("{}\n", done);
    return exit_ok;
}

int report(const RemoteOptions& options, const Error& error) {
    if (options.json)
        fmt::print("{{\"ok\":false,\"error\":{{\"code\":{},\"subject\":{},\"what\":{},\"remedy\":{}}}}}\n", json_text(error.code),
                   json_text(error.subject), json_text(error.what), json_text(error.remedy));
    else print_error(error);
    return exit_code_of(error);
}

Result<int> understood(const std::string& path, const std::function<int()>& work) {
    try {
        return work();
    } catch (const nlohmann::json::exception& error) {
        auto told = bad_answer(path);
        // "[json.exception.type_error.302] type must be string, but is number": behind the bracket it is for people.
        const std::string_view why(error.what());
        told.what += fmt::format(": {}", why.substr(std::min(why.find("] ") + 2, why.size())));
        return told;
    }
}

int with_machine(const RemoteOptions& options, const std::function<int(hmi::Client&)>& work) {
    auto client = hmi::Client::connect(options.machine);
    if (!client) return report(options, client.error());
    const auto code = understood(client->path(), [&] { return work(*client); });
    return code ? *code : report(options, code.error());
}

Result<double> velocity_on(hmi::Client& client, const std::string& axis, const std::string& text) {
    const auto unit = unit_of_axis(client, axis);
    if (!unit) return unit.error();
    return config::value_in(text, *unit + "/s");
}

Result<double> position_on(hmi::Client& client, const std::string& axis, const std::string& text) {
    const auto unit = unit_of_axis(client, axis);
    if (!unit) return unit.error();
    return config::value_in(text, *unit);
}

namespace {

/// NAME, or PROGRAM.NAME.
const nlohmann::ordered_json* named(const nlohmann::ordered_json& list, const std::string& name) {
    for (const auto& one : list) {
        const auto own = one.at("name").get<std::string>();
        if (own == name || one.at("program").get<std::string>() + "." + own == name) return &one;
    }
    return nullptr;
}

}  // namespace

Result<double> parameter_value(hmi::Client& client, const std::string& parameter, const std::string& text) {
    if (text == "true" || text == "false") return text == "true" ? 1.0 : 0.0;
    const auto layout = layout_of(client);
    if (!layout) return layout.error();
    for (const char* list : {"parameters", "variables"})
        if (const auto* one = named(layout->at(list), parameter)) return config::value_in(text, one->at("unit").get<std::string>());
    return config::value_in(text, "");
}

bool is_switch(hmi::Client& client, const std::string& name) {
    const auto layout = layout_of(client);
    if (!layout || named(layout->at("parameters"), name) != nullptr) return false;
    const auto* variable = named(layout->at("variables"), name);
    return variable != nullptr && variable->at("writable").get<bool>();
}

Result<nlohmann::ordered_json> state_of(hmi::Client& client) { return ask(client, "state"); }
Result<nlohmann::ordered_json> layout_of(hmi::Client& client) { return ask(client, "layout"); }

}  // namespace taktwerk::apps
