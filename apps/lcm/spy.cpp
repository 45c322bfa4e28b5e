// taktwerk lcm spy: the channels of this computer in a table, or the messages of some of them.

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/lcm/channel_book.hpp"
#include "apps/lcm/lcm.hpp"
#include "apps/lcm/log_file.hpp"
#include "apps/lcm/network.hpp"
#include "apps/lcm/player.hpp"
#include "apps/lcm/spy_text.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "apps/terminal/terminal_size.hpp"
#include "core/clock.hpp"
#include "hmi_bridge/wall_clock.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

constexpr Duration refresh = 500ms, refresh_of_messages = 100ms;
constexpr Duration listened_once = 2s, waited_for_a_message = 3s;
constexpr Duration siblings = 200ms;  // after a first message: those that stand beside it on its channel
constexpr int messages_at_once = 1000;
constexpr std::size_t most_shown = 256;  // messages side by side

struct SpyOptions {
    NetworkOptions network;
    std::string channel, file;
    bool once = false, json = false;
    double for_s = 0;
};

/// The newest message of each channel, and of each part of a channel that has several.
struct Newest {
    std::string channel;
    std::vector<std::byte> message;
    std::int64_t utime = 0;
    bool fresh = true;
};
using Newests = std::map<std::string, Newest>;

/// A picture where there is a terminal, else one below the other.
void draw(const std::string& text, bool first) {
    // A line that the terminal breaks, or one too many, would push the picture out of its place.
    const auto terminal = terminal_size();
    if (::isatty(STDOUT_FILENO) != 0) fmt::print("\033[H\033[J");
    else if (!first) fmt::print("\n");
    fmt::print("{}", terminal ? fitted(text, *terminal) : text);
    std::fflush(stdout);
}

/// Whoever read what is printed (`| head`) has gone: nobody sees the rest.
bool nobody_reads() { return std::ferror(stdout) != 0; }

int no_pattern(const std::string& text) {
    print_error(
        {"lcm.channel", text, "this is no channel and no regular expression", "Write a name, or one such as 'TAKTWERK_.*_AXIS_STATE'."});
    return exit_usage;
}

int spy_file(const SpyOptions& options, const hmi::TypeCatalog& catalog) {
    auto log = LogReader::open(options.file);
    if (!log) {
        print_error(log.error());
        return exit_bad_file;
    }
    const auto wanted = name_pattern(options.channel);
    if (!wanted) return no_pattern(options.channel);
    ChannelBook book(catalog);
    std::int64_t last = 0;
    while (const auto message = log->next()) {
        if (stop_requested() || nobody_reads()) break;
        last = message->utime;
        if (options.channel.empty()) {
            book.note(message->channel, message->data, message->utime);
        } else if (std::regex_match(message->channel, *wanted)) {
            fmt::print("{}", options.json ? message_json(catalog, message->channel, message->data, message->utime)
                                          : message_text(catalog, message->channel, message->data));
            if (options.once) break;
        }
    }
    if (options.channel.empty())
        fmt::print("{}", options.json ? channels_json(book, last) : channels_text(book, last, colours_of_output()));
    if (log->skipped() > 0)
        print_warning(
            {"lcm.log_torn", options.file, fmt::format("{} bytes of it are no message and were passed over", log->skipped()), ""});
    return exit_ok;
}

int spy_channels(const SpyOptions& options, hmi::LcmBus& bus, const hmi::TypeCatalog& catalog) {
    SystemClock clock;
    ChannelBook book(catalog);
    if (!bus.subscribe_matching(
            ".*", room_for_messages,
            [&](std::string_view channel, std::span<const std::byte> message, std::int64_t utime) { book.note(channel, message, utime); }))
        return no_pattern(".*");
    const auto start = clock.now();
    const auto end = options.for_s > 0 ? start + from_seconds(options.for_s) : options.once ? start + listened_once : Instant::max();
    bool first = true;
    for (auto next = start + refresh; !stop_requested() && !nobody_reads() && clock.now() < end;) {
        bus.wait(std::max(Duration{1ms}, std::min(next, end) - clock.now()), messages_at_once);
        if (options.once || clock.now() < next) continue;
        next = clock.now() + refresh;
        const auto now = hmi::wall_utime();
        if (options.json) fmt::print("{}", channels_json(book, now));
        else draw(channels_text(book, now, colours_of_output()), first);
        std::fflush(stdout);
        first = false;
    }
    const auto now = hmi::wall_utime();
    if (options.once) fmt::print("{}", options.json ? channels_json(book, now) : channels_text(book, now, colours_of_output()));
    return book.messages() > 0 ? exit_ok : exit_no_runtime;
}

