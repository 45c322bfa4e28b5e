// taktwerk record keep|status: the run of a running machine, as a file for `taktwerk replay`, without an alarm: "it just happened again".

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "apps/machine/remote.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

constexpr int keep_looks = 100;
constexpr auto keep_look_again = 100ms;

std::string run_megabytes(const Json& bytes) { return fmt::format("{:.1f} MB", bytes.get<double>() / 1e6); }

std::string run_text(const Json& run) {
    const auto file = run.at("file").get<std::string>();
    auto text = fmt::format("{:.1f} s since the start: {} in memory", run.at("seconds").get<double>(), run_megabytes(run.at("memory")));
    if (const auto& disk = run.at("disk"); disk.get<std::uint64_t>() > 0) text += fmt::format(", {} in {}", run_megabytes(disk), file);
    text += '\n';
    if (const auto ended = run.at("ended").get<std::string>(); !ended.empty()) text += fmt::format("it is taken no further: {}\n", ended);
    return text;
}

/// A runtime of an older version says only that something is still to come.
bool is_awaited(const Json& run) { return run.value("asked_waits", run.at("waits").get<bool>()); }

int keep_run(const RemoteOptions& options, hmi::Client& client) {
    auto answer = client.request({{"cmd", "replay_keep"}});
    if (!answer) return report(options, answer.error());
    // Up to now: its last second comes with the next block of the run. What is still to come behind an alarm goes into the same file later.
    for (int i = 0; i < keep_looks && is_awaited(answer->at("replay")); ++i) {
        std::this_thread::sleep_for(keep_look_again);
        answer = client.request({{"cmd", "replay_state"}});
        if (!answer) return report(options, answer.error());
    }
    const auto& run = answer->at("replay");
    if (const auto ended = run.at("ended").get<std::string>(); !ended.empty())
        return report(options, Error{"recording.ended", "", "the run could not be kept: " + ended, "Look at that disk."});
    if (is_awaited(run))
        return report(options, Error{"recording.not_yet", run.at("file").get<std::string>(), "it is still being written",
                                     "`taktwerk record status` says when it is there."});
    if (options.json) fmt::print("{}\n", run.dump(-1, ' ', false, Json::error_handler_t::replace));
    else fmt::print("{}taktwerk replay {}\n", run_text(run), run.at("file").get<std::string>());
    return exit_ok;
}

int run_status(const RemoteOptions& options, hmi::Client& client) {
    const auto answer = client.request({{"cmd", "replay_state"}});
    if (!answer) return report(options, answer.error());
    const auto& run = answer->at("replay");
    if (options.json) fmt::print("{}\n", run.dump(-1, ' ', false, Json::error_handler_t::replace));
    else fmt::print("{}", run_text(run));
    return exit_ok;
}

}  // namespace

void add_record(CLI::App& app, Action& action) {
    auto* record = app.add_subcommand("record", "the run of a running machine so far, for `taktwerk replay`");
    record->require_subcommand(1);
    const auto add = [&](const char* name, const char* words, int (*work)(const RemoteOptions&, hmi::Client&)) {
        auto* sub = record->add_subcommand(name, words);
        auto options = std::make_shared<RemoteOptions>();
        add_remote_options(*sub, *options);
        sub->callback([&action, options, work] {
            action = [options, work] { return with_machine(*options, [&](hmi::Client& client) { return work(*options, client); }); };
        });
    };
    add("keep", "keep the run from its start up to now as a file, as an alarm that stops something does by itself", &keep_run);
    add("status", "how long the run in memory is, how large, and where it is kept", &run_status);
}

}  // namespace taktwerk::apps
