// taktwerk lcm play: says a recorded log again, as it was said.

#include <algorithm>
#include <chrono>
#include <memory>
#include <set>
#include <string>

#include <fmt/format.h>

#include "apps/lcm/lcm.hpp"
#include "apps/lcm/log_file.hpp"
#include "apps/lcm/network.hpp"
#include "apps/lcm/player.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/clock.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

constexpr Duration listened_before = 1200ms;  // longer than the rarest state message is apart (2 Hz)
constexpr Duration looked_at_signals = 100ms;

struct PlayOptions {
    NetworkOptions network;
    std::string file, channel;
    double speed = 1;
    bool force = false, commands = false;
};

/// Who publishes here before anything is played.
Result<std::set<std::string>> heard_now(const hmi::LcmUrl& url) {
    auto bus = hmi::LcmBus::open(url);
    if (!bus) return bus.error();
    std::set<std::string> heard;
    constexpr std::size_t most = 10'000;
    if (!(*bus)->subscribe_matching(".*", room_for_messages, [&](std::string_view channel, std::span<const std::byte>, std::int64_t) {
            if (heard.size() < most) heard.emplace(channel);
        }))
        return heard;
    SystemClock clock;
    for (const auto end = clock.now() + listened_before; clock.now() < end && !stop_requested();)
        (*bus)->wait(std::max(Duration{1ms}, end - clock.now()), room_for_messages);
    return heard;
}

int failed(const Error& error, ExitCode code) {
    print_error(error);
    return code;
}

int play(const PlayOptions& options) {
    const auto catalog = types_of(options.network);
    if (!catalog) return failed(catalog.error(), exit_bad_file);
    auto log = LogReader::open(options.file);
    if (!log) return failed(log.error(), exit_bad_file);
    const auto channels = name_pattern(options.channel);
    if (!channels)
        return failed({"lcm.channel", options.channel, "this is no regular expression", "Write one such as 'TAKTWERK_DEMO_.*'."},
                      exit_usage);
    const auto commands = options.commands ? Commands::played : Commands::left_out;
    const auto content = look_through(*log, *channels, commands, *catalog);
    if (content.chosen.empty())
        return failed({"lcm.nothing_to_play", options.file,
                       content.commands > 0 ? "only commands are in it, and those are not played" : "no message of these channels is in it",
                       "See `taktwerk lcm spy --file` what is."},
                      exit_bad_file);
    watch_stop_signals();
    const auto url = url_of(options.network);
    if (!url) return failed(url.error(), exit_usage);
    if (!options.force) {
        if (const auto hazard = play_hazard(content, *url, {})) return failed(*hazard, exit_refused);
        const auto heard = heard_now(*url);
        if (!heard) return failed(heard.error(), exit_bus);
        if (const auto hazard = play_hazard(content, *url, *heard)) return failed(*hazard, exit_refused);
    }
    const auto bus = hmi::LcmBus::open(*url);
    if (!bus) return failed(bus.error(), exit_bus);
    if (content.commands > 0) fmt::print("{} left out (--commands plays them)\n", count_text(content.commands, "command"));

    log->rewind();
    SystemClock clock;
    const auto start = clock.now();
    const PlayClock due(start, content.first_utime, options.speed);
    std::uint64_t played = 0, refused = 0;
    Duration latest{};
    while (const auto message = log->next()) {
        if (!std::regex_match(message->channel, *channels) || (commands == Commands::left_out && is_command(*message, *catalog))) continue;
        const auto at = due.due(message->utime);
        while (!stop_requested() && clock.now() < at) clock.sleep_until(std::min(at, clock.now() + looked_at_signals));
        if (stop_requested()) break;
        if (options.speed > 0) latest = std::max(latest, clock.now() - at);
        if ((*bus)->publish(message->channel, message->data)) ++played;
        else ++refused;
    }
    fmt::print("{} of {} played in {:.1f} s", count_text(played, "message"), count_text(content.chosen.size(), "channel"),
               to_seconds(clock.now() - start));
    if (options.speed > 0) fmt::print(", at most {:.1f} ms late", to_seconds(latest) * 1e3);
    fmt::print("{}\n", refused > 0 ? fmt::format("; the network did not take {}", refused) : "");
    if (log->skipped() > 0)
        print_warning(
            {"lcm.log_torn", options.file, fmt::format("{} bytes of it are no message and were passed over", log->skipped()), ""});
    return exit_ok;
}

}  // namespace

void add_lcm_play(CLI::App& lcm, Action& action) {
    auto* sub = lcm.add_subcommand("play", "says a recorded log again");
    auto options = std::make_shared<PlayOptions>();
    sub->add_option("FILE", options->file, "log of `taktwerk lcm record` or lcm-logger")->required();
    add_network_options(*sub, options->network);
    sub->add_option("--speed", options->speed, "2: twice as fast; 0: without waiting (LCM loses messages then)")
        ->check(CLI::Range(0.0, 1000.0));
    sub->add_option("--channel", options->channel, "only these: a regular expression of the whole name");
    sub->add_flag("--commands", options->commands, "commands, too: they move whatever machine takes them");
    sub->add_flag("--force", options->force, "also beside a live machine, and beyond this computer");
    sub->callback([&action, options] { action = [options] { return play(*options); }; });
}

}  // namespace taktwerk::apps
