// taktwerk status: is the machine well? An exit code for scripts and monitoring, words for people.

#include <memory>

#include <fmt/format.h>

#include "apps/machine/health.hpp"
#include "apps/machine/remote.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

int show(const RemoteOptions& options, hmi::Client& client) {
    const auto hello = client.request({{"cmd", "hello"}});
    if (!hello) return report(options, hello.error());
    const auto state = state_of(client);
    if (!state && state.error().code != "state.not_yet") return report(options, state.error());
    const auto health = health_of(hello->value("hello", Json::object()), state ? *state : Json{});
    if (options.json) fmt::print("{}\n", health_json(health).dump(-1, ' ', false, Json::error_handler_t::replace));
    else fmt::print("{}", health_text(health));
    if (health.well()) return exit_ok;
    return health.bus == "operational" ? exit_alarm : exit_bus;
}

}  // namespace

void add_status(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand(
        "status", "is the machine well? exit code 0: yes, 4: its bus is not operational, 6: it does not run, 8: something stops it");
    auto options = std::make_shared<RemoteOptions>();
    add_remote_options(*sub, *options);
    sub->callback([&action, options] {
        action = [options] { return with_machine(*options, [&](hmi::Client& client) { return show(*options, client); }); };
    });
}

}  // namespace taktwerk::apps
