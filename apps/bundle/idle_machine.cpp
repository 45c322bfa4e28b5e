#include "apps/bundle/idle_machine.hpp"

#include <fmt/format.h>

#include "apps/machine/remote.hpp"
#include "runtime/bundle/durable.hpp"

namespace taktwerk::apps {

namespace {

Error runs(const std::string& machine, std::string what, std::string remedy) {
    return {"bundle.machine_runs", machine, std::move(what), std::move(remedy)};
}

/// Names of axes that are enabled or shall be; a state of another form is one that says nothing.
Result<std::string> enabled_axes(const nlohmann::ordered_json& state, const std::string& machine) {
    const auto axes = state.find("axes");
    if (!state.is_object() || axes == state.end() || !axes->is_array())
        return runs(machine, "it runs, and its answer does not say whether axes are enabled", "stop it first: `taktwerk shutdown`");
    std::string names;
    for (const auto& axis : *axes) {
        const bool off =
            axis.is_object() && axis.contains("powered") && axis["powered"] == false && axis.contains("enable") && axis["enable"] == false;
        if (off) continue;
        const auto name =
            axis.is_object() && axis.contains("name") && axis["name"].is_string() ? axis["name"].get<std::string>() : std::string("?");
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

}  // namespace

Result<Runs> idle_machine(const std::string& machine, const std::string& socket, const std::filesystem::path& version_folder) {
    auto client = hmi::Client::connect(socket.empty() ? machine : socket);
    if (!client) {
        const auto& code = client.error().code;
        if (code != "socket.not_found" && code != "socket.no_runtime")
            return runs(machine, fmt::format("it may run, and cannot be asked: {}", client.error().what), client.error().remedy);
        if (!version_folder.empty() && runtime::in_use(version_folder))
            return runs(machine, fmt::format("it runs from {}, and nobody answers at its command socket", version_folder.string()),
                        "stop it first");
        return Runs::no;
    }
    const auto state = state_of(*client);
    if (!state) {
        if (state.error().code == "state.not_yet") return Runs::without_power;  // its bus is not up: no axis can be enabled
        return runs(machine, fmt::format("it runs, and does not say whether axes are enabled: {}", state.error().what),
                    "stop it first: `taktwerk shutdown`");
    }
    const auto enabled = enabled_axes(*state, machine);
    if (!enabled) return enabled.error();
    if (!enabled->empty())
        return runs(machine, fmt::format("it runs, and these axes are enabled: {}", *enabled),
                    "`taktwerk disable all`, or stop it: `taktwerk shutdown`");
    return Runs::without_power;
}

}  // namespace taktwerk::apps
