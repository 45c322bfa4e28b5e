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

/// Scripts read `well`, whatever else there is to read.
int not_there(const RemoteOptions& options, const Error& error) {
    if (!options.json) return report(options, error);
    const Json told{{"ok", false},
                    {"well", false},
                    {"unwell", {error.what}},
                    {"error", {{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}}}};
    fmt::print("{}\n", told.dump(-1, ' ', false, Json::error_handler_t::replace));
    return exit_code_of(error);
}

int show(const RemoteOptions& options, hmi::Client& client) {
    const auto hello = client.request({{"cmd", "hello"}});
    if (!hello) return not_there(options, hello.error());
    const auto state = state_of(client);
    if (!state && state.error().code != "state.not_yet") return not_there(options, state.error());
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
        action = [options] {
            auto client = hmi::Client::connect(options->machine);
            if (!client) return not_there(*options, client.error());
            const auto code = understood(client->path(), [&] { return show(*options, *client); });
            return code ? *code : not_there(*options, code.error());
        };
    });
}

}  // namespace taktwerk::apps