int spy_messages(const SpyOptions& options, hmi::LcmBus& bus, const hmi::TypeCatalog& catalog) {
    SystemClock clock;
    Newests newests;
    const auto note = [&](std::string_view channel, std::span<const std::byte> message, std::int64_t utime) {
        const auto key = std::string(channel) + "\n" + part_of(catalog, message);
        if (newests.size() >= most_shown && newests.find(key) == newests.end()) return;
        newests[key] = {std::string(channel), {message.begin(), message.end()}, utime, true};
        if (options.json && !options.once) fmt::print("{}", message_json(catalog, channel, message, utime));
    };
    if (!bus.subscribe_matching(options.channel, room_for_messages, note)) return no_pattern(options.channel);
    const auto start = clock.now();
    const auto end = options.for_s > 0 ? start + from_seconds(options.for_s) : options.once ? start + waited_for_a_message : Instant::max();
    auto enough = Instant::max();
    bool first = true;
    for (auto next = start + refresh_of_messages; !stop_requested() && !nobody_reads() && clock.now() < std::min(end, enough);) {
        bus.wait(std::max(Duration{1ms}, std::min({next, end, enough}) - clock.now()), messages_at_once);
        if (options.once && !newests.empty() && enough == Instant::max()) enough = clock.now() + siblings;
        if (clock.now() < next) continue;
        next = clock.now() + refresh_of_messages;
        if (options.once || newests.empty()) continue;
        std::fflush(stdout);
        if (options.json) continue;
        std::string text;
        for (const auto& [key, newest] : newests) {
            const auto age = static_cast<double>(hmi::wall_utime() - newest.utime) / 1000;
            text += message_text(catalog, newest.channel, newest.message) +
                    (age > 500 ? fmt::format("  STALE: {:.1f} s old\n", age / 1000) : "");
        }
        draw(text, first);
        first = false;
    }
    if (newests.empty()) {
        print_error({"lcm.silent", options.channel, "no message has come on this channel",
                     "See `taktwerk lcm spy` which there are: does the machine run, with lcm enabled and the same URL?"});
        return exit_no_runtime;
    }
    if (options.once)
        for (const auto& [key, newest] : newests)
            fmt::print("{}", options.json ? message_json(catalog, newest.channel, newest.message, newest.utime)
                                          : message_text(catalog, newest.channel, newest.message));
    return exit_ok;
}

int spy(const SpyOptions& options) {
    const auto catalog = types_of(options.network);
    if (!catalog) {
        print_error(catalog.error());
        return exit_bad_file;
    }
    watch_stop_signals();
    if (!options.file.empty()) return spy_file(options, *catalog);
    const auto bus = open_network(options.network);
    if (!bus) {
        print_error(bus.error());
        return exit_bus;
    }
    return options.channel.empty() ? spy_channels(options, **bus, *catalog) : spy_messages(options, **bus, *catalog);
}

}  // namespace

void add_lcm_spy(CLI::App& lcm, Action& action) {
    auto* sub = lcm.add_subcommand("spy", "the channels with types, rates and losses; of one its messages");
    auto options = std::make_shared<SpyOptions>();
    sub->add_option("CHANNEL", options->channel,
                    "its messages, field by field; a regular expression of the whole name: 'TAKTWERK_.*_AXIS_STATE'");
    add_network_options(*sub, options->network);
    sub->add_option("--file", options->file, "look into this log instead of the network");
    sub->add_flag("--once", options->once, "print once and end");
    sub->add_flag("--json", options->json, "one JSON object a line");
    add_duration(*sub, "--for", options->for_s, "end after this time");
    sub->callback([&action, options] { action = [options] { return spy(*options); }; });
}

}  // namespace taktwerk::apps
